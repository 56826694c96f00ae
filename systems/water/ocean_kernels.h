#pragma once

#include "ecs/components/ocean.h"
#include "systems/water/fft_kernels.h"

#include <span>

namespace limn {

// The inner loops of the ocean besides the transform. Like fft_kernels.h: for the machine's widest
// vectors and, `_scalar`, for one lane, with bit-identical results.

/// Two real fields a and b share one complex transform as a + i b. In each pair the spectrum of one
/// field is h times a real factor and that of the other h times an imaginary one, so that the
/// spectrum of the pair is h times a real number.
inline constexpr std::size_t kOceanPairs = 4;
enum class OceanPair : std::uint8_t {
    HeightAndShiftX,
    ShiftXXAndSlopeX,
    ShiftZZAndSlopeZ,
    ShiftXZAndShiftZ,
};

/// Spectra of the four pairs at `time` [s] for the columns first_column .. + kFftColumns. Pair p
/// starts at p * 2 * kFftColumns * size: rows of kFftColumns real parts, then the imaginary ones.
/// Error at most 2e-7 |h| for phases up to 1e8 radians.
void evolve_waves(
    const OceanCascade& cascade, float choppiness, double time, std::size_t first_column,
    std::span<float> pairs);
void evolve_waves_scalar(
    const OceanCascade& cascade, float choppiness, double time, std::size_t first_column,
    std::span<float> pairs);

/// Derivatives of the horizontal displacement, a value a point.
struct ShiftDerivatives {
    std::span<const float> xx;
    std::span<const float> zz;
    std::span<const float> xz;
};

/// Foam of the points begin .. end: d coverage / dt = growth (1 - coverage) - coverage / decay,
/// with growth = rate * max(threshold - J, 0), where J is the Jacobian determinant of the
/// horizontal displacement `shift`. `gain` is rate * dt, `fade` is e^(-dt / decay). Implicit in the
/// growth: coverage stays within 0 .. 1 for any dt.
void step_foam(
    const ShiftDerivatives& shift, float threshold, float gain, float fade,
    std::span<float> coverage, std::size_t begin, std::size_t end);
void step_foam_scalar(
    const ShiftDerivatives& shift, float threshold, float gain, float fade,
    std::span<float> coverage, std::size_t begin, std::size_t end);

}  // namespace limn
