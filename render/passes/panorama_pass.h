#pragma once

#include "render/frame_scene.h"
#include "render/graph/frame_graph.h"

namespace limn {

// Makes a cube map of a panorama, whichever way that shows directions: what follows need not know.
//
// Reads    the image of Environment
// Writes   sky cube, RGBA16F with all mip levels
// Order    before the reflection map, when the environment has changed
// Shaders  panorama_pass.frag, lib/panorama.glsl, lib/cube_map.glsl
//
// A face is as wide as a quarter of the panorama, rounded up to a power of two: nothing is lost
// near the horizon. Radiance beyond the largest half, 65504, is cut off.

struct PanoramaPass {
    const gpu::Program* program = nullptr;
    gpu::Sampler sampler;  ///< repeats to the left and right
    gpu::Texture cube;     ///< as large as the last panorama needed
    int max_face = 1024;   ///< [px]
};

[[nodiscard]] Result<PanoramaPass> create_panorama_pass(gpu::Device& device);

/// Fills `pass.cube` with what `environment` says of `panorama`.
void draw_panorama(
    FrameGraph& graph, PanoramaPass& pass, const gpu::Texture& panorama,
    const Environment& environment);

/// Adds a pass that fills levels 1 .. n of a cube map.
void draw_cube_levels(FrameGraph& graph, const gpu::Texture& cube);

}  // namespace limn
