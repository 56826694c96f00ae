#pragma once

#include "content/game/sailing.h"
#include "ecs/commands.h"
#include "ecs/components/buoyancy.h"
#include "ecs/components/camera.h"
#include "ecs/components/input.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/components/weather.h"
#include "ecs/hierarchy.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "systems/water/water_query.h"

namespace limn {

/// Gives each Sailboat its state.
void add_sailboat_states(Query<const Sailboat, Without<SailboatState>> boats, Commands commands);

/// Steers every Sailboat for a step and applies the forces of sail (in the wind of Weather), keel
/// and rudder to its Floating, which update_floating_bodies then moves. A player's boat is
/// controlled by the actions rudder_port, rudder_starboard, sheet_in, sheet_out and auto_trim.
/// After everything that moves water, before update_floating_bodies.
void update_sailboats(
    Query<
        const Sailboat, SailboatState, const WaterTouch, const Floating, FloatingState,
        const Transform, Without<Parent>>
        boats,
    WaterQuery waters, Query<const Camera> cameras, OptionalRes<const Weather> weather,
    Res<const WeatherState> weather_state, Res<const Assets> assets, Res<const Input> input,
    Res<const FrameTime> time);

/// Rotates every Boom to its Sailboat's boom angle, and moves lookouts. After
/// update_floating_bodies.
void turn_booms(
    Query<Boom, Transform, const Parent> booms,
    Query<const Sailboat, const SailboatState, const Transform> boats,
    Query<const Floating, const FloatingState> bodies, Query<Transform> transforms,
    OptionalRes<const Weather> weather, Res<const WeatherState> weather_state,
    Res<const FrameTime> time);

/// Control input of a boat.
struct Helm {
    float rudder = 0;  ///< -1 .. 1, > 0 to starboard
    float sheet = 0;   ///< -1 hauls in, 1 lets out
    bool auto_trim = false;
};

/// One step of manual steering.
void steer_sailboat(const Helm& helm, float step, SailboatState& boat);

}  // namespace limn
