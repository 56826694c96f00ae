#include "systems/animation/walk/walk_system.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace limn {
namespace {

constexpr float kArrival = 0.06f;     // from where it comes to rest without braking [m]
constexpr float kClipArrival = 0.3f;  // likewise, where clips move it [m]

}  // namespace

void add_walk_states(
    Query<const Walk, const Skeleton, Without<WalkState>> walks,
    Query<const Walk, const Skeleton, Without<WalkBody>> bodies,
    Query<const WalkRoute, Without<WalkRouteState>> routes, Res<const Assets> assets,
    Commands commands) {
    walks.each(
        [&](Entity entity, const Walk&, const Skeleton&) { commands.add(entity, WalkState{}); });
    bodies.each([&](Entity entity, const Walk&, const Skeleton& skeleton) {
        const std::uint32_t index = skeleton.skeleton.index;
        commands.add(
            entity, index < assets->skeletons.size() ? find_walk_body(assets->skeletons[index])
                                                     : WalkBody{});
    });
    routes.each([&](Entity entity, const WalkRoute&) { commands.add(entity, WalkRouteState{}); });
}

void update_walk_routes(
    Query<
        const WalkRoute, Optional<const Walk>, Optional<const WalkState>, const Transform,
        WalkRouteState, MoveIntent>
        walkers,
    Res<const FrameTime> time) {
    const Walk usual;
    walkers.par_each([&usual, step = time->step](
                         const WalkRoute& route, const Walk* walk, const WalkState* feet,
                         const Transform& transform, WalkRouteState& state, MoveIntent& intent) {
        const auto count = static_cast<std::uint32_t>(route.points.size());
        intent.velocity = Vec3(0);
        if (count == 0) {
            return;
        }
        state.next = std::min(state.next, count - 1);
        const RoutePoint& point = route.points[state.next];
        const Vec3 way = (point.position - transform.position) * Vec3(1, 0, 1);
        const float far = glm::length(way);
        const bool is_last = !route.loop && state.next + 1 == count;
        const bool stops = point.wait > 0 || is_last;
        const Walk& style = walk != nullptr ? *walk : usual;
        const float speed = point.speed > 0 ? point.speed : effective_walk(style).speed;
        // Slows down in time for where it stops: both time constants of the root.
        const float braking = far / std::max(2.2f * style.response, 0.05f);
        const float arrival = walk != nullptr ? kArrival : kClipArrival;
        if (far > (stops ? arrival : route.reach) && is_finite(way)) {
            intent.velocity = (stops ? std::min(speed, braking) : speed) / far * way;
            return;
        }
        const bool stands = feet == nullptr || feet->flying == WalkState::kNoFoot;
        state.waited += stands ? step : 0.0f;
        if (!is_last && state.waited >= point.wait) {
            state.waited = 0;
            state.next = (state.next + 1) % count;
        }
    });
}

void update_walks(
    Query<
        const Walk, Optional<const MoveIntent>, Optional<const FootContacts>,
        Optional<const MotorState>, Optional<const MotorPoseState>, WalkState, WalkBody, Transform>
        walkers,
    OptionalRes<const FrameTime> time) {
    const float step = time ? time->step : 0.0f;
    walkers.par_each([step](
                         const Walk& walk, const MoveIntent* intent, const FootContacts* contacts,
                         const MotorState* motor, const MotorPoseState* motor_pose,
                         WalkState& state, WalkBody& body, Transform& transform) {
        const bool is_off = motor != nullptr && motor_pose != nullptr && state.placed != 0
                            && (motor->mode != MotorMode::Stand || motor_pose->off_ground != 0);
        if (is_off) {
            return;
        }
        std::optional<float> lift;
        if (contacts != nullptr) {
            lift = uniform_scale(transform) * 0.5f * (contacts->lifts[0] + contacts->lifts[1]);
        }
        step_walk(
            walk, intent != nullptr ? *intent : MoveIntent{}, body, lift, step, state, transform);
        body.targets = find_walk_targets(body, state, transform);
    });
}

}  // namespace limn
