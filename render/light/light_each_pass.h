#pragma once

#include "render/frame_data.h"

namespace limn {

// Lights the G-buffer one light at a time, additively: over the full screen
// (LightMethod::FullScreen), or only where surfaces lie within the light's volume
// (LightMethod::Volumes). Kept for comparison with the clusters.
//
// Reads    G-buffer, light records, environment
// Writes   radiance: linear; alpha 1 where there is a surface
// Order    after the G-buffer, instead of draw_lights()
// Shaders  light_base.frag, light_one.frag, light_volume.vert, nothing.frag
//
// A volume is drawn twice. First both its sides into the stencil with the depth test failing: back
// faces behind the surface increment and front faces behind it decrement, which leaves 1 where the
// surface lies inside (light.volume-stencil); then its back faces, lighting where the stencil is
// not 0 and resetting it to 0. Works with the camera inside and needs no far plane. Unbounded and
// directional lights have no volume: full screen. Lights that do not reach the visible scene cost
// nothing.

struct LightEachPass {
    ProgramVariants base;
    ProgramVariants screen;
    ProgramVariants volume;
    const gpu::Program* count[2] = {};  ///< into the stencil: sphere, cone
};

[[nodiscard]] Result<LightEachPass> create_light_each_pass(gpu::Device& device);

/// Draws all opaque surfaces into view.radiance. Volumes need a depth buffer with stencil.
void draw_each_light(FrameGraph& graph, LightEachPass& pass, const ViewData& view);

}  // namespace limn
