#pragma once

#include "ecs/components/post.h"
#include "render/effect.h"
#include "render/lens/local_luminance_pass.h"
#include "render/lens/statistics_pass.h"

#include <array>
#include <optional>

namespace limn {

// The whole tone-mapping chain, from scene radiance to display values (hdr.pipeline): statistics,
// defog, exposure, tone curve, encoding, dither. The renderer ends with it; `limn view` does
// little else.
//
// Reads    radiance; of the passes that an Exposure requests, ImageStatistics for defog and
//          metering, LocalLuminance for ToneCurve::Local
// Writes   display: RGBA8, encoded, opaque
// Order    last
// Shaders  tone_map.frag, lib/tone.glsl

struct ToneMapper {
    StatisticsPass statistics;
    LocalLuminancePass local;
    std::array<const gpu::Program*, 6> programs = {};  ///< by ToneCurve
    gpu::Buffer no_measure = {};                       ///< ImageStatistics: no haze, scale 1
    bool adapting = false;  ///< eye adaptation holds the previous frame's state
};

[[nodiscard]] Result<ToneMapper> create_tone_mapper(gpu::Device& device);

/// Adds the passes to this frame; returns the display image, RGBA8. `seconds` since the previous
/// frame drive the eye adaptation of Metering::Auto; nullopt means a cut, after which it adapts at
/// once. `depth`, if valid, tells surfaces from the background for Exposure::meter_surfaces.
[[nodiscard]] TextureId apply_tone_mapper(
    FrameGraph& graph, ToneMapper& tone_mapper, const Exposure& exposure,
    std::optional<float> seconds, TextureId radiance, TextureId depth = {});

/// Ends the views that are displayed, with the Exposure of the world.
struct ToneMapEffect {
    ToneMapper tone_mapper;

    static Result<ToneMapEffect> create(gpu::Device& device, const RenderSettings&);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

}  // namespace limn
