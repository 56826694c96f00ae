#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <vector>

namespace limn {

/// Gradient noise that moves, as a surface by itself: what the book's pool of caustics is lit
/// through (water.noise-surface).
struct NoiseSurface {
    Vec2 size = {10, 10};       ///< about the entity, along x and z [m]
    std::uint32_t points = 65;  ///< along a side
    std::uint32_t octaves = 2;
    float frequency = 0.5f;  ///< of the first [1/m]; each further one twice as fine
    float amplitude = 0.1f;  ///< of the first [m]; each further one half as high
    float speed = 0.5f;      ///< of its change [1/s]
    std::uint32_t seed = 1;
};

/// Beside a NoiseSurface: it at this moment. Point (i, j) is at j * points + i.
struct NoiseField {
    std::uint32_t points = 0;     ///< along a side
    std::vector<float> height{};  ///< [m]
    std::vector<Vec3> normal{};   ///< unit, up
    float low = 0;                ///< least height [m]
    float range = 0;              ///< from the least to the greatest [m]
};

/// Follows from NoiseSurface and the time.
template <>
struct ComponentTraits<NoiseField> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
    static constexpr bool in_prefabs = false;
};

template <typename Visitor>
void visit_fields(NoiseSurface& noise, Visitor&& visit) {
    visit("size", noise.size, {.doc = "along its x and z", .unit = "m", .min = 0, .max = 1e5});
    visit("points", noise.points, {.doc = "along a side", .min = 2, .max = 1024});
    visit("octaves", noise.octaves, {.doc = "how many", .min = 0, .max = 16});
    visit(
        "frequency", noise.frequency, {.doc = "of the first", .unit = "1/m", .min = 0, .max = 1e4});
    visit(
        "amplitude", noise.amplitude, {.doc = "of the first", .unit = "m", .min = 0, .max = 1000});
    visit("speed", noise.speed, {.doc = "of its change", .unit = "1/s", .min = 0, .max = 1000});
    visit("seed", noise.seed, {.doc = "another surface alike"});
}

}  // namespace limn
