#pragma once

#include "render/frame_scene.h"
#include "render/graph/frame_graph.h"

namespace limn {

// Draws every opaque and alpha-tested surface without lighting it: attributes for the passes that
// follow.
//
// Reads    InstanceList
// Writes   surface attributes (lib/gbuffer.glsl), depth, and velocity if asked for
// Order    first of the image
// Shaders  mesh.vert, gbuffer.frag, lib/material.glsl
//
// Pixels without a surface keep depth 0; their attributes are undefined.

struct GbufferPass {
    SurfacePrograms programs;
};

/// The textures that hold a frame's surfaces.
struct Gbuffer {
    TextureId surface;   ///< RGBA32UI
    TextureId depth;     ///< D32F, reversed: 1 at the near plane, 0 where nothing is
    TextureId velocity;  ///< RG16F, uv now - uv before; not valid() unless asked for
};

[[nodiscard]] Result<GbufferPass> create_gbuffer_pass(gpu::Device& device);

[[nodiscard]] Gbuffer
draw_gbuffer(FrameGraph& graph, GbufferPass& pass, const FrameScene& scene, bool velocity);

}  // namespace limn
