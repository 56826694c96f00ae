#pragma once

#include "ecs/base/math.h"
#include "ecs/components/humanoid.h"
#include "ecs/components/skeleton.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Measures and joints of a person's skeleton, whatever program it is from.

/// skeleton_from_joint of all joints at rest.
[[nodiscard]] std::vector<Affine> find_rest_matrices(const SkeletonData& skeleton);

/// Rotations of all joints in the space of the skeleton, of those relative to their parents.
[[nodiscard]] std::vector<Quat>
find_frame_rotations(const SkeletonData& skeleton, std::span<const Quat> local);

/// Sum of the lengths of thigh and shin at rest, on average of both legs; 0 without legs [m].
[[nodiscard]] float find_leg_length(const SkeletonData& skeleton, const BodyJoints& body);

/// The lowest joint that carries both legs and the upper body: what moves when the person walks.
/// Without legs the hips; without these the first joint.
[[nodiscard]] std::uint16_t find_body_root(const SkeletonData& skeleton, const BodyJoints& body);

/// The person's left at rest, unit; +x without legs or arms. Knees bend about it.
[[nodiscard]] Vec3 find_left(const SkeletonData& skeleton, const BodyJoints& body);

}  // namespace limn
