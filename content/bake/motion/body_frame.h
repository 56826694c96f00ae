#pragma once

#include "content/bake/motion/skeleton_motion.h"
#include "ecs/components/body_measures.h"
#include "ecs/components/humanoid.h"
#include "ecs/components/skeleton.h"

#include <cstdint>
#include <vector>

namespace limn {

// The body of a recorded person in motion; at rest: body_measures.h.

/// Ankles and toes that the skeleton has.
[[nodiscard]] std::vector<std::uint16_t> find_foot_joints(const BodyJoints& body);

/// Moves the joint and all below it by `offset`, in the space of the skeleton, in one frame.
void move_joint(
    const SkeletonData& skeleton, MotionFrames& frames, std::size_t frame, std::uint16_t joint,
    const Vec3& offset);

/// Moves the body root horizontally so that the lowest of ankles and toes stays where it is on the
/// ground: a walk on the spot travels. Returns the distance [m]; 0 without feet.
float add_travel(const SkeletonData& skeleton, MotionFrames& frames);

}  // namespace limn
