#pragma once

#include "render/frame_scene.h"
#include "render/gbuffer.h"

namespace limn {

// Lights the G-buffer light by light, each added to what is there: over the whole picture
// (LightMethod::FullScreen), or where surfaces lie within the light's volume
// (LightMethod::Volumes). The seeds' ways, kept beside the clusters to be compared with.
//
// Reads    G-buffer, light records, environment
// Writes   radiance: linear; alpha 1 where a surface is
// Order    after the G-buffer, in place of draw_lights()
// Shaders  light_base.frag, light_one.frag, light_volume.vert, nothing.frag
//
// A volume is drawn twice. First both its sides into the stencil: where a side lies behind the
// surface, back faces add one and front faces take one away, which leaves 1 where the surface lies
// within (light.volume-stencil); then its back faces, lighting where the stencil is not 0 and
// making it 0 again. Works with the camera inside and needs no far plane. Lights without an end and
// directional ones have no volume: full screen. Lights that do not reach the picture cost nothing.

struct LightEachPass {
    SurfacePrograms base;
    SurfacePrograms screen;
    SurfacePrograms volume;
    const gpu::Program* count[2] = {};  ///< into the stencil: of a ball, of a cone
};

[[nodiscard]] Result<LightEachPass> create_light_each_pass(gpu::Device& device);

/// Radiance of all opaque surfaces; black elsewhere. Volumes need a depth buffer with stencil.
[[nodiscard]] TextureId draw_each_light(
    FrameGraph& graph, LightEachPass& pass, const FrameScene& scene, const Gbuffer& gbuffer);

}  // namespace limn
