#pragma once

#include "render/effect.h"

namespace limn {

// Draws alpha-blended surfaces over the lit scene, back to front, lit like the opaque ones.
//
// Reads    InstanceList, depth, light clusters, environment
// Writes   radiance
// Order    after lights and sky
// Shaders  mesh.vert, blend.frag, lib/lighting.glsl
//
// Sorted by the center of each instance's box: intersecting surfaces, and concave ones against
// themselves, may be drawn in the wrong order. Writes no depth, so later passes see the surfaces
// behind.

struct BlendEffect {
    ProgramVariants programs;

    [[nodiscard]] static Result<BlendEffect> create(gpu::Device& device, const RenderSettings&);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

}  // namespace limn
