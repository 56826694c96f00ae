#pragma once

#include "render/frame_scene.h"
#include "render/gbuffer.h"

namespace limn {

// Draws alpha-blended surfaces over the lit scene, from back to front, lit as the opaque ones are.
//
// Reads    InstanceList, depth, light clusters, environment
// Writes   radiance
// Order    after lights and sky
// Shaders  mesh.vert, blend.frag, lib/lighting.glsl
//
// Sorted by the middle of each instance's box: surfaces that cut through each other, or a concave
// one before itself, may come out in the wrong order. Writes no depth, so later passes see through
// it.

struct BlendPass {
    SurfacePrograms programs;
};

[[nodiscard]] Result<BlendPass> create_blend_pass(gpu::Device& device);

/// Radiance with the blended surfaces before it; the same if there are none.
[[nodiscard]] TextureId draw_blended(
    FrameGraph& graph, BlendPass& pass, const FrameScene& scene, TextureId radiance,
    const Gbuffer& gbuffer);

}  // namespace limn
