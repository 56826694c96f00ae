#pragma once

#include "render/frame_scene.h"
#include "render/gbuffer.h"

namespace limn {

// Lights the G-buffer and puts the sky behind it.
//
// Reads    G-buffer, light clusters, environment
// Writes   radiance: linear; alpha 1 where a surface or the sky is
// Order    after the G-buffer
// Shaders  light_pass.frag, sky.frag, lib/lighting.glsl
//
// One pass whatever the number of lights: a pixel sums those of its cell (deferred.light-pass). The
// depth test keeps light to surfaces and the sky to the rest.

struct LightPass {
    SurfacePrograms lights;
    const gpu::Program* sky[kSkyKinds] = {};  ///< by SkyKind
};

[[nodiscard]] Result<LightPass> create_light_pass(gpu::Device& device);

/// Radiance of all opaque surfaces; black elsewhere.
[[nodiscard]] TextureId
draw_lights(FrameGraph& graph, LightPass& pass, const FrameScene& scene, const Gbuffer& gbuffer);

/// Radiance with the sky where no surface is, if the environment is visible or a probe looks.
[[nodiscard]] TextureId draw_sky(
    FrameGraph& graph, const LightPass& pass, const FrameScene& scene, TextureId radiance,
    const Gbuffer& gbuffer);

}  // namespace limn
