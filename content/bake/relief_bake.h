#pragma once

#include "content/bake/bake_rows.h"
#include "content/bake/relief_map.h"
#include "content/bake/tile_surface.h"

#include <cstddef>

namespace limn {

// A mesh as a relief map, by rays that are parallel to the normal of the map's plane (bump.nm-from-
// basrelief, relief.map-bake): per texel the depth of the nearest hit, the interpolated normal
// there, and in the layout Double the depth at which the ray finally leaves the mesh. Undercuts are
// lost.

struct ReliefBake {
    BakedMap map;
    std::size_t empty = 0;  ///< texels that no ray hits: depth 1, flat
    std::size_t open = 0;   ///< Double: rays that enter the mesh and do not leave it: the back is 1
};

/// `width`: of the map; its height follows from the tile. `samples`: rays per texel and direction;
/// depths are averaged, normals, too, and normalized. Layouts: Single or Double.
[[nodiscard]] ReliefBake bake_relief(
    const TileSurface& tile, const TileCaster& caster, ReliefLayout layout, int width, int samples,
    const RowProgress& progress = {});

/// Rows of a map of a tile of this size.
[[nodiscard]] int rows_of(const Vec2& tile_size, int width);

/// A point of the plane by texel coordinates from the top left of the map.
[[nodiscard]] Vec2 tile_point(const TileSurface& tile, int width, int height, float x, float y);

/// Depths of a relief map as heights, to cast rays at or to derive other maps from.
[[nodiscard]] HeightMap heights_of(const BakedMap& relief, bool repeats);

}  // namespace limn
