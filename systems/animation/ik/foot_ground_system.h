#pragma once

#include "ecs/commands.h"
#include "ecs/components/animation.h"
#include "ecs/components/foot_plant.h"
#include "ecs/components/motor.h"
#include "ecs/components/time.h"
#include "ecs/query.h"
#include "ecs/system.h"
#include "systems/characters/grounds.h"

namespace limn {

// What the feet of characters stand on. A contact is a point in the space of its ground, which
// carries it: on a deck that heaves, feet go with it, and only where a foot passes over other
// ground does it follow with a delay.

void add_foot_contacts(
    Query<const FootPlant, With<Skeleton>, Without<FootContacts>> bare, Commands commands);

/// After everything that moves grounds and characters; before update_poses. Feet are looked for
/// where they were in the last step. Who jumps, falls or swims has nothing below the feet.
void update_foot_contacts(
    Query<const Skeleton, const FootPlant, const Pose, Optional<const MotorState>, FootContacts>
        characters,
    GroundQueries grounds, OptionalRes<const FrameTime> time);

}  // namespace limn
