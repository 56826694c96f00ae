#pragma once

#include "ecs/base/math.h"
#include "ecs/components/path.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

namespace limn {

/// Hovers along a path, steered by somebody or by itself. Where it is counts in the path's own
/// measure: how far along, and how far to its right. +z is ahead.
struct Racer {
    PathId track{};
    double distance = 0.0;       ///< along the track [m]
    float lateral = 0.0f;        ///< to its right [m]
    float heading = 0.0f;        ///< off its direction, to the right [rad]
    float speed = 0.0f;          ///< [m/s], >= 0
    float lean = 0.0f;           ///< into the turn, to the right [rad]
    float half_width = 6.0f;     ///< of the track, where its walls are [m]
    float height = 0.6f;         ///< above it [m]
    float top_speed = 60.0f;     ///< [m/s]
    float boost_speed = 90.0f;   ///< [m/s]
    float acceleration = 20.0f;  ///< [m/s^2]
    float grip = 40.0f;          ///< sideways acceleration up to which it drives itself [m/s^2]
    float lane = 0.0f;           ///< where it likes to be when it drives itself [m to the right]
    float energy = 1.0f;         ///< left for boosts, 0 .. 1
    bool boosting = false;
    bool player = false;  ///< follows Input, from the moment that there is some
    bool taken = false;   ///< somebody has
};

/// On a Camera: sees wider and longer the faster `racer` is.
struct SpeedView {
    Entity racer{};
    float slow_fov = radians(50.0f);  ///< at rest [rad]
    float fast_fov = radians(72.0f);  ///< at the speed of a boost [rad]
    float slow_shutter = 120.0f;      ///< of the MotionBlur, if there is one [deg]
    float fast_shutter = 270.0f;      ///< [deg]
};

template <typename Visitor>
void visit_fields(Racer& racer, Visitor&& visit) {
    visit("track", racer.track, {.doc = "a path of the level, by name"});
    visit(
        "distance", racer.distance, {.doc = "along the track", .unit = "m", .min = 0, .max = 1e6});
    visit("lateral", racer.lateral, {.doc = "to its right", .unit = "m", .min = -1e3, .max = 1e3});
    visit(
        "heading", racer.heading,
        {.doc = "off its direction, to the right", .unit = "rad", .min = -3.2, .max = 3.2});
    visit("speed", racer.speed, {.doc = "along its nose", .unit = "m/s", .min = 0, .max = 1000});
    visit("lean", racer.lean, {.doc = "into the turn", .unit = "rad", .min = -3.2, .max = 3.2});
    visit(
        "half_width", racer.half_width,
        {.doc = "of the track, where its walls are", .unit = "m", .min = 0, .max = 1000});
    visit("height", racer.height, {.doc = "above the track", .unit = "m", .min = -10, .max = 100});
    visit(
        "top_speed", racer.top_speed,
        {.doc = "without a boost", .unit = "m/s", .min = 0, .max = 1000});
    visit(
        "boost_speed", racer.boost_speed,
        {.doc = "with one", .unit = "m/s", .min = 0, .max = 1000});
    visit(
        "acceleration", racer.acceleration,
        {.doc = "at rest", .unit = "m/s^2", .min = 0.01, .max = 1000});
    visit(
        "grip", racer.grip,
        {.doc = "sideways acceleration when it drives itself",
         .unit = "m/s^2",
         .min = 0.01,
         .max = 1000});
    visit("lane", racer.lane, {.doc = "where it likes to be, to the right", .unit = "m"});
    visit("energy", racer.energy, {.doc = "left for boosts", .min = 0, .max = 1});
    visit("boosting", racer.boosting, {.doc = "right now"});
    visit("player", racer.player, {.doc = "follows the input, once there is some"});
    visit("taken", racer.taken, {.doc = "somebody steers it"});
}

template <typename Visitor>
void visit_fields(SpeedView& view, Visitor&& visit) {
    visit("racer", view.racer, {.doc = "whose speed counts"});
    visit("slow_fov", view.slow_fov, {.doc = "at rest", .unit = "rad", .min = 0.01, .max = 3.1});
    visit(
        "fast_fov", view.fast_fov,
        {.doc = "at the speed of a boost", .unit = "rad", .min = 0.01, .max = 3.1});
    visit(
        "slow_shutter", view.slow_shutter,
        {.doc = "of the motion blur at rest", .unit = "deg", .min = 0, .max = 360});
    visit(
        "fast_shutter", view.fast_shutter,
        {.doc = "at the speed of a boost", .unit = "deg", .min = 0, .max = 360});
}

}  // namespace limn
