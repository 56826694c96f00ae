#pragma once

#include "ecs/components/ocean.h"

#include <vector>

namespace limn {

// From a spectrum to the waves of a sea (water.fft-synthesis, steps 1 to 3). Each cascade holds the
// wave numbers 2 pi (n, m) / patch of its band, with heights
//
//     h0(k) = (xi_r + i xi_i) / sqrt(2) * sqrt(S(k) / 2 * dkx dkz),  xi of the normal distribution
//
// Bands do not overlap and leave no gap: the variances of the cascades add up to the spectrum's, as
// far as the largest patch and the finest grid reach. Each wave draws its own numbers, so that a
// finer grid only adds waves. At wave number 0, and at half the grid's frequency, where slopes
// would not be real, there are no waves.

/// All fields within their ranges; not-a-number becomes the least. The resolution is a power of
/// two.
[[nodiscard]] Ocean limit_ocean(const Ocean& ocean);

/// Where the bands of cascades with this resolution part: at so many waves across the smaller
/// patch.
[[nodiscard]] double waves_at_band_edge(int resolution);

/// Spectra drawn, fields flat. `ocean` is within its limits. Runs on all threads.
[[nodiscard]] std::vector<OceanCascade> make_ocean_cascades(const Ocean& ocean);

}  // namespace limn
