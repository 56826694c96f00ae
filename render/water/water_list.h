#pragma once

#include "ecs/components/caustics.h"
#include "ecs/components/water.h"
#include "ecs/components/water_frame.h"
#include "ecs/components/water_look.h"
#include "ecs/components/water_waves.h"
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

// All bodies of water at the time that a view shows, ready to draw.

/// The water that the camera is in, or may be in because of waves.
struct WaterAroundView {
    int body = 0;
    bool at_surface = false;  ///< the surface may cross the image
};

/// Encodes a look for WaterRecord::scattering.w: fresnel + 4 reflection + 16 refraction.
[[nodiscard]] float pack_look(const WaterLook& look);

/// The bodies of water of the world, whatever the view.
struct WaterSources {
    struct Body {
        Entity entity;
        const Water* water = nullptr;
        const WaterLook* look = nullptr;  ///< or null, as the next ones
        const WaterDetail* detail = nullptr;
        const WaveTable* table = nullptr;
        const Caustics* caustics = nullptr;
        WaterFrame frame;
    };
    std::vector<Body> bodies;                 ///< in world order
    std::vector<const RippleState*> ripples;  ///< per body, or null
    std::vector<OceanSource> seas;            ///< per body
    float now = 0;       ///< time shown, relative to the end of the last step [s]
    float previous = 0;  ///< the same of the previous frame [s]
    double time = 0;     ///< at the end of the last step [s]
};

/// Reads the world at the time that `view` shows; pointers are valid until it changes.
void read_water_sources(const World& world, const RenderView& view, WaterSources& sources);

struct WaterList {
    std::vector<layout::WaterRecord> bodies;  ///< in world order
    std::vector<layout::WaveLineRecord> lines;
    std::vector<layout::WaveRingRecord> rings;
    std::vector<WaterPatch> patches;       ///< of all bodies; flat ones last
    std::vector<WaterPatch> flat_patches;  ///< for sorting them
    std::size_t first_flat_patch = 0;
    std::optional<WaterAroundView> around{};  ///< the first found
    bool visible_from_below = false;          ///< the camera may be below the waves of some surface
    std::vector<Entity> entities;
    std::vector<const Caustics*> caustics;  ///< per body, or null
    std::vector<Vec2> heights;              ///< per body: minimum and maximum wave height [m]
    WaterDetails details;
    bool crests = false;                 ///< some body has whitecaps (WaterLook::foam_below)
    bool looks = false;                  ///< some body has a non-default WaterLook
    bool planar = false;                 ///< some body has the planar reflection
    bool traced = false;                 ///< some body has screen-space reflections
    bool bent = false;                   ///< some body traces refracted rays in screen space
    const WaterLook* floor = nullptr;    ///< the first with a floor map
    const WaterLook* ceiling = nullptr;  ///< the first with a reflection map

    [[nodiscard]] bool empty() const { return patches.empty(); }
};

/// Builds the list at the time that `view` shows; reuses the memory of `list`. `planar` is the body
/// with the planar reflection. `seas` holds what read_water_sources() uploaded.
void build_water_list(
    const WaterSources& sources, const RenderView& view, Entity planar, const RippleAtlas& ripples,
    const OceanTextures& seas, WaterList& list);

}  // namespace limn
