#pragma once

#include "render/frame_scene.h"
#include "render/water/water_surfaces.h"

namespace limn {

// Draws waves that are too short to move vertices into tiles (water.geometric-texture-split).
//
// Reads    WaterDetails
// Writes   slopes of the tiles, and smaller levels of them
// Order    before water
// Shaders  texture_waves.frag

struct TextureWavePass {
    const gpu::Program* program = nullptr;
};

[[nodiscard]] Result<TextureWavePass> create_texture_wave_pass(gpu::Device& device);

/// Nothing where no water has such waves.
void draw_texture_waves(FrameGraph& graph, const TextureWavePass& pass, WaterSurfaces& waters);

}  // namespace limn
