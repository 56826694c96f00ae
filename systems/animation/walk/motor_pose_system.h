#pragma once

#include "ecs/commands.h"
#include "ecs/components/motor.h"
#include "ecs/components/motor_pose.h"
#include "ecs/components/move_intent.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/components/walk.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "ecs/system.h"
#include "systems/animation/walk/walk_body.h"

namespace limn {

void add_motor_poses(
    Query<const MotorPose, const Transform, Without<MotorPoseState>> bare, Commands commands);

/// After update_walks, whose feet it moves while they are off the ground. A body is pushed where
/// the character walks against it and it is at least as high as the hips.
void update_motor_poses(
    Query<
        const MotorPose, const CharacterMotor, const MotorState, Optional<const MoveIntent>,
        const Transform, MotorPoseState, WalkState, WalkBody>
        characters,
    Query<const LooseBody, const LooseState, const Transform> bodies,
    OptionalRes<const FrameTime> time);

}  // namespace limn
