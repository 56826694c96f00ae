#pragma once

#include "render/frame_scene.h"
#include "render/gbuffer.h"

namespace limn {

// Lights surfaces while they are drawn, after their depth: no G-buffer. Objects in the outer loop
// (LightMethod::ObjectMajor), each with the lights that reach it, or lights
// (LightMethod::LightMajor), each over the objects that it reaches, added up. The seeds' ways, kept
// beside the clusters to be compared with.
//
// Reads    InstanceList, LightObjects, light records, environment
// Writes   depth, radiance: linear; alpha 1 where a surface is
// Order    in place of the G-buffer and draw_lights()
// Shaders  mesh.vert, depth_first.frag, forward_list.frag, forward_base.frag, forward_one.frag;
//          gouraud.vert, gouraud.frag in place of forward_list.frag with ShadingRate::Vertex
//
// The first pass draws depth alone; the others draw where the depth is EQUAL, so that each visible
// fragment is lit once (engine.depth-first). Where surfaces of two objects share a depth to the
// last bit, as the tops of boxes that overlap, the stencil lets only the first be lit.

struct ForwardPass {
    SurfacePrograms depth;
    SurfacePrograms list;
    SurfacePrograms gouraud;
    SurfacePrograms base;
    SurfacePrograms one;
    const gpu::Program* nothing = nullptr;
};

[[nodiscard]] Result<ForwardPass> create_forward_pass(gpu::Device& device);

/// The depth of all opaque surfaces.
[[nodiscard]] TextureId
draw_depth_first(FrameGraph& graph, ForwardPass& pass, const FrameScene& scene);

/// Radiance of all opaque surfaces, whose depth is in `depth`; black elsewhere.
[[nodiscard]] TextureId
draw_forward(FrameGraph& graph, ForwardPass& pass, const FrameScene& scene, TextureId depth);

}  // namespace limn
