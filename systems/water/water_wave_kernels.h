#pragma once

#include "ecs/base/math.h"
#include "ecs/components/water_waves.h"

#include <span>

namespace limn {

// The inner loops of closed-form waves: a SIMD version for the machine's widest vectors (Highway,
// dispatched at run time) and a plain C++ one, `_scalar`, which also handles the remainder. Both
// perform the same operations in the same order, without fused multiply-add and libm, so results
// are bit-identical on every machine.

/// Displacement of a rest point by waves, with derivatives.
struct WavePoint {
    Vec3 offset = {0, 0, 0};    ///< [m]
    Vec3 by_x = {0, 0, 0};      ///< derivative of the offset, d / dx
    Vec3 by_z = {0, 0, 0};      ///< d / dz
    Vec3 velocity = {0, 0, 0};  ///< d / dt [m/s]

    WavePoint& operator+=(const WavePoint& other);
};

/// Of one point (x, z), by all lines: four at a time, on any machine, so that the order of the sum
/// is the same.
[[nodiscard]] WavePoint sum_lines(std::span<const WaveLine> lines, const Vec2& at);
[[nodiscard]] WavePoint sum_lines_scalar(std::span<const WaveLine> lines, const Vec2& at);

/// Displacements of points [m].
struct WaveOffsets {
    std::span<float> x;
    std::span<float> height;
    std::span<float> z;
};

/// Displacements of the points (x, z), in the water's local space, by all lines, without rings.
/// Error 1e-6 of the sum of amplitudes within 1e4 wavelengths of the origin. All spans have the
/// same length.
void sum_waves(
    std::span<const WaveLine> lines, std::span<const float> x, std::span<const float> z,
    const WaveOffsets& offsets);
void sum_waves_scalar(
    std::span<const WaveLine> lines, std::span<const float> x, std::span<const float> z,
    const WaveOffsets& offsets);

}  // namespace limn
