#pragma once

#include "ecs/base/math.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

namespace limn {

/// Rules of a flock, of birds, fish or a herd, whose members are Boids; the entity's position is
/// their home. In this order of precedence: they keep off each other and off CrowdObstacles, take
/// on the velocity of their neighbors, stay close to them, and wander. Each adds to the
/// acceleration until max_acceleration is spent.
struct FlockParams {
    float radius = 3.0f;
    float separation = 1.2f;
    float view = kPi;
    float avoid = 4.0f;
    float match = 1.5f;
    float center = 0.6f;
    float wander = 0.5f;
    float wander_time = 2.0f;
    float max_acceleration = 5.0f;
    float min_speed = 1.0f;
    float max_speed = 3.0f;
    float home_radius = 15.0f;
    bool planar = false;
    float stride = 0.0f;
};

LIMN_FIELDS(FlockParams) {
    LIMN_FIELD(radius, "within which others are neighbors", "m", 0.01, 1000);
    LIMN_FIELD(separation, "within which they and obstacles are avoided", "m", 0, 1000);
    LIMN_FIELD(
        view, "angle to the heading up to which others are seen; pi: all around", "rad", 0, 3.1416);
    LIMN_FIELD(avoid, "1. acceleration away from a neighbor at 1 m", "m/s2", 0, 1000);
    LIMN_FIELD(match, "2. toward the neighbors' mean velocity, per difference", "1/s", 0, 1000);
    LIMN_FIELD(center, "3. toward the neighbors' center, per distance", "1/s2", 0, 1000);
    LIMN_FIELD(wander, "4. in a direction that wanders", "m/s2", 0, 1000);
    LIMN_FIELD(wander_time, "in which that direction turns by about a radian", "s", 0.01, 1000);
    LIMN_FIELD(max_acceleration, "sum of all four", "m/s2", 0, 1000);
    LIMN_FIELD(min_speed, "lowest speed", "m/s", 0, 1000);
    LIMN_FIELD(max_speed, "highest speed", "m/s", 0, 1000);
    LIMN_FIELD(home_radius, "beyond this distance from home they wander toward it", "m", 0, 1e6);
    LIMN_FIELD(planar, "they stay at their height and upright, as herds do");
    LIMN_FIELD(
        stride,
        "distance in one loop of a member's clip_player, whose time then follows the "
        "distance that it moves; 0: by time",
        "m", 0, 100);
}

/// A member of a flock, without a Parent: it moves its Transform, +z ahead.
struct Boid {
    Entity flock{};
    Vec3 velocity = {0, 0, 0};
    Vec3 wander = {0, 0, 0};
};

LIMN_FIELDS(Boid) {
    LIMN_FIELD(flock, "entity with the flock_params; none: it does not move");
    LIMN_FIELD(velocity, "current velocity; 0: starts ahead, at the lowest speed", "m/s");
    LIMN_FIELD(wander, "direction in which it wanders; 0: starts ahead");
}

}  // namespace limn
