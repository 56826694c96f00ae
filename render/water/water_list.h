#pragma once

#include "ecs/components/caustics.h"
#include "ecs/components/water_look.h"
#include "ecs/entity.h"
#include "render/render_view.h"
#include "render/shaders/water_gpu.h"
#include "render/water/ocean_textures.h"
#include "render/water/ripple_atlas.h"
#include "render/water/water_details.h"
#include "render/water/water_patches.h"

#include <optional>
#include <vector>

namespace limn {

// All bodies of water at the moment that a view shows, ready to be drawn.

/// The water that the camera is in, or that waves may wash over it.
struct WaterAroundView {
    int body = 0;
    bool at_surface = false;  ///< the surface may cut through the picture
};

/// How a body is drawn, in WaterRecord::scattering.w: fresnel + 4 reflection + 16 refraction.
[[nodiscard]] float pack_look(const WaterLook& look);

struct WaterList {
    std::vector<layout::WaterRecord> bodies;  ///< in world order
    std::vector<layout::WaveLineRecord> lines;
    std::vector<layout::WaveRingRecord> rings;
    std::vector<WaterPatch> patches;
    std::vector<const RippleState*> ripples;  ///< of each body, or null
    std::vector<OceanSource> seas;            ///< of each body, in the same order
    std::optional<WaterAroundView> around{};  ///< the first there is
    bool seen_from_below = false;  ///< some surface may be: the camera is no higher than its waves
    std::vector<Entity> entities;
    std::vector<const Caustics*> caustics;  ///< of each body, or null
    std::vector<Vec2> heights;              ///< of each body: how low and high its waves go [m]
    WaterDetails details;
    bool looks = false;                ///< some body is not drawn as usual (WaterLook)
    bool planar = false;               ///< a body has the planar reflection
    bool traced = false;               ///< some body mirrors what the picture shows
    bool bent = false;                 ///< some body shows the picture where bent rays go
    const WaterLook* floor = nullptr;  ///< the first with a map of its floor

    [[nodiscard]] bool empty() const { return patches.empty(); }
};

/// Everything at the moment that `view` shows; keeps the memory of `list`. The textures get the
/// ripples and patches of all bodies; `velocity`: also of the moment before. `planar` has the
/// planar reflection.
void collect_waters(
    const World& world, const RenderView& view, bool velocity, Entity planar, int max_texture_size,
    RippleAtlas& ripples, OceanTextures& seas, WaterList& list);

}  // namespace limn
