#pragma once

#include "ecs/components/input.h"
#include "ecs/components/racer.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/system.h"

namespace limn {

class World;

// Racers live on the ribbon of their track: speed v and heading h off its direction make them go
//
//     distance' = v cos(h) / (1 + curvature lateral)        lateral' = v sin(h)
//     heading'  = steering + drift curvature distance' - straighten h
//
// so that a nose that is not steered drifts out of bends. Walls send it back along them and take
// speed. Drag grows with the square of the speed and ends acceleration at the top speed.

/// Moves every Racer on by a step and puts its Transform there. A player's is steered by Input
/// (forward and back, left and right, fast = boost) from the moment that there is some; all others
/// drive themselves: to their lane, around who is slower, no faster than their grip allows.
void update_racers(
    Query<Racer, Transform> racers, Res<const Assets> assets, Res<const Input> input,
    Res<const FrameTime> time);

/// Puts racers where they are, without moving them on: for the first picture.
void place_racers(Query<Racer, Transform> racers, Res<const Assets> assets);

/// Widens the cameras of who is fast, and opens their shutters.
void update_speed_views(World& world);

/// What a driver wants.
struct Driving {
    float throttle = 0;  ///< -1 (brakes) .. 1
    float steer = 0;     ///< -1 (left) .. 1 (right)
    bool boost = false;
};

/// One step of `dt` [s].
void step_racer(Racer& racer, const PathData& track, const Driving& driving, float dt);

}  // namespace limn
