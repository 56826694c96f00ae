#pragma once

#include "ecs/components/ocean.h"
#include "systems/water/fft_kernels.h"

#include <span>

namespace limn {

// The inner loops of the ocean beside the transform. As fft_kernels.h: with the widest vectors of
// the machine and, `_scalar`, with one lane; the same bits.

/// Two real fields a and b go through one complex transform as a + i b. In each pair one has a
/// spectrum of h times something real and the other of h times something imaginary, so that the
/// spectrum of the pair is h times a real number.
inline constexpr std::size_t kOceanPairs = 4;
enum class OceanPair : std::uint8_t {
    HeightAndShiftX,
    ShiftXXAndSlopeX,
    ShiftZZAndSlopeZ,
    ShiftXZAndShiftZ,
};

/// The spectra of the four pairs at `time` [s], of the columns first_column .. + kFftColumns. Pair
/// p begins at p * 2 * kFftColumns * size: rows of kFftColumns real parts, then the imaginary
/// ones. Off by at most 2e-7 of |h| for 1e8 radians of phase.
void evolve_waves(
    const OceanCascade& cascade, float choppiness, double time, std::size_t first_column,
    std::span<float> pairs);
void evolve_waves_scalar(
    const OceanCascade& cascade, float choppiness, double time, std::size_t first_column,
    std::span<float> pairs);

/// Foam of the points begin .. end: d coverage / dt = growth (1 - coverage) - coverage / decay,
/// growth = rate * max(threshold - J, 0), where J is the share of its area that is left of the
/// water: the determinant of d shifted / d rest. `gain` is rate * dt, `fade` e^(-dt / decay).
/// Implicit in the growth: coverage stays within 0 .. 1 for any dt.
void step_foam(
    const OceanCascade& cascade, float threshold, float gain, float fade, std::span<float> coverage,
    std::size_t begin, std::size_t end);
void step_foam_scalar(
    const OceanCascade& cascade, float threshold, float gain, float fade, std::span<float> coverage,
    std::size_t begin, std::size_t end);

}  // namespace limn
