#pragma once

#include "ecs/base/math.h"

namespace limn {

/// A convex obstacle of the plane: a rectangle whose corners are rounded by `radius`, or a disc.
struct CrowdBarrier {
    Vec2 center = {0, 0};  ///< [m]
    Vec2 axis = {1, 0};    ///< unit: of the first side
    Vec2 half = {0, 0};    ///< half of both sides [m]; 0: a disc
    float radius = 0;      ///< [m]
};

/// From a point to a barrier: the distance of its rim [m], < 0 inside, and the unit direction to
/// it.
struct BarrierHit {
    float distance = 0;
    Vec2 toward = {1, 0};
};
[[nodiscard]] BarrierHit find_barrier(const CrowdBarrier& barrier, const Vec2& point);

}  // namespace limn
