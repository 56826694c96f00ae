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
// Shaders  mesh.vert, gbuffer.frag, lib/material.glsl; sky_velocity.frag
//
// Velocity is that of the camera and of each vertex: as its instance moves, as joints and morph
// targets move it. Where nothing is, it is that of the camera's turning. Blended surfaces have
// none: a pixel moves as what is seen through them, as only one motion fits in a pixel and the
// opaque one is the sharper. Numbers only, at most eight pictures long; jitter is no motion.

struct GbufferPass {
    SurfacePrograms programs;
    const gpu::Program* sky_velocity = nullptr;
};

[[nodiscard]] Result<GbufferPass> create_gbuffer_pass(gpu::Device& device);

[[nodiscard]] Gbuffer
draw_gbuffer(FrameGraph& graph, GbufferPass& pass, const FrameScene& scene, bool velocity);

}  // namespace limn
