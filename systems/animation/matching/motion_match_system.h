#pragma once

#include "ecs/commands.h"
#include "ecs/components/animation.h"
#include "ecs/components/foot_plant.h"
#include "ecs/components/motion_match.h"
#include "ecs/components/motor.h"
#include "ecs/components/motor_pose.h"
#include "ecs/components/move_intent.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/components/walk.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "ecs/system.h"
#include "systems/animation/matching/match_database.h"

namespace limn {

// Characters that are animated by motion matching (ecs/components/motion_match.h).
// Techniques: char.blend, char.motion-select

/// Adds MotionMatchState and MatchPose to every MotionMatch without them, and MatchHandover to
/// those that a MotorPose poses at times.
void add_match_states(
    Query<const MotionMatch, With<Skeleton>, Without<MotionMatchState>> states,
    Query<const MotionMatch, With<Skeleton>, Without<MatchPose>> poses,
    Query<const MotionMatch, const MotorPose, const Walk, Without<MatchHandover>> handovers,
    Query<const MotionMatchState, Without<MotionMatch>> left, Commands commands);

/// Makes databases that are used for the first time, with the takes of their walks. Warns of one
/// without a frame to search; its characters keep their other poses.
void prepare_match_databases(
    Query<const MotionMatch, const Skeleton> characters, Query<const Walk> walks,
    Res<const Assets> assets, Res<MatchDatabases> databases);

/// Steps all characters and finds their poses. Those with a MotorPose leave that to it while it
/// does more than walk. After what sets intents, before update_walks and update_poses.
void update_motion_matching(
    Query<
        const Skeleton, const MotionMatch, Optional<const MoveIntent>, Optional<const MotorState>,
        Optional<const FootContacts>, Optional<const MotorPoseState>, Optional<const MatchHandover>,
        Optional<WalkState>, MotionMatchState, MatchPose, Transform>
        characters,
    Res<const Assets> assets, Res<const MatchDatabases> databases,
    OptionalRes<const FrameTime> time);

}  // namespace limn
