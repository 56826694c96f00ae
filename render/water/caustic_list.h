#pragma once

#include "render/gpu/buffer_texture.h"
#include "render/light/light_list.h"
#include "render/shaders/caustics_gpu.h"
#include "render/shadow/shadow_list.h"
#include "render/water/water_list.h"

#include <vector>

namespace limn {

// The waters of a frame, for lighting submerged surfaces, and the maps of their caustics.
//
// A map is parameterized along light refracted by flat water: a point at depth d below the surface
// at rest maps to where its ray entered, xz - bent d, in the water's own space. So all points of a
// ray share a texel, walls are covered like floors, and under flat water the map is 1 everywhere. A
// shadow view with the same parameterization holds the depth of the ground and of what blocks
// the light.
//
// Reflected light is the same upside down: a point at height h maps to where its ray left the
// water, xz - bent h. There the map is 1 above flat water and 0 outside.
//
// All maps lie in one atlas, largest first, and the rays of all of them form one list, so that a
// hundred pools take as many dispatches as one. Maps of waters that are far away for their size are
// smaller, and the farthest shrink further if the total exceeds the budget. A grid over the world
// lists which waters may contain a position.

inline constexpr std::size_t kMaxCausticMaps = 1024;  ///< for the nearest waters
inline constexpr std::size_t kMaxMirrorMaps = 4;      ///< every surface samples all of them
inline constexpr std::int64_t kMaxCausticTexels = 1 << 20;

struct CausticList {
    std::vector<layout::UnderwaterRecord> sunken;  ///< sorted, nearest to the camera last
    std::vector<layout::MirrorRecord> mirrors;
    std::vector<layout::CausticTile> tiles;
    std::vector<layout::CausticRecord> maps;  ///< to be rendered, map i for tiles[i]
    IVec2 atlas = {0, 0};                     ///< [texels]
    std::size_t rays = 0;                     ///< total of all maps
    int groups = 0;                           ///< work groups of rays
    std::vector<Vec4> jobs;                   ///< groups and `maps`, for lib/caustic_record.glsl
    std::vector<Vec4> texels;                 ///< all records, for lib/caustic_tile.glsl
    BufferTexture job_texture = BufferTexture("caustics", GL_RGBA32F);
    BufferTexture record_texture = BufferTexture("water lights", GL_RGBA32F);
};

/// Chooses waters and maps and requests their views from `shadows`: for waters whose submerged
/// contents or, if they reflect, surroundings above may be visible in `view`. `maps`: also render
/// maps.
void collect_caustics(
    const WaterList& waters, const LightList& lights, const RenderView& view, bool maps,
    CausticList& list, std::vector<WaterShadow>& shadows);

/// Completes the records; call once the shadow views are in their atlas.
void finish_caustics(const LightList& lights, const ShadowList& shadows, CausticList& list);

/// Horizontal displacement (x, z) per meter of depth of light from `to_sun` (unit, in the water's
/// own space), refracted by flat water of refractive `index`.
[[nodiscard]] Vec2 refracted_slope(const Vec3& to_sun, float index);
/// The same for light reflected by flat water, per meter of height.
[[nodiscard]] Vec2 reflected_slope(const Vec3& to_sun);

}  // namespace limn
