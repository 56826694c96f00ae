#pragma once

#include "render/effect.h"
#include "render/geometry/instance_list.h"

#include <set>

namespace limn {

// Draws the attributes of every opaque and alpha-tested surface, unlit, for the passes that follow.
//
// Reads    InstanceList
// Writes   surface attributes (lib/gbuffer.glsl), depth, velocity if requested, and the material
//          where a shading model reads its record when lit
// Order    first pass of the frame
// Shaders  mesh.vert, gbuffer.frag, lib/material.glsl; sky_velocity.frag
//
// Velocity includes the motion of the camera, of each instance, and of each vertex by joints and
// morph targets. For the background it is the camera's rotation. Blended surfaces have no velocity:
// a pixel holds one motion, that of the opaque surface behind, which is the sharper. Always finite,
// at most eight image sizes long; jitter is excluded.

// With forward lighting, which needs no attributes, a depth prepass replaces it.

/// Depth format of a view: with stencil if shadow or light volumes use it, or to light each pixel
/// only once.
[[nodiscard]] GLenum depth_format(const ViewData& view);

/// Publishes InstanceList in each view.
struct GbufferEffect {
    ProgramVariants programs;
    ProgramVariants depth_first;
    const gpu::Program* sky_velocity = nullptr;
    InstanceCollector collector{};
    std::set<std::uint32_t> reported_meshes{};  ///< that lack the tangents of their normal map

    [[nodiscard]] static Result<GbufferEffect> create(gpu::Device& device, const RenderSettings&);
    bool prepare(const FrameData& frame, ViewData& view);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
    void report(const FrameData& frame, const ViewData& view, FrameOutput& out);
};

}  // namespace limn
