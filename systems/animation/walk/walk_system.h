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
#include "systems/animation/walk/walk_step.h"

namespace limn {

/// Adds WalkState, WalkBody and WalkRouteState to characters that need them.
void add_walk_states(
    Query<const Walk, const Skeleton, Without<WalkState>> walks,
    Query<const Walk, const Skeleton, Without<WalkBody>> bodies,
    Query<const WalkRoute, Without<WalkRouteState>> routes, Res<const Assets> assets,
    Commands commands);

/// Sets the intents of those who follow routes. Before update_walks.
void update_walk_routes(
    Query<
        const WalkRoute, Optional<const Walk>, Optional<const WalkState>, const Transform,
        WalkRouteState, MoveIntent>
        walkers,
    Res<const FrameTime> time);

/// After everything else that moves characters; before update_foot_contacts and update_poses. Those
/// with a MotorPose do not step while they fall or swim, nor while motion matching poses them.
void update_walks(
    Query<
        const Walk, Optional<const MoveIntent>, Optional<const FootContacts>,
        Optional<const MotorState>, Optional<const MotorPoseState>,
        Optional<const MotionMatchState>, WalkState, WalkBody, Transform>
        walkers,
    OptionalRes<const FrameTime> time);

}  // namespace limn
