#pragma once

#include "ecs/components/skeleton.h"
#include "ecs/components/walk.h"

#include <vector>

namespace limn {

// A generated walk as a clip that travels, for other programs to play.
// Techniques: char.walk-control, char.walk-cycle

/// Where a baked walk goes. The character begins at the origin, as its skeleton is at rest.
struct WalkCourse {
    float pace = 0.0f;                    ///< [m/s], without points, runs where nobody walks so
                                          ///< fast; 0: the comfortable speed
    float turn = 0.0f;                    ///< to the left [rad/s], without points
    std::vector<RoutePoint> points = {};  ///< goes there, one after the other, and stops [m]
    bool standing = false;  ///< begins at rest, as always with points; turns a little later, then
};

/// Poses of the walk at `rate` keys per second for `seconds`; 0: until it stands at the last point,
/// at most kMaxWalkTake. The hips travel, joints that do not move have no keys. Has contacts of
/// toes, and of feet that stand flat, and an event "step" at each landing. Empty for a skeleton
/// without legs. `seconds` >= 0, `rate` > 0; at most kMaxWalkKeys keys.
[[nodiscard]] ClipData make_walk_take(
    const SkeletonData& skeleton, const Walk& walk, const WalkCourse& course, float seconds,
    float rate);

/// Removes rotations and translations of joints that are as at rest in all keys of a sheet.
void drop_still_joints(const SkeletonData& skeleton, ClipSheet& sheet);

inline constexpr float kMaxWalkTake = 600.0f;  ///< [s]
inline constexpr std::size_t kMaxWalkKeys = 100'000;

}  // namespace limn
