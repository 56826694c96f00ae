#pragma once

#include "render/effect.h"
#include "render/gpu/mip_levels.h"

namespace limn {

// Draws alpha-blended surfaces and clear media over the lit scene, back to front, lit like the
// opaque ones. Clear media show the image behind them refracted (lib/transmission.glsl).
//
// Reads    InstanceList, depth, light clusters, environment
// Writes   radiance, depth
// Order    after lights and sky
// Shaders  mesh.vert, blend.frag, lib/lighting.glsl, lib/transmission.glsl
//
// Sorted by the center of each instance's box: intersecting surfaces, and concave ones against
// themselves, may be drawn in the wrong order. Of media with thickness only the nearest surface is
// drawn: its image is that of all of the medium. Clear media do not show other blended surfaces
// behind them. Later passes, such as depth of field, read the depth of a medium with thickness;
// otherwise that of the surface behind, so that snow is visible through a window.

struct BlendEffect {
    ProgramVariants programs;
    ProgramVariants depths;
    MipLevels levels;

    [[nodiscard]] static Result<BlendEffect> create(gpu::Device& device, const RenderSettings&);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

}  // namespace limn
