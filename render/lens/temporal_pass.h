#pragma once

#include "render/effect.h"
#include "render/gpu/texture.h"

#include <array>
#include <cstdint>

namespace limn {

// Temporal anti-aliasing: each frame is drawn with another subpixel jitter and blended with the
// reprojected history.
//
// Reads    radiance, depth, velocity; the history, which it keeps
// Writes   radiance: the result, history of the next frame
// Order    first of the lens effects, so that the others see smooth edges
// Shaders  temporal.frag
//
// History is sampled bicubically at the previous position of the nearest surface in the
// neighborhood, and clipped to the neighborhood's mean and variance in YCoCg, which rejects
// disoccluded history. Where nothing moves, up to 32 frames are averaged with equal weight and
// their mean is that of render_accumulated; where something moves, 10. A cut, or a frame without
// this effect, resets the history.
//
// After B. Karis, "High Quality Temporal Supersampling", 2014; M. Salvi, "An Excursion in Temporal
// Supersampling", 2016; J. Jimenez, "Filmic SMAA", 2016. Blended surfaces have the velocity of
// the surface behind them; reflections are not reprojected.

/// Frames until the jitter repeats.
inline constexpr int kTemporalSamples = 16;

struct TemporalEffect {
    const gpu::Program* program = nullptr;
    std::array<gpu::Texture, 2> history = {};  ///< radiance
    std::array<gpu::Texture, 2> moments = {};  ///< sample count, and variance
    int newest = 0;                            ///< index of the latest history
    std::uint64_t last_frame = 0;              ///< FrameData::number of the latest history
    int since_cut = 0;                         ///< frames

    static Result<TemporalEffect> create(gpu::Device& device, const RenderSettings&);
    static bool is_used(const FrameData& frame);
    void collect(FrameData& frame);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

}  // namespace limn
