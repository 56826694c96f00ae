#pragma once

#include "ecs/base/math.h"
#include "ecs/components/skeleton.h"
#include "ecs/components/twist_joints.h"

#include <span>
#include <vector>

namespace limn {

// Twist of limbs, spread over twist joints. A rotation q is a swing of the bone and a twist about
// it: for a unit axis a, the twist is q's projection (w, (v . a) a), normalized. Skin of a forearm
// turns with the hand, from nothing at the elbow to all of it at the wrist; that of an upper arm
// from half of the arm's own twist at the shoulder to all of it at the elbow; legs likewise.
// After P. Dobrowolski, "Swing-twist decomposition in Clifford algebra" (2015), and L. Kavan et
// al., "Skinning with Dual Quaternions" (2007), for what it repairs.
// Techniques: char.skin-defects

/// Angle of the twist of a unit rotation about a unit axis, -pi .. pi [rad]; 0 where it has none,
/// at a swing by pi.
[[nodiscard]] float twist_angle(const Quat& rotation, const Vec3& axis);

/// The twist joints that are named, or those of a person by their names and places. Joints that do
/// not exist, and those of bones without length, are left out.
[[nodiscard]] std::vector<TwistLink>
find_twist_links(const SkeletonData& skeleton, std::span<const TwistJoint> asked);

/// Turns the joints of `links` from their animated rotations by `weight`.
void apply_twist_joints(
    const SkeletonData& skeleton, std::span<const TwistLink> links, float weight, LocalPose& pose);

}  // namespace limn
