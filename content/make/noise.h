#pragma once

#include "ecs/base/gradient_noise.h"
#include "ecs/base/math.h"

#include <cstdint>

namespace limn {

// Noise for making images and terrain: a function of place and seed alone, the same on every
// machine (no libm beyond sqrt and floor). `period` > 0 makes it repeat after so many lattice
// cells, so that an image tiles; 0 = never repeats. After K. Perlin, "Improving Noise" (2002), S.
// Worley, "A Cellular Texture Basis Function" (1996) and, for the fractals, F. K. Musgrave in
// "Texturing and Modeling" (2003).

/// How octaves add up: octave i has frequency 2^i and amplitude gain^i; the sum is divided by the
/// sum of the amplitudes.
struct Octaves {
    int count = 5;      ///< >= 1
    float gain = 0.5f;  ///< 0 .. 1: 0.5 like hills, more is rougher
};

/// Fractal sum of gradient noise, about -1 .. 1.
[[nodiscard]] float fractal_noise(
    const Vec2& p, std::uint32_t seed, const Octaves& octaves, const IVec2& period = {0, 0});

/// Sharp crests where the noise crosses 0, about 0 .. 1; an octave is as strong as the ones before
/// it are high, so that valleys stay smooth.
[[nodiscard]] float ridged_noise(
    const Vec2& p, std::uint32_t seed, const Octaves& octaves, const IVec2& period = {0, 0});

/// One jittered feature point a cell.
struct CellSample {
    float nearest;       ///< distance to the nearest feature point
    float second;        ///< distance to the second nearest
    float edge;          ///< distance to the border between the cells of the two
    std::uint32_t cell;  ///< random bits of the nearest point's cell
};

/// `jitter` 0 = a square grid .. 1 = as irregular as it gets.
[[nodiscard]] CellSample
cell_noise(const Vec2& p, std::uint32_t seed, float jitter = 1.0f, const IVec2& period = {0, 0});

}  // namespace limn
