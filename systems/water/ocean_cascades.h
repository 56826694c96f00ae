#pragma once

#include "ecs/components/ocean.h"

#include <vector>

namespace limn {

// Random wave amplitudes from a spectrum (water.fft-synthesis, steps 1 to 3). Each cascade has the
// wave numbers 2 pi (n, m) / patch within its band, with amplitudes
//
//     h0(k) = (xi_r + i xi_i) / sqrt(2) * sqrt(S(k) / 2 * dkx dkz),  xi normally distributed
//
// Bands neither overlap nor leave gaps: the variances of the cascades add up to the spectrum's,
// within the range between the largest patch and the finest grid. Random numbers are keyed by wave,
// so that a finer grid only adds waves. There are no waves at wave number 0 and at the Nyquist
// frequency, where slopes would not be real.

/// Clamps all fields to their ranges; NaN becomes the minimum. The resolution becomes a power of
/// two.
[[nodiscard]] Ocean clamp_ocean(const Ocean& ocean);

/// Boundary between the bands of two cascades with this resolution, as a number of waves across the
/// smaller patch.
[[nodiscard]] double waves_at_band_edge(int resolution);

/// Cascades with random spectra and flat fields. `ocean` must be within its limits. Runs on all
/// threads.
[[nodiscard]] std::vector<OceanCascade> make_ocean_cascades(const Ocean& ocean);

}  // namespace limn
