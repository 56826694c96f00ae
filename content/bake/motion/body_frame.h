#pragma once

#include "content/bake/motion/skeleton_motion.h"
#include "ecs/components/humanoid.h"
#include "ecs/components/skeleton.h"

#include <cstdint>
#include <vector>

namespace limn {

// Measures and joints of a person's skeleton, whatever program it is from.

/// skeleton_from_joint of all joints at rest.
[[nodiscard]] std::vector<Affine> find_rest_matrices(const SkeletonData& skeleton);

/// Sum of the lengths of thigh and shin at rest, on average of both legs; 0 without legs [m].
[[nodiscard]] float find_leg_length(const SkeletonData& skeleton, const BodyJoints& body);

/// Ankles and toes that the skeleton has.
[[nodiscard]] std::vector<std::uint16_t> find_foot_joints(const BodyJoints& body);

/// The lowest joint that carries both legs and the upper body: what moves when the person walks.
/// Without legs the hips; without these the first joint.
[[nodiscard]] std::uint16_t find_body_root(const SkeletonData& skeleton, const BodyJoints& body);

/// Moves the joint and all below it by `offset`, in the space of the skeleton, in one frame.
void move_joint(
    const SkeletonData& skeleton, MotionFrames& frames, std::size_t frame, std::uint16_t joint,
    const Vec3& offset);

/// Moves the body root horizontally so that the lowest of ankles and toes stays where it is on the
/// ground: a walk on the spot travels. Returns the distance [m]; 0 without feet.
float add_travel(const SkeletonData& skeleton, MotionFrames& frames);

}  // namespace limn
