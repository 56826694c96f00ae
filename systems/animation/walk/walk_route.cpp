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

}  // namespace

Vec3 follow_route(
    const WalkRoute& route, const Walk& walk, const WalkState& feet, const Vec3& position,
    float step, WalkRouteState& state) {
    const auto count = static_cast<std::uint32_t>(route.points.size());
    if (count == 0) {
        return Vec3(0);
    }
    state.next = std::min(state.next, count - 1);
    const RoutePoint& point = route.points[state.next];
    const Vec3 way = way_to(point, position);
    const float far = glm::length(way);
    const bool is_last = !route.loop && state.next + 1 == count;
    const bool stops = point.wait > 0 || is_last;
    Walk style = effective_walk(walk);
    style.speed = point.speed > 0 ? point.speed : style.speed;
    if (!stops && far > route.reach && is_finite(way)) {
        return style.speed / far * way;
    }
    // Where it will come to rest, if it brakes from now on, moves with the velocity that is wanted:
    // nobody goes too far.
    const Vec3 rest = style.response * (feet.velocity + feet.pull) * Vec3(1, 0, 1);
    const float left = far > 0 ? far - glm::dot(rest, way) / far : 0.0f;
    const bool is_there =
        far <= kArrival || (far < kNear && (left <= 0 || feet.flying == WalkState::kNoFoot));
    if (stops && !is_there && is_finite(way)) {
        return std::clamp(left / kBraking, 0.0f, style.speed) / far * way;
    }
    state.waited += feet.flying == WalkState::kNoFoot ? step : 0.0f;
    if (!is_last && state.waited >= point.wait) {
        state.waited = 0;
        state.next = (state.next + 1) % count;
    }
    return Vec3(0);
}

Vec3 follow_route_by_clips(
    const WalkRoute& route, const Vec3& position, float step, WalkRouteState& state) {
    const auto count = static_cast<std::uint32_t>(route.points.size());
    if (count == 0) {
        return Vec3(0);
    }
    state.next = std::min(state.next, count - 1);
    const RoutePoint& point = route.points[state.next];
    const Vec3 way = way_to(point, position);
    const float far = glm::length(way);
    const bool is_last = !route.loop && state.next + 1 == count;
    const bool stops = point.wait > 0 || is_last;
    const Walk usual;
    const float speed = point.speed > 0 ? point.speed : effective_walk(usual).speed;
    // Slows down in time for where it stops: both time constants of the root.
    const float braking = far / std::max(2.2f * usual.response, 0.05f);
    if (far > (stops ? kClipArrival : route.reach) && is_finite(way)) {
        return (stops ? std::min(speed, braking) : speed) / far * way;
    }
    state.waited += step;
    if (!is_last && state.waited >= point.wait) {
        state.waited = 0;
        state.next = (state.next + 1) % count;
    }
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
