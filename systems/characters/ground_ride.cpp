#include "systems/characters/ground_ride.h"

#include "ecs/base/rotation.h"

#include <cmath>
#include <cstddef>

namespace limn {
namespace {

bool is_still(const GroundRide& ride) {
    return ride.from == ride.to && ride.turn == Quat(1, 0, 0, 0);
}

/// A point of a foot, which `lift` [m] raises to the ground.
Vec3 carry_foot(const GroundRide& ride, const FootContacts* contacts, std::size_t i, Vec3 point) {
    if (contacts == nullptr) {
        return carry_point(ride, point);
    }
    // Only along the level floor: lifts change with the ground.
    const Vec3 lift = {0, contacts->lifts[i], 0};
    const Vec3 carried = carry_point(ride, point + lift);
    return {carried.x, point.y + ride.to.y - ride.from.y, carried.z};
}

}  // namespace

Vec3 carry_point(const GroundRide& ride, const Vec3& point) {
    return ride.to + ride.turn * (point - ride.from);
}

void carry_match(const GroundRide& ride, const FootContacts* contacts, MotionMatchState& state) {
    if (is_still(ride)) {
        return;
    }
    const Quat turn = rotation_about({0, 1, 0}, ride.yaw);
    const auto carry_offset = [&](InertialOffset& offset) {
        offset.offset = turn * offset.offset;
        offset.rate = turn * offset.rate;
    };
    for (std::size_t i = 0; i < state.feet.size(); ++i) {
        MatchFoot& foot = state.feet[i];
        foot.place = carry_foot(ride, contacts, i, foot.place);
        foot.aim = carry_foot(ride, contacts, i, foot.aim);
        foot.rotation = normalize_or_identity(turn * foot.rotation);
        foot.velocity = turn * foot.velocity;
        foot.spin = turn * foot.spin;
        foot.anchor_yaw += ride.yaw;
        carry_offset(foot.shift);
        carry_offset(foot.turn);
    }
    state.root = carry_point(ride, state.root);
}

void carry_walk(const GroundRide& ride, const FootContacts* contacts, WalkState& state) {
    if (is_still(ride)) {
        return;
    }
    const Quat turn = rotation_about({0, 1, 0}, ride.yaw);
    for (std::size_t i = 0; i < state.feet.size(); ++i) {
        WalkFoot& foot = state.feet[i];
        for (Vec3* const point : {&foot.from, &foot.to, &foot.place}) {
            *point = carry_foot(ride, contacts, i, *point);
        }
        for (float* const heading : {&foot.from_heading, &foot.to_heading, &foot.heading}) {
            *heading += ride.yaw;
        }
        foot.aim_speed = turn * foot.aim_speed;
    }
    state.root = carry_point(ride, state.root);
    state.heading = std::remainder(state.heading + ride.yaw, 2 * kPi);
    state.velocity = turn * state.velocity;
    state.pull = turn * state.pull;
}

}  // namespace limn
