#pragma once

#include "render/frame_scene.h"
#include "render/gbuffer.h"

namespace limn {

// Draws every opaque and alpha-tested surface without lighting it: attributes for the passes that
// follow.
//
// Reads    InstanceList
// Writes   surface attributes (lib/gbuffer.glsl), depth, and velocity if asked for
// Order    first of the image
// Shaders  mesh.vert, gbuffer.frag, lib/material.glsl

struct GbufferPass {
    SurfacePrograms programs;
};

[[nodiscard]] Result<GbufferPass> create_gbuffer_pass(gpu::Device& device);

[[nodiscard]] Gbuffer
draw_gbuffer(FrameGraph& graph, GbufferPass& pass, const FrameScene& scene, bool velocity);

}  // namespace limn
