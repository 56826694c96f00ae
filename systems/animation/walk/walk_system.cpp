#include "systems/animation/walk/walk_system.h"

#include "systems/animation/walk/walk_route.h"
#include "systems/characters/ground_ride.h"

#include <cstdint>
#include <optional>

namespace limn {

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
    walkers.par_each([step = time->step](
                         const WalkRoute& route, const Walk* walk, const WalkState* feet,
                         const Transform& transform, WalkRouteState& state, MoveIntent& intent) {
        const bool by_feet = walk != nullptr && feet != nullptr;
        intent.velocity = by_feet
                              ? follow_route(route, *walk, *feet, transform.position, step, state)
                              : follow_route_by_clips(route, transform.position, step, state);
    });
}

void update_walks(
    Query<
        const Walk, Optional<const MoveIntent>, Optional<const FootContacts>,
        Optional<const MotorState>, Optional<const MotorPoseState>,
        Optional<const MotionMatchState>, WalkState, WalkBody, Transform>
        walkers,
    OptionalRes<const FrameTime> time) {
    const float step = time ? time->step : 0.0f;
    walkers.par_each([step](
                         const Walk& walk, const MoveIntent* intent, const FootContacts* contacts,
                         const MotorState* motor, const MotorPoseState* motor_pose,
                         const MotionMatchState* match, WalkState& state, WalkBody& body,
                         Transform& transform) {
        if (motor != nullptr && match == nullptr) {  // else motion matching has done it
            carry_walk(motor->ride, contacts, state);
        }
        if (match != nullptr && motor_pose != nullptr && match->away == 0 && state.placed != 0) {
            return;
        }
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
