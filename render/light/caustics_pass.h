#pragma once

#include "render/effect.h"
#include "render/gpu/texture.h"
#include "render/water/caustic_list.h"
#include "render/water/caustic_splat.h"
#include "render/water/water_surfaces.h"

#include <vector>

namespace limn {

// Caustics: light that waves focus and scatter onto surfaces below them
// (caustic.projected-vertices), and that they reflect up onto surfaces above.
//
// Reads    CausticList, water displacement, shadow atlas
// Writes   caustic maps: irradiance relative to that under flat water
// Order    after the shadow maps, before lighting
// Shaders  caustics_rays.comp, caustics_splat.comp, caustics_map.comp, lib/caustic_landing.glsl;
//          lib/under_water.glsl and lib/over_water.glsl read the maps
//
// Rays enter at the points of a grid on the surface, weighted by Fresnel transmittance and shadowed
// by what stands above, and are traced to the ground that light through flat water would hit there.
// A cell of four rays is subdivided until each part lands on about a texel, and the parts are
// summed per texel in integers: no light is lost where waves fold it over, and the sum does not
// depend on order. All maps of a frame lie in an atlas and take three dispatches; where OpenGL runs
// on the CPU, the CPU sums them itself (caustic_splat.h).
//
// After Shah, Konttinen and Pattanaik, "Caustics Mapping", 2007, but with areas that carry light
// instead of triangles. Of objects in the water only the surface nearest to the water counts: light
// that waves bend around an edge continues as on the plane beyond. Reflected light is handled the
// same way upside down, with the Fresnel reflectance; what hits other waves on its way up is lost.
// Meshes that reflect light are in mirror_caustic_pass.h.

/// The caustic maps of a view, published when they are declared in the frame graph.
struct CausticMaps {
    TextureId atlas;
};

/// Completes the CausticList of each view, publishes CausticMaps in draw().
struct CausticsEffect {
    ProgramVariants rays;
    bool on_cpu = false;  ///< splats are summed on the CPU
    const gpu::Program* splat = nullptr;
    const gpu::Program* map = nullptr;
    gpu::Texture maps{};  ///< the atlas; 1x1 until there is a map
    CausticSums sums_on_cpu{};
    std::vector<Vec4> rays_on_cpu{};
    std::vector<float> atlas_on_cpu{};

    [[nodiscard]] static bool is_used(const FrameData& frame);
    [[nodiscard]] static Result<CausticsEffect> create(gpu::Device& device, const RenderSettings&);
    bool prepare(const FrameData& frame, ViewData& view);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

}  // namespace limn
