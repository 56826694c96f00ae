#pragma once

#include "ecs/components/environment.h"
#include "render/graph/frame_graph.h"

namespace limn {

// From scene radiance to what a display shows: exposure, curve, sRGB, dither.
//
// Reads    radiance
// Writes   display: RGBA8, sRGB encoded, opaque
// Order    last
// Shaders  tone_map.frag, lib/tone.glsl

struct ToneMapPass {
    const gpu::Program* programs[3] = {};  ///< by ToneCurve
};

[[nodiscard]] Result<ToneMapPass> create_tone_map_pass(gpu::Device& device);

[[nodiscard]] TextureId
tone_map(FrameGraph& graph, const ToneMapPass& pass, const Exposure& exposure, TextureId radiance);

}  // namespace limn
