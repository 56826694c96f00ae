#pragma once

#include "ecs/components/input.h"
#include "ecs/components/sailing.h"

namespace limn {

class World;

/// Steers and sails every Sailboat for a step: what the wind of the level's Weather, its keel and
/// its rudder do to it is added to its Floating, which update_floating_bodies then moves. A
/// player's boat obeys Input: right and left are the rudder, forward hauls the sheet in, back lets
/// it out, fast lets it trim itself again. After what moves the water, before
/// update_floating_bodies.
void update_sailboats(World& world);

/// Turns every Boom as its Sailboat has it, and takes lookouts along. After update_floating_bodies.
void turn_booms(World& world);

/// One step of somebody at the helm.
void steer_sailboat(const Input& input, float step, Sailboat& boat);

}  // namespace limn
