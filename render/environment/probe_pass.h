#pragma once

#include "render/effect.h"
#include "render/environment/env_probe_list.h"

namespace limn {

// Copies a rendered probe face into its cube map (env.capture).
//
// Reads    radiance of a square view with a field of view of 90 degrees
// Writes   a face of the probe's cube map
// Order    after the blended surfaces
// Shaders  probe_face.frag

// The faces that are due are views of their own, drawn before the main one; when a round of six is
// complete, the cube becomes a layer of the reflection maps (environment_pass.h).

struct ProbeEffect {
    const gpu::Program* program = nullptr;
    EnvProbeList probes{};
    int faces_drawn = 0;  ///< in this frame

    [[nodiscard]] static Result<ProbeEffect> create(gpu::Device& device, const RenderSettings&);
    void request_views(FrameData& frame);
    bool prepare(const FrameData& frame, ViewData& view);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
    void report(const FrameData& frame, const ViewData& view, FrameOutput& out);
};

}  // namespace limn
