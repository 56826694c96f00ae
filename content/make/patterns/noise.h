#pragma once

#include "ecs/base/gradient_noise.h"
#include "ecs/base/math.h"

#include <cstdint>

namespace limn {

// Noise for images and terrain: a function of position and seed only, identical on every machine
// (no libm beyond sqrt and floor). `period` > 0 makes it tile after that many lattice cells; 0 =
// does not tile. After K. Perlin, "Improving Noise" (2002), S. Worley, "A Cellular Texture Basis
// Function" (1996) and, for the fractals, F. K. Musgrave in "Texturing and Modeling" (2003).

/// How octaves add up: octave i has frequency 2^i and amplitude gain^i; the sum is divided by the
/// sum of the amplitudes.
struct Octaves {
    int count = 5;      ///< >= 1
    float gain = 0.5f;  ///< 0 .. 1: 0.5 like hills, more is rougher
};

/// Fractal sum of gradient noise, about -1 .. 1.
[[nodiscard]] float fractal_noise(
    const Vec2& p, std::uint32_t seed, const Octaves& octaves, const IVec2& period = {0, 0});

/// Sharp ridges where the noise crosses 0, about 0 .. 1; each octave is weighted by the previous
/// ones, so that valleys stay smooth.
[[nodiscard]] float ridged_noise(
    const Vec2& p, std::uint32_t seed, const Octaves& octaves, const IVec2& period = {0, 0});

/// One jittered feature point per cell.
struct CellSample {
    float nearest;       ///< distance to the nearest feature point
    float second;        ///< distance to the second nearest
    float edge;          ///< distance to the border between the cells of the two
    std::uint32_t cell;  ///< random bits of the nearest point's cell
};

/// `jitter` 0 = a square grid .. 1 = anywhere in the cell.
[[nodiscard]] CellSample
cell_noise(const Vec2& p, std::uint32_t seed, float jitter = 1.0f, const IVec2& period = {0, 0});

}  // namespace limn
