#pragma once

#include "render/frame_scene.h"
#include "render/gbuffer.h"
#include "render/gpu/texture.h"

#include <array>

namespace limn {

// Temporal anti-aliasing: each picture is drawn moved by another part of a pixel and laid over
// those before it, which follow what moves.
//
// Reads    radiance, depth, velocity; the result before, which it keeps
// Writes   radiance: the result, which the next picture reads
// Order    first of the lens, so that all else sees smooth edges
// Shaders  temporal.frag
//
// History is read where the nearest surface of the neighborhood was, bicubically, and is clipped to
// what the neighborhood's mean and variance in YCoCg allow: what appeared from behind something has
// none worth keeping. Where nothing moves, up to 32 pictures count alike and their mean is that of
// render_accumulated; where something does, 10. After a cut it begins anew.
//
// After B. Karis, "High Quality Temporal Supersampling", 2014; M. Salvi, "An Excursion in Temporal
// Supersampling", 2016; J. Jimenez, "Filmic SMAA", 2016. What is blended has the velocity of what
// is behind it; mirrored pictures do not follow their reflections.

/// Pictures until the jitter repeats.
inline constexpr int kTemporalSamples = 16;

struct TemporalPass {
    const gpu::Program* program = nullptr;
    std::array<gpu::Texture, 2> history = {};  ///< radiance
    std::array<gpu::Texture, 2> moments = {};  ///< how many pictures, and their variance
    int newest = 0;                            ///< of the two
    bool any = false;                          ///< whether it holds a picture
};

[[nodiscard]] Result<TemporalPass> create_temporal_pass(gpu::Device& device);

/// `gbuffer` must have velocity.
[[nodiscard]] TextureId resolve_temporally(
    FrameGraph& graph, TemporalPass& pass, const FrameScene& scene, const Gbuffer& gbuffer,
    TextureId radiance);

/// Forgets the pictures before.
void forget_pictures(TemporalPass& pass);

}  // namespace limn
