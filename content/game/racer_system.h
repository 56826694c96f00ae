#pragma once

#include "content/game/racer.h"
#include "ecs/commands.h"
#include "ecs/components/camera.h"
#include "ecs/components/input.h"
#include "ecs/components/motion_blur.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

// Racers move in the coordinates of their track. With speed v and heading h relative to the track,
//
//     distance' = v cos(h) / (1 + curvature lateral)        lateral' = v sin(h)
//     heading'  = steering + drift curvature distance' - straighten h
//
// so that a racer that is not steered drifts toward the outside of bends. Walls align it and reduce
// its speed. Drag grows with the square of the speed and balances acceleration at the top speed.

/// Gives each Racer its state.
void add_racer_states(Query<const Racer, Without<RacerState>> racers, Commands commands);

/// Advances every Racer by a step and writes its Transform. A player's racer is controlled by
/// the actions accelerate, brake, steer_left, steer_right and boost, once one of them is used. All
/// others use the autopilot, which keeps to their lane, overtakes slower racers and limits speed by
/// their grip.
void update_racers(
    Query<const Racer, RacerState, Transform> racers, Res<const Assets> assets,
    Res<const Input> input, Res<const FrameTime> time);

/// Writes the Transforms without advancing: for the first frame.
void place_racers(Query<const Racer, const RacerState, Transform> racers, Res<const Assets> assets);

/// Widens field of view and shutter of every SpeedView camera with its racer's speed.
void update_speed_views(
    Query<const SpeedView, Camera> views, Query<const Racer, const RacerState> racers,
    OptionalRes<MotionBlur> blur);

/// Control input of a racer.
struct Driving {
    float throttle = 0;  ///< -1 (brakes) .. 1
    float steer = 0;     ///< -1 (left) .. 1 (right)
    bool boost = false;
};

/// One step of `dt` [s].
void step_racer(
    const Racer& settings, const PathData& track, const Driving& driving, float dt,
    RacerState& racer);

}  // namespace limn
