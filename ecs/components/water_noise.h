#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <vector>

namespace limn {

// Techniques: water.noise-surface

/// Animated gradient noise as a standalone surface: the one that lights the book's caustics pool
/// (water.noise-surface). Fills a HeightField.
struct NoiseSurface {
    Vec2 size = {10, 10};
    std::uint32_t points = 65;
    std::uint32_t octaves = 2;
    float frequency = 0.5f;
    float amplitude = 0.1f;
    float speed = 0.5f;
    std::uint32_t seed = 1;
};

LIMN_FIELDS(NoiseSurface) {
    LIMN_FIELD(size, "extent along local x and z", "m", 0, 1e5);
    LIMN_FIELD(points, "grid points per side", "", 2, 1024);
    LIMN_FIELD(octaves, "number of octaves", "", 0, 16);
    LIMN_FIELD(frequency, "frequency of the first octave", "1/m", 0, 1e4);
    LIMN_FIELD(amplitude, "amplitude of the first octave", "m", 0, 1000);
    LIMN_FIELD(speed, "rate of change over time", "1/s", 0, 1000);
    LIMN_FIELD(seed, "random seed");
}

}  // namespace limn
