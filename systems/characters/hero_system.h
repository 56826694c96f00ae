#pragma once

#include "ecs/commands.h"
#include "ecs/components/animation.h"
#include "ecs/components/camera.h"
#include "ecs/components/input.h"
#include "ecs/components/motor.h"
#include "ecs/components/move_intent.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "ecs/system.h"

namespace limn {

void add_hero_states(Query<const Hero, Without<HeroState>> bare, Commands commands);

/// What the player wants, in the directions of the camera: actions hero_forward, hero_back,
/// hero_left, hero_right, hero_run, hero_jump (swims up), hero_dive, hero_carry (picks up the
/// nearest loose body, to which it turns first, or turns to where the camera looks and throws it
/// there).
void update_heroes(
    Query<Hero, HeroState, const CharacterMotor, const MotorState, MoveIntent, const Transform>
        heroes,
    Query<const LooseBody, LooseState, const Transform, Without<CharacterMotor>> bodies,
    Query<const WorldTransform, With<Camera>> cameras, Res<const Input> input,
    Res<const FrameTime> time);

/// Puts heroes that have fallen off the ground back where they stood about a second before.
void return_lost_heroes(
    Query<const Hero, HeroState, MotorState, Transform, Without<Parent>> heroes,
    Res<const FrameTime> time, Commands commands);

}  // namespace limn
