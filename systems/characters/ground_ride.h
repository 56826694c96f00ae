#pragma once

#include "ecs/components/foot_plant.h"
#include "ecs/components/motion_match.h"
#include "ecs/components/motor.h"
#include "ecs/components/walk.h"

namespace limn {

// Ground that moves carries all that a character remembers of the world: prints, planted feet, what
// is left of transitions. So a foot stays where it stands on a boat that sails, turns and rolls.

/// Where a point that is fixed to the ground is after the ride.
[[nodiscard]] Vec3 carry_point(const GroundRide& ride, const Vec3& point);

/// Feet of motion matching and of walks are above a level floor at the character's origin, from
/// which FootContacts lift them to the ground. Null: they are on that floor.
void carry_match(const GroundRide& ride, const FootContacts* contacts, MotionMatchState& state);
void carry_walk(const GroundRide& ride, const FootContacts* contacts, WalkState& state);

}  // namespace limn
