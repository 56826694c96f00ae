#pragma once

#include "ecs/components/skeleton.h"
#include "systems/animation/ik/pose_ik.h"

#include <cstdint>

namespace limn {

// The rhythm of a shoulder: of what an arm is raised beyond 30 degrees, the shoulder girdle takes a
// third and the joint of the upper arm the rest. A skeleton has one joint for the girdle, the
// collar bone, which rises about the breast bone. In the rest pose it is taken to be where it is
// when arms hang, so an arm that rests higher than 30 degrees begins there. Forward and backward
// motion of the shoulder blade is not part of it.
// After V. Inman, J. Saunders, L. Abbott, "Observations on the Function of the Shoulder Joint"
// (1944).
// Techniques: char.motion-constrain

/// An arm of a person; 0xffff: the skeleton lacks the joint.
struct ShoulderJoints {
    std::uint16_t collar = 0xffff;
    std::uint16_t upper = 0xffff;
    std::uint16_t fore = 0xffff;
};

/// The collar bone that carries an upper arm; 0xffff: it is none of a person, or has none.
[[nodiscard]] std::uint16_t find_collar(const SkeletonData& skeleton, std::uint16_t upper);

/// How far the collar bone is raised from rest [rad] by an arm at this angle from hanging, which
/// rests at another. Smooth about the angle at which it begins.
[[nodiscard]] float girdle_turn(float elevation, float rest_elevation);

/// Turns the collar bone as the upper arm asks; the arm keeps its direction and moves with the
/// shoulder. `weight`: from the collar bone's rotation in the pose, 0, to the rhythm, 1.
void raise_collar(
    const SkeletonData& skeleton, const ShoulderJoints& shoulder, float weight, LocalPose& pose);

/// As reach_with_limb, of an arm whose collar bone follows; 0xffff: the limb alone.
Vec3 reach_with_arm(
    const SkeletonData& skeleton, std::uint16_t collar, const LimbJoints& limb,
    const LimbReach& reach, LocalPose& pose);

}  // namespace limn
