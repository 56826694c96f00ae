#pragma once

#include "render/effect.h"
#include "render/gpu/buffer_texture.h"
#include "render/water/ocean_textures.h"
#include "render/water/ripple_atlas.h"
#include "render/water/water_list.h"

namespace limn {

// The surfaces of all waters, for every pass that evaluates them (lib/water_surface.glsl), and
// which of them need caustic maps. Draws nothing.

/// Results of the simulation in a frame, as textures.
struct WaterTextures {
    WaterSources sources;
    RippleAtlas ripples;
    OceanTextures seas;
};

/// The surfaces in a view.
struct WaterSurfaces {
    const WaterTextures* textures = nullptr;
    WaterList list;
    BufferTexture bodies = BufferTexture("waters", GL_RGBA32F);
    BufferTexture lines = BufferTexture("wave lines", GL_RGBA32F);
    BufferTexture rings = BufferTexture("wave rings", GL_RGBA32F);
    BufferTexture details = BufferTexture("water details", GL_RGBA32F);
    BufferTexture texture_waves = BufferTexture("texture waves", GL_RGBA32F);
    BufferTexture patches = BufferTexture("water patches", GL_RGBA32F);

    [[nodiscard]] bool any_seas() const { return !textures->seas.empty(); }
};

/// With the definition OCEAN if any_seas().
void bind_water_surfaces(gpu::Device& device, const WaterSurfaces& waters);

/// The planar reflection of this frame, if some water shows one (water_pass.h).
struct PlanarReflection {
    Entity water;
    const gpu::Texture* map = nullptr;  ///< radiance and distance, upside down, with blurred levels
};

/// Publishes WaterTextures in the frame and, where there is water, WaterSurfaces and WaterShadows
/// in each view; begins the view's CausticList, which CausticsEffect completes.
struct WaterBodiesEffect {
    [[nodiscard]] static bool is_used(const FrameData& frame);
    [[nodiscard]] static Result<WaterBodiesEffect> create(gpu::Device&, const RenderSettings&);
    void collect(FrameData& frame);
    void request_views(FrameData& frame);
    bool prepare(const FrameData& frame, ViewData& view);
};

}  // namespace limn
