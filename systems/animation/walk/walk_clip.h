#pragma once

#include "ecs/components/skeleton.h"
#include "ecs/components/walk.h"

#include <cstddef>

namespace limn {

// A walk as a clip: what a crowd plays instead of inverse kinematics.
// Techniques: char.crowd-script

/// One cycle at the comfortable speed, from the lift-off of the left foot, on the spot: the
/// character's origin stays, feet on the ground move back. Rotations and translations of all joints
/// at `keys` >= 2 equal time steps, the last key equal to the first; an event "step" at each
/// landing. Without legs, a clip of the rest pose.
[[nodiscard]] ClipData
make_walk_clip(const SkeletonData& skeleton, const Walk& walk, std::size_t keys = 33);

/// The speed at which its feet do not slide [m/s].
[[nodiscard]] float walk_clip_speed(const SkeletonData& skeleton, const Walk& walk);

}  // namespace limn
