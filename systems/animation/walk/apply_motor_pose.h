#pragma once

#include "ecs/components/motor.h"
#include "ecs/components/motor_pose.h"
#include "ecs/components/skeleton.h"
#include "ecs/components/transform.h"
#include "ecs/components/walk.h"
#include "systems/animation/walk/walk_body.h"

#include <optional>

namespace limn {

// Jumps, falls, landings, swimming, wading, pushing, carrying and throwing, on top of a walk. Feet
// off the ground follow places that move with the body like critically damped springs: they stay
// behind at the take-off, and where they touch down they stay. Landings give the hips the speed of
// the fall, which the knees stop.
// Techniques: char.motion-select

/// What happens around a character in a step, in its own space.
struct MotorPoseInput {
    MotorState motor{};
    Vec3 velocity = {0, 0, 0};      ///< of the root, measured [m/s]
    float height = 1.75f;           ///< of the motor [m]
    std::optional<Vec3> carried{};  ///< center of what it carries [m]
    std::optional<Vec3> pushed{};   ///< nearest point of what it pushes, at chest height [m]
    float width = 0.2f;             ///< radius of what it carries or pushes [m]
};

/// Critically damped, implicit: stable for any step [s].
void ease(float target, float rate, float step, EasedValue& eased);

/// Advances weights, springs and feet by `step` [s].
void step_motor_pose(
    const MotorPose& style, const MotorPoseInput& input, const WalkBody& body,
    const Transform& transform, float step, MotorPoseState& state, WalkState& walk);

/// Adds what it does to the targets of the walk.
void add_motor_targets(const MotorPose& style, const MotorPoseState& state, WalkBody& body);

/// Arms and head, after apply_walk.
void apply_motor_pose(
    const SkeletonData& skeleton, const MotorPose& style, const MotorPoseState& state,
    const WalkBody& body, LocalPose& pose);

}  // namespace limn
