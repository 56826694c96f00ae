#pragma once

#include "ecs/components/water_waves.h"

#include <span>

namespace limn {

// The inner loop of closed-form waves: a SIMD version for the machine's widest vectors (Highway,
// dispatched at run time) and a plain C++ one, `_scalar`, which also handles the remainder. Both
// perform the same operations in the same order, without fused multiply-add and libm, so results
// are bit-identical on every machine.

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
