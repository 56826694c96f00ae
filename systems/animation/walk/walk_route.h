#pragma once

#include "ecs/base/math.h"
#include "ecs/components/walk.h"

namespace limn {

// How someone walks from point to point. Pure functions of plain values.

/// The velocity with which someone at `position` goes on along the route [m/s]: the walk's speed,
/// less where it comes to a point to stop at; 0 without points. Moves `state` on to the next point
/// after `step` seconds there.
[[nodiscard]] Vec3 follow_route(
    const WalkRoute& route, const Walk& walk, const WalkState& feet, const Vec3& position,
    float step, WalkRouteState& state);

/// The same for someone whom clips move, as of a MotionMatch, and whose feet nobody plans.
[[nodiscard]] Vec3 follow_route_by_clips(
    const WalkRoute& route, const Vec3& position, float step, WalkRouteState& state);

/// Whether it has come to rest at the last point of a route that does not loop.
[[nodiscard]] bool has_arrived(
    const WalkRoute& route, const WalkState& feet, const Vec3& position,
    const WalkRouteState& state);

}  // namespace limn
