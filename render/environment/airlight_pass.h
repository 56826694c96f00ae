#pragma once

#include "ecs/components/height_fog.h"
#include "render/effect.h"
#include "render/gpu/buffer_texture.h"

namespace limn {

// Light of lamps that height fog scatters toward the camera: halos of point lights, beams of spots.
// The part of a view ray inside a light's sphere and cone is integrated by Gauss-Legendre
// quadrature over the angle that it subtends at the light, where the integrand has no peak
// (Kulla and Fajardo 2012). The light is attenuated by the fog on its way to the ray, too.
// Shadows do not darken it; mirrors and probes do not show it.
//
// Reads    depth; HeightFog, LightList
// Writes   radiance
// Order    after the fog, before blended surfaces and particles
// Shaders  airlight.frag, lib/height_fog.glsl

struct AirlightEffect {
    static constexpr std::size_t kMaxLights = 16;

    const gpu::Program* program = nullptr;
    std::vector<Vec4> texels = {};  ///< of the frame: their number, then kAirlightTexels each
    BufferTexture records = BufferTexture("airlight", GL_RGBA32F);

    [[nodiscard]] static bool is_used(const FrameData& frame);
    [[nodiscard]] static Result<AirlightEffect> create(gpu::Device& device, const RenderSettings&);
    void collect(FrameData& frame);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

}  // namespace limn
