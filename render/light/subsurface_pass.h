#pragma once

#include "render/effect.h"
#include "render/gpu/mip_levels.h"
#include "render/gpu/texture.h"
#include "render/variant.h"

namespace limn {

namespace gpu {
class Program;
}

// Light that scatters under surfaces of the shading model Subsurface and leaves around the point
// where it entered, by the normalized profile of Christensen and Burley (2015) over the material's
// mean free path.
//
// Reads    diffuse light before the albedo, which the light pass draws apart; G-buffer, depth
// Writes   radiance: adds what leaves, times the albedo there
// Order    after lights, before all that lies in front of surfaces
// Shaders  lib/diffused_light.glsl in subsurface.frag or .comp, distance_moments.frag or .comp;
//          diffusion_profile.h
//
// Each pixel sums 80 rings, or 36 or 20 where they cover few pixels, in the tangent plane of its
// surface, in meters, so that neither distance nor tilt changes what is seen; each ring is one
// sample of a mip level about as wide as the ring's share of the plane. What lies off the plane
// counts less by how much farther it is, what does not scatter not at all, and the rest is scaled
// to a share of one: uniform light is unchanged.
//
// Only pixels within the boxes of such surfaces are visited, none where no box is in view. A
// software OpenGL runs fragment shaders, which skip all others early; a GPU runs the same function
// in compute shaders, as GPUs made for computing rasterize with few of their processors.
//
// Only with LightMethod::Clustered; the others shade such surfaces without diffusion, and so do
// probes and blended surfaces. Light enters with the albedo of where it leaves: textures stay
// sharp.

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
