#pragma once

#include "ecs/components/motion_match.h"
#include "ecs/components/motor.h"
#include "ecs/components/move_intent.h"
#include "ecs/components/transform.h"
#include "systems/animation/matching/match_database.h"

namespace limn {

// Steps of motion matching for one character: search, transitions, root motion, feet, pose.
// Techniques: char.blend, char.motion-select

/// What a step needs; all belong together.
struct MatchContext {
    const Assets& assets;
    const SkeletonData& skeleton;
    const MatchDatabase& database;
    const MotionMatch& match;
    const MotorState* motor = nullptr;  ///< moves the character; null: clips do
};

/// Advances by `dt` [s], at most 10, in parts that searches divide. The first call searches in all
/// frames, and shows the one that it finds. A database without rows: changes nothing.
void step_motion_match(
    const MatchContext& context, const MoveIntent& intent, float dt, MotionMatchState& state,
    Transform& transform);

/// Begins where another pose has ended: the frame of all that goes on from `shown` and to where the
/// intent leads. `shown`: joints and feet in the space of the character; `dt`: between its two
/// poses [s].
void enter_motion_match(
    const MatchContext& context, const MoveIntent& intent, const MatchHandover& shown, float dt,
    const Transform& transform, MotionMatchState& state);

/// The wanted path and the played pose as a row of the database.
[[nodiscard]] MatchRow make_match_query(
    const MatchContext& context, const MoveIntent& intent, const MotionMatchState& state,
    const Transform& transform);

/// Pose in the space of the character; joints that no clip animates as in the rest pose.
void find_match_pose(
    const MatchContext& context, const MotionMatchState& state, const Transform& transform,
    LocalPose& pose);

/// Gives joints that clips animate the pose of this step.
void apply_match_pose(const MatchPose& match, LocalPose& pose);

}  // namespace limn
