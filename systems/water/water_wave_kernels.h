#pragma once

#include "ecs/components/water_waves.h"

#include <span>

namespace limn {

// The inner loop of waves of closed form. It comes twice: with the widest vectors of the machine
// (Highway, chosen at run time) and as plain C++, `_scalar`, which also does the last few points.
// Both do the same operations in the same order, without fused multiply-add and without libm, so
// they give the same bits, on every machine.

/// Where points go [m].
struct WaveOffsets {
    std::span<float> x;
    std::span<float> height;
    std::span<float> z;
};

/// The offsets of the points (x, z), in the water's own space, by all lines; rings are not among
/// them. Off by 1e-6 of the sum of amplitudes within 1e4 waves of the origin. All spans have one
/// length.
void sum_waves(
    std::span<const WaveLine> lines, std::span<const float> x, std::span<const float> z,
    const WaveOffsets& offsets);
void sum_waves_scalar(
    std::span<const WaveLine> lines, std::span<const float> x, std::span<const float> z,
    const WaveOffsets& offsets);

}  // namespace limn
