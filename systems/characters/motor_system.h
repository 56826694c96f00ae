#pragma once

#include "ecs/commands.h"
#include "ecs/components/attach.h"
#include "ecs/components/motion_match.h"
#include "ecs/components/motor.h"
#include "ecs/components/move_intent.h"
#include "ecs/components/time.h"
#include "ecs/system.h"
#include "systems/characters/grounds.h"
#include "systems/water/water_query.h"

#include <optional>
#include <span>

namespace limn {

// Characters that go where their MoveIntent wants. The lower part of the capsule is left out, as
// high as a step; in its place a bundle of vertical rays holds the character above the ground, so
// that stairs and edges do not stop it. Walls push what is above that out.

/// One character in one step.
struct MotorBody {
    Transform transform{};
    MotorState state{};
    bool jumped = false;
};

/// How clips move one that stands, in place of its own acceleration and turn.
struct MotorDrive {
    Vec3 velocity = Vec3(0);  ///< horizontal, in the world [m/s]
    float turn = 0.0f;        ///< about +y [rad/s]
};

/// Moves it by a step of `dt` >= 0 [s], in parts of at most half a radius. Whatever the intent
/// holds, the result is finite; a motor that is not finite stays where it is.
[[nodiscard]] MotorBody step_motor(
    const CharacterMotor& motor, const MoveIntent& intent, const MotorBody& body,
    std::span<const PlacedGround> grounds, std::span<const WaterSurface> waters, float dt,
    const std::optional<MotorDrive>& drive = {});

/// `children`: are taken off their parents, where these have them now. `held`: became children
/// later, or by Attach; they do not move by themselves until they are roots again, and know nothing
/// but how fast they are carried.
void add_motor_states(
    Query<const CharacterMotor, Without<MotorState>> bare,
    Query<const CharacterMotor, Without<MoveIntent>> aimless,
    Query<const CharacterMotor, const Transform, With<Parent>, Without<MotorState>, Without<Attach>>
        children,
    Query<MotorState, With<CharacterMotor>, With<Parent>> held,
    Query<const MotorState, Without<CharacterMotor>> left, Query<const Transform> transforms,
    Query<const Parent> parents, OptionalRes<const FrameTime> time, Commands commands);

/// After everything that moves grounds.
void update_motors(
    Query<
        const CharacterMotor, Optional<const MotionMatchState>, MoveIntent, MotorState, Transform,
        Without<Parent>>
        motors,
    GroundQueries grounds, WaterQuery waters, Res<const FrameTime> time);

}  // namespace limn
