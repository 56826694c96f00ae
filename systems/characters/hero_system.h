#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/camera.h"
#include "ecs/components/input.h"
#include "ecs/components/motor.h"
#include "ecs/components/move_intent.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "ecs/system.h"

namespace limn {

/// What the player wants, in the directions of the camera: actions hero_forward, hero_back,
/// hero_left, hero_right, hero_run, hero_jump (swims up), hero_dive, hero_carry (picks up the
/// nearest loose body ahead, or throws it).
void update_heroes(
    Query<Hero, const CharacterMotor, const MotorState, MoveIntent, const Transform> heroes,
    Query<const LooseBody, LooseState, const Transform, Without<CharacterMotor>> bodies,
    Query<const WorldTransform, With<Camera>> cameras, Res<const Input> input);

}  // namespace limn
