#pragma once

#include "ecs/components/ik.h"
#include "ecs/components/skeleton.h"
#include "systems/animation/ik/elbow_circle.h"

#include <span>

namespace limn {

// Inverse kinematics on the local pose of a character: what its components ask for, done by the
// solvers. Each function reads the animated pose and blends its result into it.
// Techniques: char.elbow-circle, char.ik-hybrid, char.ik-iterate, char.ik-penalty,
//     char.ik-two-link, char.ik-weights, char.motion-constrain

/// The chains of the rig, in order. `last`: joint matrices of the last step, for chains that
/// continue; empty: there are none.
void apply_ik_rig(
    const SkeletonData& skeleton, const IkRig& rig, const IkGoals& goals,
    std::span<const Affine> last, LocalPose& pose);

void apply_look_at(
    const SkeletonData& skeleton, const LookAt& look, const Gaze& gaze, LocalPose& pose);

/// Reaches for the target with each tip by the weight of the state; with ReachPolicy::Must the root
/// moves by what is left.
void apply_reach(
    const SkeletonData& skeleton, const ReachGoal& goal, const ReachState& state, LocalPose& pose);

/// Weight of a reach at a time: 0 -> 1 over `before`, 1 from `time` on for `hold`, and back over
/// `after`, with a slope of 0 at both ends.
[[nodiscard]] float reach_weight(const ReachGoal& goal, double time);

/// Three joints of a skeleton, from shoulder or hip to wrist or ankle; others may be between them.
struct LimbJoints {
    std::uint16_t root = 0;
    std::uint16_t middle = 0;
    std::uint16_t tip = 0;
};

/// The limb of `bones` bones that ends at `tip`; the middle is halfway. A tip without enough
/// ancestors gets what there is.
[[nodiscard]] LimbJoints
find_limb(const SkeletonData& skeleton, std::uint16_t tip, std::size_t bones);

struct LimbReach {
    Vec3 target = {0, 0, 0};  ///< in the space of the skeleton [m]
    Vec3 offset = {0, 0, 0};  ///< of the point that reaches, in the tip's space [m]
    LimbOptions options = {};
    float weight = 1.0f;
};

/// Turns root and middle of a limb so that its tip is at the target, in closed form. Returns where
/// the point is at full weight.
Vec3 reach_with_limb(
    const SkeletonData& skeleton, const LimbJoints& limb, const LimbReach& reach, LocalPose& pose);

/// Gives a joint this rotation in the space of the skeleton, blended by `weight`.
void set_joint_rotation(
    const SkeletonData& skeleton, std::uint16_t joint, const Quat& rotation, float weight,
    LocalPose& pose);

}  // namespace limn
