#pragma once

#include "ecs/commands.h"
#include "ecs/components/crowd.h"
#include "ecs/components/crowd_script.h"
#include "ecs/components/motor.h"
#include "ecs/components/move_intent.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "ecs/system.h"

namespace limn {

// Where walkers go, and whom they avoid besides each other. Places that are full are reached as
// well: who cannot get farther has arrived within twice the radius.
// Techniques: char.crowd-script

/// Adds a state to every CrowdVisitor without one.
void add_crowd_visits(Query<const CrowdVisitor, Without<CrowdVisit>> bare, Commands commands);

/// Sends those that have stayed long enough to another place, by its appeal, and turns those that
/// stay to theirs. Without places they stand. Before update_crowd.
void update_crowd_visits(
    Query<const CrowdVisitor, CrowdVisit, const CrowdState, CrowdGoal, MoveIntent, const Transform>
        visitors,
    Query<const CrowdPlace, const CrowdExit> places, Query<const Transform> transforms,
    Query<const Parent> parents, Res<const RandomSeed> seed, Res<const FrameTime> time);

/// Puts stand-ins where their characters are, with the velocities that those have. Before
/// update_crowd. One whose character is gone stays where it is.
void place_stand_ins(
    Query<const CrowdStandIn, CrowdState, MoveIntent, Transform, Without<CharacterMotor>> stand_ins,
    Query<const Transform, const MotorState> characters);

}  // namespace limn
