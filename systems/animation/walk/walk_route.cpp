#include "systems/animation/walk/walk_route.h"

#include "systems/animation/walk/walk_plan.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace limn {
namespace {

constexpr float kArrival = 0.06f;  // from a point where it stops [m]
constexpr float kNear = 0.2f;      // where it does not turn back for a point that it has passed [m]
constexpr float kBraking = 0.4f;   // time constant of the way that is left [s]
constexpr float kClipArrival = 0.3f;  // from where clips come to rest without braking [m]

Vec3 way_to(const RoutePoint& point, const Vec3& position) {
    return (point.position - position) * Vec3(1, 0, 1);
}

/// The point that someone goes to now.
struct RouteLeg {
    const RoutePoint& point;
    Vec3 way;      ///< to it, along the ground [m]
    float far;     ///< its length [m]
    bool is_last;  ///< of a route that does not loop
    bool stops;    ///< waits there, or stays
};

/// The route must have points.
RouteLeg find_leg(const WalkRoute& route, const Vec3& position, WalkRouteState& state) {
    const auto count = static_cast<std::uint32_t>(route.points.size());
    state.next = std::min(state.next, count - 1);
    const RoutePoint& point = route.points[state.next];
    const Vec3 way = way_to(point, position);
    const bool is_last = !route.loop && state.next + 1 == count;
    return {point, way, glm::length(way), is_last, point.wait > 0 || is_last};
}

/// At the point of a leg since `step` seconds more: after its wait, the next one is due.
void wait_at(const WalkRoute& route, const RouteLeg& leg, float step, WalkRouteState& state) {
    state.waited += step;
    if (!leg.is_last && state.waited >= leg.point.wait) {
        state.waited = 0;
        state.next = (state.next + 1) % static_cast<std::uint32_t>(route.points.size());
    }
}

}  // namespace

Vec3 follow_route(
    const WalkRoute& route, const Walk& walk, const WalkState& feet, const Vec3& position,
    float step, WalkRouteState& state) {
    if (route.points.empty()) {
        return Vec3(0);
    }
    const RouteLeg leg = find_leg(route, position, state);
    const Vec3& way = leg.way;
    const float far = leg.far;
    Walk style = effective_walk(walk);
    style.speed = leg.point.speed > 0 ? leg.point.speed : style.speed;
    if (!leg.stops && far > route.reach && is_finite(way)) {
        return style.speed / far * way;
    }
    // Where it will come to rest, if it brakes from now on, moves with the velocity that is wanted:
    // nobody goes too far.
    const Vec3 rest = style.response * (feet.velocity + feet.pull) * Vec3(1, 0, 1);
    const float left = far > 0 ? far - glm::dot(rest, way) / far : 0.0f;
    const bool is_there =
        far <= kArrival || (far < kNear && (left <= 0 || feet.flying == WalkState::kNoFoot));
    if (leg.stops && !is_there && is_finite(way)) {
        return std::clamp(left / kBraking, 0.0f, style.speed) / far * way;
    }
    wait_at(route, leg, feet.flying == WalkState::kNoFoot ? step : 0.0f, state);
    return Vec3(0);
}

Vec3 follow_route_by_clips(
    const WalkRoute& route, const Vec3& position, float step, WalkRouteState& state) {
    if (route.points.empty()) {
        return Vec3(0);
    }
    const RouteLeg leg = find_leg(route, position, state);
    const Vec3& way = leg.way;
    const float far = leg.far;
    const Walk usual;
    const float speed = leg.point.speed > 0 ? leg.point.speed : effective_walk(usual).speed;
    // Slows down in time for where it stops: both time constants of the root.
    const float braking = far / std::max(2.2f * usual.response, 0.05f);
    if (far > (leg.stops ? kClipArrival : route.reach) && is_finite(way)) {
        return (leg.stops ? std::min(speed, braking) : speed) / far * way;
    }
    wait_at(route, leg, step, state);
    return Vec3(0);
}

bool has_arrived(
    const WalkRoute& route, const WalkState& feet, const Vec3& position,
    const WalkRouteState& state) {
    if (route.points.empty()) {
        return true;
    }
    return !route.loop && state.next + 1 == route.points.size() && feet.flying == WalkState::kNoFoot
           && glm::length(way_to(route.points.back(), position)) < kNear;
}

}  // namespace limn
