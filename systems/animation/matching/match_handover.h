#pragma once

#include "ecs/components/motion_match.h"
#include "ecs/components/motor.h"
#include "ecs/components/motor_pose.h"
#include "ecs/components/skeleton.h"
#include "ecs/components/walk.h"
#include "systems/animation/matching/match_step.h"
#include "systems/animation/walk/walk_body.h"

namespace limn {

// A hero walks and runs by motion matching, and jumps, wades, swims, pushes and stoops by the poses
// of its motor. Where one follows the other, what is shown goes on as it was for a step, in which
// the velocity of the new pose is measured; then the offset of every joint decays
// (inertial_offset.h). Feet have offsets of their own, in the space of the character, so that one
// which both have on the ground stays where it is.
// Techniques: char.blend, char.motion-select

/// Whether a motor's pose is needed. `away`: whether it is shown now, which it is a little longer.
[[nodiscard]] bool is_more_than_walking(
    const MotorState& motor, const MotorPoseState& pose, const WalkBody& body, bool away);

/// Puts the feet of a walk where motion matching shows them, in the middle of a step or not.
void leave_motion_match(
    const MatchContext& context, const Transform& transform, float dt,
    const MotionMatchState& state, WalkState& walk);

/// Shows `pose` with what is left of the last handover, and remembers it; a step of `dt` [s].
/// `away`: whether it is the pose of a motor.
void step_handover(
    const SkeletonData& skeleton, const WalkBody& body, bool away, float dt,
    MatchHandover& handover, LocalPose& pose);

}  // namespace limn
