#pragma once

#include "render/graph/frame_graph.h"

namespace limn {

// Keeps what a probe sees toward one face (env.capture).
//
// Reads    radiance of a square picture with a field of view of 90 degrees
// Writes   a face of the probe's cube map
// Order    after the blended surfaces
// Shaders  probe_face.frag

struct ProbePass {
    const gpu::Program* program = nullptr;
};

[[nodiscard]] Result<ProbePass> create_probe_pass(gpu::Device& device);

void keep_probe_face(
    FrameGraph& graph, const ProbePass& pass, TextureId radiance, const gpu::Texture& cube,
    int face);

}  // namespace limn
