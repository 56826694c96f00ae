#pragma once

#include "render/effect.h"

namespace limn {

// Underwater fog: absorption and in-scattering between a submerged camera and the surfaces in view
// (Beer-Lambert). Where the surface cuts through the image, only the part below is affected.
//
// Reads    radiance, depth including the water, light clusters, environment, caustic maps
// Writes   a new radiance
// Order    after water, if the camera is or may be submerged
// Shaders  water_veil.frag, lib/water_surface.glsl, lib/water_shafts.glsl
//
// With Caustics::shaft_steps the in-scattered sunlight is ray-marched through the caustic map:
// light shafts, and shadows of objects in between. The mean of the map is 1, so light is conserved.

struct WaterVeilEffect {
    ProgramVariants veil;

    [[nodiscard]] static bool is_used(const FrameData& frame);
    [[nodiscard]] static Result<WaterVeilEffect> create(gpu::Device& device, const RenderSettings&);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

}  // namespace limn
