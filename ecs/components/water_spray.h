#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <vector>

namespace limn {

// Where water sprays: drops to be, as data. The systems say each step where new ones begin and how
// fast; who draws and moves them takes them from here.

/// Beside a Water with WaterWaves: drops fly from crests that are about to break.
struct SpraySource {
    float steepness = 0.1f;  ///< height over length beyond which a wave breaks; 1/pi: the cusps
    float rate = 300.0f;     ///< drops of each wave that breaks [1/s]
    float spread = 0.2f;     ///< of their speed, standard deviation over the mean
    float angle = 0.3f;      ///< of their directions, to all sides [rad]
    Vec2 window = {60, 60};  ///< of water without end: about its entity [m]
};

/// An entity that waves run against: a point of a wall.
struct SprayObstacle {
    Vec3 normal = {0, 0, 1};    ///< of the wall in its own space
    float rate = 400.0f;        ///< drops while a crest is at it [1/s]
    float spread = 0.2f;        ///< of their speed
    float angle = 0.43633231f;  ///< half angle of their cone [rad]; 25 degrees
};

/// A drop that begins now.
struct SprayDrop {
    Vec3 position = {0, 0, 0};  ///< in the world [m]
    Vec3 velocity = {0, 0, 0};  ///< [m/s]
};

/// Beside a SpraySource or a SprayObstacle, made anew each step.
struct SprayDrops {
    std::vector<SprayDrop> drops{};
};

/// Follows from the waves and the number of the step.
template <>
struct ComponentTraits<SprayDrops> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
    static constexpr bool in_prefabs = false;
};

template <typename Visitor>
void visit_fields(SpraySource& source, Visitor&& visit) {
    visit(
        "steepness", source.steepness,
        {.doc = "height over length beyond which a wave breaks", .min = 0, .max = 1});
    visit(
        "rate", source.rate,
        {.doc = "drops of a wave that breaks", .unit = "1/s", .min = 0, .max = 1e6});
    visit("spread", source.spread, {.doc = "of their speed", .min = 0, .max = 1});
    visit(
        "angle", source.angle, {.doc = "of their directions", .unit = "rad", .min = 0, .max = 1.5});
    visit(
        "window", source.window,
        {.doc = "part of water without end", .unit = "m", .min = 0, .max = 1e5});
}

template <typename Visitor>
void visit_fields(SprayObstacle& obstacle, Visitor&& visit) {
    visit("normal", obstacle.normal, {.doc = "of the wall in its own space"});
    visit(
        "rate", obstacle.rate,
        {.doc = "drops while a crest is at it", .unit = "1/s", .min = 0, .max = 1e6});
    visit("spread", obstacle.spread, {.doc = "of their speed", .min = 0, .max = 1});
    visit(
        "angle", obstacle.angle,
        {.doc = "half angle of their cone", .unit = "rad", .min = 0, .max = 1.5});
}

}  // namespace limn
