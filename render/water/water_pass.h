#pragma once

#include "render/effect.h"
#include "render/gpu/buffer.h"
#include "render/gpu/texture.h"
#include "render/gpu/vertex_array.h"

namespace limn {

// Draws all bodies of water over the lit scene, deferred: their surfaces into a visibility buffer,
// with one draw call for the patches that waves displace and one for flat ones, then the shading of
// the visible pixels.
//
// Reads    WaterList, radiance, depth, light clusters, environment
// Writes   radiance, depth, velocity and, if requested, surface attributes where there is water
// Order    after lights and sky, before blended surfaces
// Shaders  water_behind.frag, water_highest.frag, water_columns.frag, water.vert,
//          water_surface.frag, water_pixels.frag, water.frag, lib/water_surface.glsl,
//          lib/water_reflection.glsl, lib/water_refraction.glsl, lib/water_tracing.glsl,
//          lib/water_foam.glsl, lib/water_visibility.glsl
//
// A body may have a planar reflection (WaterLook): a view of its own, at lower resolution, that
// WaterMirrorEffect requests and stores.
//
// The scene behind is copied first, for refraction and screen-space reflection; the water therefore
// shows neither itself nor blended surfaces.

struct WaterEffect {
    ProgramVariants surface;  ///< water_surface.frag
    ProgramVariants light;    ///< water.frag
    const gpu::Program* pixels = nullptr;
    const gpu::Program* highest = nullptr;
    const gpu::Program* columns = nullptr;
    const gpu::Program* waves = nullptr;  ///< texture_waves.frag
    gpu::VertexArray grid{};
    gpu::Buffer indices{};
    gpu::Sampler repeat{};          ///< of normal maps
    gpu::Texture foam{};            ///< make_foam_pattern(), once there is a sea
    gpu::Texture wave_tiles{};      ///< slopes of waves that fit into a tile
    std::uint64_t waves_frame = 0;  ///< number of the frame whose waves the tiles show

    [[nodiscard]] static bool is_used(const FrameData& frame);
    [[nodiscard]] static Result<WaterEffect> create(gpu::Device& device, const RenderSettings&);
    static void add_warm_up_views(const FrameData& frame, std::vector<RenderView>& views);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
    void report(const FrameData& frame, const ViewData& view, FrameOutput& out);
};

/// Planar reflections: requests the mirrored view, and stores its image with distances and blurred
/// levels. Publishes PlanarReflection.
struct WaterMirrorEffect {
    const gpu::Program* copy = nullptr;
    gpu::Texture map{};

    [[nodiscard]] static bool is_used(const FrameData& frame);
    [[nodiscard]] static Result<WaterMirrorEffect>
    create(gpu::Device& device, const RenderSettings&);
    void request_views(FrameData& frame);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

}  // namespace limn
