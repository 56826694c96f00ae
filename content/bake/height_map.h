#pragma once

#include "content/bake/relief_map.h"
#include "ecs/base/math.h"

#include <vector>

namespace limn {

// Maps from painted or scanned heights (bump.nm-from-height).
//
// The normal at a texel is that of the central differences of its neighbors,
//
//     N = normalize(-dh/du, -dh/dv, 1)
//
// with u to the right and v up the image. 8 bits are few: the steps of a gentle slope show as
// streaks.

/// Rows from top to bottom. 0 is lowest, 1 highest: on the polygon.
struct HeightMap {
    int width = 0;
    int height = 0;
    std::vector<float> heights = {};
    bool repeats = true;  ///< the right edge meets the left one and the bottom the top

    /// Beyond the edges the map repeats, or its edge continues.
    [[nodiscard]] float at(int x, int y) const;
};

/// Unit normal of a surface with the slopes dh/du and dh/dv.
[[nodiscard]] Vec3 normal_of_slope(float du, float dv);

/// Unit normals; `depth`: distance between heights 0 and 1, in widths of the map.
[[nodiscard]] std::vector<Vec3> normals_of(const HeightMap& map, float depth);

/// Shifts and scales all heights to 0 .. 1; a constant map becomes `flat`. Returns the previous
/// least and largest height.
Vec2 normalize_heights(HeightMap& map, float flat = 1);

/// Normals and depths, 1 - height, in the layout Single.
[[nodiscard]] BakedMap relief_of(const HeightMap& map, float depth);

}  // namespace limn
