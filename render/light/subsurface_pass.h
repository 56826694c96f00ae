#pragma once

#include "render/effect.h"
#include "render/gpu/mip_levels.h"
#include "render/gpu/texture.h"
#include "render/variant.h"

namespace limn {

namespace gpu {
class Program;
}

// Light that scatters below surfaces of the shading model Subsurface and exits around the point
// where it entered, by the normalized profile of Christensen and Burley (2015) over the material's
// mean free path.
//
// Reads    diffuse light without albedo, from the light pass; G-buffer, depth
// Writes   radiance: adds the exiting light times the albedo there
// Order    after lights, before all that lies in front of surfaces
// Shaders  lib/diffused_light.glsl in subsurface.frag or .comp, distance_moments.frag or .comp;
//          diffusion_profile.h
//
// Each pixel sums 80 rings, or 36 or 20 where they cover few pixels, in the tangent plane of its
// surface, in meters, so that the result depends neither on distance nor on tilt; each ring is one
// sample, from the mip level whose texels are about as large as the ring's area. Samples off the
// plane are weighted down by their extra distance, pixels that do not scatter have weight zero, and
// the weights are normalized: uniform light is unchanged.
//
// Only pixels within the screen bounds of such surfaces are processed. A software OpenGL runs
// fragment shaders, which skip all others early; a GPU runs the same function in compute shaders,
// as data-center GPUs have little rasterization hardware.
//
// Only with LightMethod::Clustered; the others shade such surfaces without diffusion, and so do
// probes and blended surfaces. Albedo is taken at the exit point only: textures stay sharp.

struct SubsurfaceEffect {
    bool in_compute;  ///< gpu::Profile::Gpu
    ProgramVariants programs;
    const gpu::Program* moments = nullptr;
    MipLevels levels;
    gpu::Sampler sampler;

    [[nodiscard]] static Result<SubsurfaceEffect>
    create(gpu::Device& device, const RenderSettings&);
    /// Some material scatters: has a mean free path other than 0.
    static bool is_used(const FrameData& frame);
    bool prepare(const FrameData& frame, ViewData& view);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

}  // namespace limn
