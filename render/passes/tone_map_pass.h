#pragma once

#include "ecs/components/post.h"
#include "render/gpu/buffer.h"
#include "render/gpu/program.h"
#include "render/tone.h"

#include <array>
#include <optional>

namespace limn {

// From scene radiance to what a display shows: haze, exposure, curve, encoding, dither.
//
// Reads    radiance; a PictureMeasure for defog and metering; LocalLuminance for ToneCurve::Local
// Writes   display: RGBA8, encoded, opaque
// Order    last
// Shaders  tone_map.frag, lib/tone.glsl

struct ToneMapPass {
    std::array<const gpu::Program*, 6> programs = {};  ///< by ToneCurve
    gpu::Buffer no_measure;                            ///< PictureMeasure: no haze, scale 1
};

struct ToneMapInput {
    TextureId radiance;
    BufferId measure = {};                     ///< not valid: neither defog nor metering
    std::optional<LocalLuminance> local = {};  ///< for ToneCurve::Local, which needs it
};

[[nodiscard]] Result<ToneMapPass> create_tone_map_pass(gpu::Device& device);

[[nodiscard]] TextureId tone_map(
    FrameGraph& graph, const ToneMapPass& pass, const Exposure& exposure,
    const ToneMapInput& input);

}  // namespace limn
