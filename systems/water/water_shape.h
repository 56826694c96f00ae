#pragma once

#include "ecs/components/water_frame.h"
#include "ecs/components/water_walls.h"

namespace limn {

// Boxes, cylinders and ellipsoids in water: their placement and their volume below a level. Exact
// for upright boxes and cylinders and for all ellipsoids; tilted ones count as upright.

struct WaterShape {
    WallShape shape = WallShape::Box;
    Vec3 center = {0, 0, 0};       ///< in the water's local space [m]
    Vec3 axes[3];                  ///< half axes, in the water's local space [m]
    Vec3 half_extent = {0, 0, 0};  ///< half extents along the water's axes [m]
    float volume = 0;              ///< [m^3]
};

/// Shape with half extents `half` about `offset`, both in the local space of an entity at `world`.
[[nodiscard]] WaterShape place_shape(
    WallShape shape, const Vec3& half, const Vec3& offset, const Affine& world,
    const WaterFrame& frame);

/// Volume below `height`, in the water's local space [m^3].
[[nodiscard]] float volume_below(const WaterShape& shape, float height);

}  // namespace limn
