#include "systems/water/ocean_cascades.h"

#include "ecs/base/check.h"
#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "systems/water/fft_kernels.h"
#include "systems/water/ocean_spectrum.h"
#include "systems/water/water_dispersion.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>

// Techniques: water.fft-synthesis

namespace limn {

namespace {

constexpr double kFullTurn = 6.283185307179586;  ///< 2 pi

float limit(float value, float low, float high) {
    return value > low ? std::min(value, high) : low;
}

/// Number of waves across the patch at an index of the spectrum: 0 .. size / 2 - 1, then -size / 2
/// .. -1.
int waves_across(int index, int size) {
    return index < size / 2 ? index : index - size;
}

int wave_index(int waves, int size) {
    return (waves + size) % size;
}

/// Pair of normally distributed numbers keyed by wave and cascade.
std::complex<double> draw(const Ocean& ocean, std::size_t cascade, int n, int m) {
    const std::uint64_t wave = std::uint64_t{static_cast<std::uint32_t>(n)} << 32
                               | std::uint64_t{static_cast<std::uint32_t>(m)};
    Random random(ocean.seed, wave, name_hash("ocean"), cascade);
    const double re = random.normal();
    const double im = random.normal();
    return {re, im};
}

double looped(double omega, float period) {
    if (!(period > 0)) {
        return omega;
    }
    const double least = kFullTurn / period;
    return least * std::round(omega / least);
}

void draw_spectrum(
    const Ocean& ocean, const OceanEnergy& sea, std::size_t index, OceanCascade& cascade) {
    const int size = cascade.size;
    const double step = kFullTurn / cascade.patch;  // dkx = dkz
    const auto has_wave = [&](int n, int m) {
        const double k = step * std::hypot(n, m);
        return n > -size / 2 && m > -size / 2 && k > 0 && k >= cascade.band_low
               && k < cascade.band_high;
    };
    parallel_for(static_cast<std::size_t>(size), 4, [&](std::size_t begin, std::size_t end) {
        for (int row = static_cast<int>(begin); row < static_cast<int>(end); ++row) {
            for (int column = 0; column < size; ++column) {
                const int n = waves_across(row, size);
                const int m = waves_across(column, size);
                if (!has_wave(n, m)) {
                    continue;
                }
                const double energy = wave_energy(sea, step * n, step * m);
                const std::complex<double> h0 = static_cast<double>(ocean.amplitude)
                                                * std::sqrt(0.25 * energy) * step
                                                * draw(ocean, index, n, m);
                const int at = row * size + column;
                cascade.frequency[at] = static_cast<float>(
                    looped(wave_frequency(step * std::hypot(n, m), sea.depth), ocean.loop_period));
                cascade.ahead_re[at] = static_cast<float>(h0.real());
                cascade.ahead_im[at] = static_cast<float>(h0.imag());
                const int against = wave_index(-n, size) * size + wave_index(-m, size);
                cascade.behind_re[against] = static_cast<float>(h0.real());
                cascade.behind_im[against] = static_cast<float>(-h0.imag());
            }
        }
    });
}

OceanCascade make_flat_cascade(int size, double patch) {
    OceanCascade cascade;
    cascade.size = size;
    cascade.patch = static_cast<float>(patch);
    for (int i = 0; i < size; ++i) {
        cascade.axis.push_back(
            static_cast<float>(kFullTurn / patch * static_cast<double>(waves_across(i, size))));
    }
    const std::size_t points = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
    for (std::vector<float>* plane :
         {&cascade.frequency, &cascade.ahead_re, &cascade.ahead_im, &cascade.behind_re,
          &cascade.behind_im, &cascade.height, &cascade.shift_x, &cascade.shift_z, &cascade.slope_x,
          &cascade.slope_z, &cascade.shift_xx, &cascade.shift_zz, &cascade.shift_xz,
          &cascade.previous_height, &cascade.previous_shift_x, &cascade.previous_shift_z}) {
        plane->resize(points);
    }
    return cascade;
}

}  // namespace

Ocean clamp_ocean(const Ocean& ocean) {
    Ocean limited = ocean;
    limited.wind_speed = limit(ocean.wind_speed, 0.0f, 60.0f);
    limited.wind_direction = limit(ocean.wind_direction, -7.0f, 7.0f);
    limited.fetch = limit(ocean.fetch, 100.0f, 1e7f);
    limited.depth = limit(ocean.depth, 0.05f, 12000.0f);
    limited.gamma = limit(ocean.gamma, 1.0f, 20.0f);
    limited.swell = limit(ocean.swell, 0.0f, 1.0f);
    limited.amplitude = limit(ocean.amplitude, 0.0f, 10.0f);
    limited.choppiness = limit(ocean.choppiness, 0.0f, 4.0f);
    limited.cascades = std::clamp(ocean.cascades, 1, kMaxOceanCascades);
    limited.patch = limit(ocean.patch, 1.0f, 1e4f);
    const int resolution = std::clamp(ocean.resolution, 16, 1024);
    limited.resolution = static_cast<int>(std::bit_floor(static_cast<unsigned>(resolution)));
    limited.loop_period = limit(ocean.loop_period, 0.0f, 1e5f);
    limited.foam_threshold = limit(ocean.foam_threshold, -2.0f, 1.0f);
    limited.foam_rate = limit(ocean.foam_rate, 0.0f, 1000.0f);
    limited.foam_decay = limit(ocean.foam_decay, 0.01f, 1e4f);
    return limited;
}

double waves_at_band_edge(int resolution) {
    // With at least six waves per patch, sampling is dense enough; the larger grid must resolve
    // them.
    return std::min(6.0, 0.45 * resolution / kOceanPatchRatio);
}

std::vector<OceanCascade> make_ocean_cascades(const Ocean& ocean) {
    LIMN_CHECK(is_fft_size(static_cast<std::size_t>(ocean.resolution)));
    const OceanEnergy sea = make_ocean_energy(ocean);
    std::vector<OceanCascade> cascades;
    double patch = ocean.patch;
    float edge = 0;
    for (int i = 0; i < ocean.cascades; ++i) {
        OceanCascade& cascade = cascades.emplace_back(make_flat_cascade(ocean.resolution, patch));
        patch /= kOceanPatchRatio;
        const double next_edge = kFullTurn / patch * waves_at_band_edge(ocean.resolution);
        cascade.band_low = edge;
        cascade.band_high = i + 1 < ocean.cascades ? static_cast<float>(next_edge) : INFINITY;
        edge = cascade.band_high;
        draw_spectrum(ocean, sea, static_cast<std::size_t>(i), cascade);
    }
    return cascades;
}

}  // namespace limn
