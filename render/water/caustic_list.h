#pragma once

#include "render/light_list.h"
#include "render/shaders/caustics_gpu.h"
#include "render/shadow/shadow_list.h"
#include "render/water/water_list.h"

#include <vector>

namespace limn {

// The waters of a frame as what lies in them is lit, and the maps of the light that waves gather.
//
// A map is as the light of flat water sees what is below: a point at depth d below the surface at
// rest lies where its ray entered, xz - bent d, in the water's own space. So all points of a ray
// share a texel, walls have theirs like floors, and where the water is flat the map is 1
// everywhere. A shadow view with the same places tells how deep the ground is and what stands
// before it.
//
// Light that the water mirrors is the same upside down: a point at height h lies where its ray left
// the water, xz - bent h. There the map is 1 above flat water and 0 beside it.
//
// All maps lie in one atlas, the largest first, and the rays of all of them are one list, so that a
// hundred pools are as many dispatches as one. Maps of waters that are far away for their size are
// smaller, and those farthest are smaller still where all would be too much. A grid over the world
// tells which waters a place may be in.

inline constexpr std::size_t kMaxCausticMaps = 1024;  ///< of the nearest waters
inline constexpr std::size_t kMaxMirrorMaps = 4;      ///< every surface looks at all of them
inline constexpr std::int64_t kMostCausticTexels = 1 << 20;

struct CausticList {
    std::vector<layout::SunkenRecord> sunken;  ///< nearest to the camera last
    std::vector<layout::MirrorRecord> mirrors;
    std::vector<layout::CausticPlace> places;
    std::vector<layout::CausticRecord> maps;  ///< to be made, each for the place of its number
    IVec2 atlas = {0, 0};                     ///< [texels]
    std::size_t rays = 0;                     ///< of all maps
    int groups = 0;                           ///< of rays
    std::vector<Vec4> jobs;    ///< groups and `maps`, as lib/caustic_record.glsl reads them
    std::vector<Vec4> texels;  ///< of the records, as lib/caustic_place.glsl reads them
};

/// Chooses waters and maps and asks `shadows` for the views they need: of waters of which `view`
/// may see what lies in them or, where they mirror, what stands above. `maps`: also make maps.
void collect_caustics(
    const WaterList& waters, const LightList& lights, const RenderView& view, bool maps,
    CausticList& list, ShadowList& shadows);

/// After the shadow views have their places.
void place_caustics(const LightList& lights, const ShadowList& shadows, CausticList& list);

/// How far light that comes from `to_sun` (unit, in the water's own space) goes along x and z on a
/// meter down, below flat water.
[[nodiscard]] Vec2 flat_slant(const Vec3& to_sun, float index);
/// The same of light that flat water mirrors, on a meter up.
[[nodiscard]] Vec2 mirrored_slant(const Vec3& to_sun);

}  // namespace limn
