#pragma once

#include "render/graph/frame_graph.h"

namespace limn {

struct WaterSurfaces;

// Renders waves that are too short for vertex displacement into tiling textures
// (water.geometric-texture-split).
//
// Reads    WaterDetails
// Writes   slopes of the tiles, with mip levels
// Order    before water
// Shaders  texture_waves.frag

/// Adds no pass if no water has such waves; grows `tiles` if necessary.
void draw_texture_waves(
    FrameGraph& graph, const gpu::Program* program, gpu::Texture& tiles,
    const WaterSurfaces& waters);

}  // namespace limn
