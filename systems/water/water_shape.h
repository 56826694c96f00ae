#pragma once

#include "ecs/components/water_frame.h"
#include "ecs/components/water_walls.h"

namespace limn {

// Boxes, cylinders and ellipsoids in the water: where they are and how much of them is below a
// level. Exact for boxes and cylinders that stand upright and for every ellipsoid; of a tilted box
// as if it were upright.

struct WaterShape {
    WallShape shape = WallShape::Box;
    Vec3 center = {0, 0, 0};  ///< in the water's own space [m]
    Vec3 axes[3];             ///< from there to its sides, in the water's own space [m]
    Vec3 reach = {0, 0, 0};   ///< as far as it is along each axis of the water [m]
    float volume = 0;         ///< [m^3]
};

/// `half` extents about `offset`, both in the space of an entity at `world`.
[[nodiscard]] WaterShape place_shape(
    WallShape shape, const Vec3& half, const Vec3& offset, const Affine& world,
    const WaterFrame& frame);

/// What of it is below `height`, in the water's own space [m^3].
[[nodiscard]] float volume_below(const WaterShape& shape, float height);

}  // namespace limn
