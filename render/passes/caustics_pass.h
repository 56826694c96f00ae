#pragma once

#include "render/frame_scene.h"
#include "render/water/caustic_list.h"
#include "render/water/caustic_splat.h"
#include "render/water/water_surfaces.h"

#include <unordered_map>

namespace limn {

// Light that waves gather and scatter on what lies below them (caustic.projected-vertices), and
// that they throw up on what stands above.
//
// Reads    CausticList, what moves the water, shadow atlas
// Writes   caustic maps: light that arrives over the light that flat water sends there
// Order    after the shadow maps, before whatever is lit
// Shaders  caustics_rays.comp, caustics_splat.comp, caustics_map.comp, lib/caustic_landing.glsl;
//          lib/under_water.glsl and lib/over_water.glsl read the maps
//
// Rays enter at the points of a grid on the surface, as much light as Fresnel's equations let in
// and what stands above does not take, and are followed down to the ground that the light of flat
// water would meet there. A cell of four rays is cut into as many as keep together where they land,
// and these are summed by texels in whole numbers: no light is lost where waves fold it over, and
// the sum is the same in any order. All maps of a frame lie in an atlas and are three dispatches;
// where the CPU draws, it sums them itself (caustic_splat.h).
//
// After Shah, Konttinen and Pattanaik, "Caustics Mapping", 2007, but with areas for light instead
// of triangles. Of what stands in the water the ground nearest to the surface counts: light that
// waves bend around an edge goes straight on from there as on the plane beyond. Mirrored light is
// the same upside down, with the share that Fresnel's equations mirror; that other waves meet on
// its way up is lost. Meshes that mirror light are mirror_caustic_pass.h.

struct CausticsPass {
    std::unordered_map<std::uint32_t, const gpu::Program*> rays;  ///< by lighting_key and ocean
    bool on_cpu = false;                                          ///< sums are made there
    const gpu::Program* splat = nullptr;
    const gpu::Program* map = nullptr;
    gpu::Texture maps;  ///< the atlas; one texel until there is one
    CausticList list;
    CausticSums sums_on_cpu;
    std::vector<Vec4> rays_on_cpu;
    std::vector<float> atlas_on_cpu;
    BufferTexture jobs = BufferTexture("caustics", GL_RGBA32F);
    BufferTexture waters = BufferTexture("water lights", GL_RGBA32F);
};

[[nodiscard]] Result<CausticsPass> create_caustics_pass(gpu::Device& device);

/// Room for the maps of the list.
void resize_caustic_atlas(CausticsPass& pass);

/// This frame's maps; not valid where there are none.
[[nodiscard]] TextureId draw_caustics(
    FrameGraph& graph, CausticsPass& pass, const WaterSurfaces& waters, const FrameScene& scene);

}  // namespace limn
