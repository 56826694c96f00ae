#pragma once

#include "ecs/components/height_fog.h"
#include "render/effect.h"

namespace limn {

// Fog between the camera and surfaces, water and sky (render/environment/fog_block.h).
//
// Reads    depth; HeightFog, LightList
// Writes   radiance; the view's FogBlock
// Order    after water, before blended surfaces and particles, which add the fog in front of them
// Shaders  fog.frag, lib/height_fog.glsl
//
// Reflected and refracted light is fogged only along the path from the camera to the surface.

struct FogEffect {
    const gpu::Program* program = nullptr;

    [[nodiscard]] static bool is_used(const FrameData& frame);
    [[nodiscard]] static Result<FogEffect> create(gpu::Device& device, const RenderSettings&);
    bool prepare(const FrameData& frame, ViewData& view);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

}  // namespace limn
