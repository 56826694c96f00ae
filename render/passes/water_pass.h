#pragma once

#include "render/frame_scene.h"
#include "render/gbuffer.h"
#include "render/gpu/vertex_array.h"
#include "render/water/water_surfaces.h"

namespace limn {

// Draws bodies of water over the lit scene: all of them with one draw.
//
// Reads    WaterList, radiance, depth, light clusters, environment
// Writes   radiance, depth, velocity and, where asked for, attributes of what is water now
// Order    after lights and sky, before blended surfaces
// Shaders  water_behind.frag, water.vert, water.frag, lib/water_surface.glsl,
//          lib/water_reflection.glsl, lib/water_refraction.glsl,
//          lib/water_tracing.glsl, lib/water_foam.glsl
//
// A body may ask for a planar reflection (WaterLook): render_frame() draws it before the picture,
// in a smaller one of its own, and keep_reflection() keeps it for the water.
//
// What lies behind is copied first: the water bends and mirrors it. It therefore sees neither
// itself nor blended surfaces.

struct WaterPass {
    SurfacePrograms surface;
    const gpu::Program* behind = nullptr;
    gpu::VertexArray grid{};
    gpu::Buffer indices{};
    WaterSurfaces surfaces{};
    gpu::Sampler repeat{};      ///< of normal maps
    gpu::Texture foam{};        ///< make_foam_pattern(), once there is a sea
    gpu::Texture reflection{};  ///< radiance and distance, upside down, and blurred levels of it
    BufferTexture patches = BufferTexture("water patches", GL_RGBA32F);
};

[[nodiscard]] Result<WaterPass> create_water_pass(gpu::Device& device);

/// Keeps a picture of make_reflected_view() for the water of the next one.
void keep_reflection(
    FrameGraph& graph, WaterPass& pass, const FrameScene& scene, TextureId radiance,
    const Gbuffer& gbuffer);

/// Radiance with the water; the same where there is none. The G-buffer's depth and velocity become
/// those of the water; with `attributes` its surface, too.
[[nodiscard]] TextureId draw_water(
    FrameGraph& graph, WaterPass& pass, const FrameScene& scene, TextureId radiance,
    const Gbuffer& gbuffer, bool attributes);

}  // namespace limn
