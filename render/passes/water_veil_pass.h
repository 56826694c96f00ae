#pragma once

#include "render/frame_scene.h"
#include "render/gbuffer.h"
#include "render/water/water_surfaces.h"

namespace limn {

// What water takes and adds between a camera in it and what it sees: light is lost on the way and
// scattered into it (Beer-Lambert). Where the surface cuts through the picture, only what is below.
//
// Reads    radiance, depth with that of the water, light clusters, environment, caustic maps
// Writes   a new radiance
// Order    after water, where the camera is in it or may be
// Shaders  water_veil.frag, lib/water_surface.glsl, lib/water_shafts.glsl
//
// With Caustics::shaft_steps the sun's share of what is scattered is its mean along the ray of
// sight in the light that waves gather: shafts, and shadows of what stands in the way. Over the map
// that mean is 1, so no light is made or lost.

struct WaterVeilPass {
    SurfacePrograms veil;
};

[[nodiscard]] Result<WaterVeilPass> create_water_veil_pass(gpu::Device& device);

/// Radiance behind the veil; the same where the camera is in no water.
[[nodiscard]] TextureId draw_water_veil(
    FrameGraph& graph, WaterVeilPass& pass, const WaterSurfaces& waters, const FrameScene& scene,
    TextureId radiance, const Gbuffer& gbuffer);

}  // namespace limn
