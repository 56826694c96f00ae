#pragma once

#include "ecs/components/environment.h"
#include "render/effect.h"

namespace limn {

// Draws the sky where no surface is, if the environment is visible or for a view that lights.
//
// Reads    depth, environment
// Writes   radiance
// Order    after the lights
// Shaders  sky.frag, lib/sky.glsl

struct SkyEffect {
    const gpu::Program* programs[kSkyKinds] = {};  ///< by SkyKind

    [[nodiscard]] static Result<SkyEffect> create(gpu::Device& device, const RenderSettings&);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

}  // namespace limn
