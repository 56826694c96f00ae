#include "bench/oracles/water_oracle.h"
#include "ecs/base/jobs.h"
#include "ecs/components/all.h"
#include "ecs/snapshot.h"
#include "ecs/world.h"
#include "systems/update_world.h"
#include "systems/water/ocean_cascades.h"
#include "systems/water/ocean_kernels.h"
#include "systems/water/ocean_spectrum.h"
#include "systems/water/ocean_system.h"
#include "systems/water/water_dispersion.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

namespace limn::ocean_system_test {
namespace {

constexpr double kTurn = oracle::kFullTurn;
constexpr float kStep = 1.0f / 60.0f;

/// Small enough to be summed wave by wave.
constexpr Ocean kSmall = {
    .wind_speed = 6, .wind_direction = 0.6f, .cascades = 3, .patch = 60, .resolution = 32};

OceanState ocean_at_time(const Ocean& ocean, double time) {
    OceanState state;
    step_ocean(ocean, time, kStep, state);
    return state;
}

const std::vector<float>* const* fields_of(const OceanCascade& cascade) {
    thread_local const std::vector<float>* fields[8];
    fields[0] = &cascade.height;
    fields[1] = &cascade.shift_x;
    fields[2] = &cascade.shift_z;
    fields[3] = &cascade.slope_x;
    fields[4] = &cascade.slope_z;
    fields[5] = &cascade.shift_xx;
    fields[6] = &cascade.shift_zz;
    fields[7] = &cascade.shift_xz;
    return fields;
}

bool same_fields(const OceanState& a, const OceanState& b) {
    bool same = a.cascades.size() == b.cascades.size();
    for (std::size_t c = 0; same && c < a.cascades.size(); ++c) {
        for (int i = 0; i < 8; ++i) {
            same = same && *fields_of(a.cascades[c])[i] == *fields_of(b.cascades[c])[i];
        }
    }
    return same;
}

bool all_finite(const OceanState& state) {
    for (const OceanCascade& cascade : state.cascades) {
        for (int i = 0; i < 8; ++i) {
            for (const float value : *fields_of(cascade)[i]) {
                if (!std::isfinite(value)) {
                    return false;
                }
            }
        }
    }
    return true;
}

double largest(const std::vector<float>& field) {
    double most = 0;
    for (const float value : field) {
        most = std::max(most, std::abs(static_cast<double>(value)));
    }
    return most;
}

double variance(const std::vector<float>& field) {
    double sum = 0;
    for (const float value : field) {
        sum += square(static_cast<double>(value));
    }
    return sum / static_cast<double>(field.size());
}

double variance(const OceanState& state) {
    double sum = 0;
    for (const OceanCascade& cascade : state.cascades) {
        sum += variance(cascade.height);
    }
    return sum;
}

/// One wave of height 2 |h0|, `n` and `m` of which are across the patch.
OceanCascade lone_wave(int size, float patch, int n, int m, float depth, float h0 = 0.1f) {
    Ocean still = {.wind_speed = 0, .depth = depth, .cascades = 1, .patch = patch};
    still.resolution = size;
    OceanCascade cascade = make_ocean_cascades(still).front();
    const auto index_of = [&](int i, int j) {
        return (i + size) % size * size + (j + size) % size;
    };
    const double k = kTurn / static_cast<double>(patch) * std::hypot(n, m);
    const float omega = static_cast<float>(wave_frequency(k, depth));
    cascade.ahead_re[index_of(n, m)] = h0;
    cascade.behind_re[index_of(-n, -m)] = h0;
    cascade.frequency[index_of(n, m)] = omega;
    cascade.frequency[index_of(-n, -m)] = omega;
    return cascade;
}

/// How far the wave (n, m) of the height is turned [rad].
double phase_of(const OceanCascade& cascade, int n, int m) {
    oracle::Complex sum = 0;
    for (int z = 0; z < cascade.size; ++z) {
        for (int x = 0; x < cascade.size; ++x) {
            const double angle = -kTurn * (n * x + m * z) / cascade.size;
            sum +=
                static_cast<double>(cascade.height[z * cascade.size + x]) * std::polar(1.0, angle);
        }
    }
    return std::arg(sum);
}

}  // namespace

TEST_CASE(
    "ocean: every field is the sum of its travelling waves, within 1e-5 of the maximum"
    * technique("water.fft-synthesis")) {
    for (const double time : {0.0, 12.34, 3600.0}) {
        const OceanState state = ocean_at_time(kSmall, time);
        REQUIRE(state.cascades.size() == 3);
        for (const OceanCascade& cascade : state.cascades) {
            double largest_error[8] = {};
            for (int i = 0; i < cascade.size * cascade.size; i += 7) {
                const double spacing = static_cast<double>(cascade.patch) / cascade.size;
                const oracle::OceanPoint sum = oracle::ocean_at(
                    cascade, 1.0, spacing * (i % cascade.size), spacing * (i / cascade.size), time);
                const double expected[8] = {sum.height,  sum.shift_x,  sum.shift_z,  sum.slope_x,
                                            sum.slope_z, sum.shift_xx, sum.shift_zz, sum.shift_xz};
                for (int field = 0; field < 8; ++field) {
                    const double found = (*fields_of(cascade)[field])[i];
                    largest_error[field] =
                        std::max(largest_error[field], std::abs(found - expected[field]));
                }
            }
            for (int field = 0; field < 8; ++field) {
                CAPTURE(time);
                CAPTURE(cascade.patch);
                CAPTURE(field);
                CHECK(largest_error[field] < 1e-5 * largest(*fields_of(cascade)[field]));
            }
        }
    }
}

TEST_CASE(
    "ocean: heights are real, with an imaginary part below 1e-6 of the maximum"
    * technique("water.fft-synthesis")) {
    Ocean ocean = kSmall;
    ocean.choppiness = 0;  // then shift_x is the imaginary part of the height's transform
    const OceanState state = ocean_at_time(ocean, 5.0);
    for (const OceanCascade& cascade : state.cascades) {
        CHECK(largest(cascade.height) > 0);
        CHECK(largest(cascade.shift_x) < 1e-6 * largest(cascade.height));
    }
}

TEST_CASE(
    "ocean: a single wave is a cosine with a sine shift, toward its crests"
    * technique("water.fft-synthesis")) {
    OceanCascade cascade = lone_wave(32, 40, 3, 0, 1000);
    synthesize_waves(cascade, 0.8f, 0.0);
    const double k = kTurn * 3 / 40;
    for (int i = 0; i < 32 * 32; ++i) {
        const double phase = k * (i % 32) * 40 / 32;
        CHECK(std::abs(cascade.height[i] - 0.2 * std::cos(phase)) < 1e-6);
        CHECK(std::abs(cascade.shift_x[i] + 0.8 * 0.2 * std::sin(phase)) < 1e-6);
        CHECK(std::abs(cascade.slope_x[i] + k * 0.2 * std::sin(phase)) < 1e-6);
        CHECK(std::abs(cascade.shift_xx[i] + 0.8 * k * 0.2 * std::cos(phase)) < 1e-6);
        CHECK(std::abs(cascade.shift_z[i]) < 1e-7);
        CHECK(std::abs(cascade.slope_z[i]) < 1e-7);
    }
}

TEST_CASE(
    "ocean: waves run along their wave vectors at the dispersion's speed, within 0.1 %"
    * technique("water.fft-synthesis")) {
    struct Case {
        int n, m;
        float depth;
    };
    for (const Case& c :
         {Case{1, 0, 1e4f}, Case{3, -2, 1e4f}, Case{-5, 7, 1e4f}, Case{2, 2, 1.0f},
          Case{0, -1, 0.3f}}) {
        OceanCascade cascade = lone_wave(32, 50, c.n, c.m, c.depth);
        const double k = kTurn / 50 * std::hypot(c.n, c.m);
        // Crests move by a third of a wave, and then by a thousand and a third.
        const double speed = phase_speed(k, c.depth);
        for (const double waves : {1.0 / 3.0, 1000.0 + 1.0 / 3.0}) {
            synthesize_waves(cascade, 0.0f, waves * kTurn / k / speed);
            const double behind = -phase_of(cascade, c.n, c.m) / kTurn;
            CAPTURE(c.n);
            CAPTURE(c.m);
            CHECK(std::abs(behind - 1.0 / 3.0) < 1e-3 / 3.0);
        }
    }
}

TEST_CASE(
    "ocean: the variance of its heights is the spectrum's, within 5 % over 32 seeds"
    * technique("water.fft-synthesis")) {
    Ocean ocean = {.cascades = 1, .patch = 100, .resolution = 64};
    ocean.wind_speed = static_cast<float>(0.13 * kGravity / 0.2);  // peak at 0.2 Hz
    double sum = 0;
    for (ocean.seed = 1; ocean.seed <= 32; ++ocean.seed) {
        sum += variance(ocean_at_time(ocean, 10.0));
    }
    CHECK(std::abs(sum / 32 / 0.061618 - 1) < 0.05);  // its m0 on this grid
    // Four standard deviations are the significant height, that of the closed form 1.000154 m.
    CHECK(std::abs(4 * std::sqrt(sum / 32) / 1.000154 - 1) < 0.05);
}

TEST_CASE("ocean: cascades split the spectrum, and together have its variance, within 5 %") {
    for (const OceanSpectrum spectrum : {OceanSpectrum::WindSea, OceanSpectrum::Jonswap}) {
        Ocean ocean = {.spectrum = spectrum, .wind_speed = 5, .patch = 150, .resolution = 32};
        const OceanEnergy sea = make_ocean_energy(ocean);
        double m0 = 0;
        constexpr double kBit = 1e-3;
        for (double omega = kBit; omega < 60; omega += kBit) {
            m0 += frequency_energy(sea, omega) * kBit;
        }
        double sum = 0;
        for (ocean.seed = 1; ocean.seed <= 32; ++ocean.seed) {
            sum += variance(ocean_at_time(ocean, 0.0));
        }
        CHECK(std::abs(4 * std::sqrt(sum / 32) / (4 * std::sqrt(m0)) - 1) < 0.05);
    }
}

TEST_CASE("ocean: each wave number is in exactly one cascade") {
    for (const int resolution : {16, 32, 64, 256}) {
        CAPTURE(resolution);
        const std::vector<OceanCascade> cascades =
            make_ocean_cascades({.cascades = 4, .resolution = resolution});
        REQUIRE(cascades.size() == 4);
        CHECK(cascades.front().band_low == 0);
        CHECK(std::isinf(cascades.back().band_high));
        for (std::size_t c = 0; c < 4; ++c) {
            const OceanCascade& cascade = cascades[c];
            CHECK((c == 0 || cascade.band_low == cascades[c - 1].band_high));
            const double step = kTurn / static_cast<double>(cascade.patch);
            CHECK((c == 0 || cascade.band_low >= 1.5 * step));
            CHECK((c == 3 || cascade.band_high < step * (resolution / 2 - 0.5)));
            std::size_t waves = 0;
            for (int i = 0; i < resolution * resolution; ++i) {
                const double k =
                    std::hypot(cascade.axis[i / resolution], cascade.axis[i % resolution]);
                const bool inside = k >= cascade.band_low && k < cascade.band_high;
                const bool has_wave = cascade.ahead_re[i] != 0 || cascade.ahead_im[i] != 0;
                CHECK((inside || !has_wave));
                waves += has_wave ? 1 : 0;
            }
            CHECK(waves > 20);
            // Where the largest grid stands still and where slopes would not be real.
            CHECK(cascade.ahead_re[0] == 0);
            const int half = resolution / 2;
            for (int i = 0; i < resolution; ++i) {
                CHECK(cascade.ahead_re[half * resolution + i] == 0);
                CHECK(cascade.ahead_re[i * resolution + half] == 0);
            }
        }
    }
}

TEST_CASE(
    "ocean: a patch repeats, and each wave has a whole number of periods in it"
    * technique("water.fft-synthesis")) {
    const std::vector<OceanCascade> cascades = make_ocean_cascades(kSmall);
    for (const OceanCascade& cascade : cascades) {
        for (const float number : cascade.axis) {
            const double waves =
                static_cast<double>(number) * static_cast<double>(cascade.patch) / kTurn;
            CHECK(std::abs(waves - std::round(waves)) < 1e-5);
        }
        const double patch = cascade.patch;
        const double here = oracle::ocean_at(cascade, 1, 1.3, 2.4, 7).height;
        const double there = oracle::ocean_at(cascade, 1, 1.3 + patch, 2.4 - 2 * patch, 7).height;
        CHECK(there == test::near(here).epsilon(1e-9).scale(0));
    }
    for (std::size_t c = 1; c < cascades.size(); ++c) {
        const double ratio = cascades[c - 1].patch / cascades[c].patch;
        CHECK(ratio == test::near(std::pow((1 + std::sqrt(5.0)) / 2, 3)));
    }
}

TEST_CASE(
    "ocean: under wind at 45 degrees waves concentrate on the diagonal and run along it"
    * technique("water.fft-synthesis")) {
    Ocean ocean = {.swell = 1, .cascades = 1, .patch = 100, .resolution = 64};
    ocean.wind_speed = 6;
    ocean.wind_direction = 0.125f * static_cast<float>(kTurn);
    const OceanCascade cascade = make_ocean_cascades(ocean).front();
    double xx = 0;
    double zz = 0;
    double xz = 0;
    double ahead = 0;
    double all = 0;
    for (int i = 0; i < 64 * 64; ++i) {
        const double energy = std::norm(oracle::Complex(cascade.ahead_re[i], cascade.ahead_im[i]));
        const double kx = cascade.axis[i / 64];
        const double kz = cascade.axis[i % 64];
        xx += energy * kx * kx;
        zz += energy * kz * kz;
        xz += energy * kx * kz;
        ahead += energy * (kx + kz) * std::sqrt(0.5);
        all += energy * std::hypot(kx, kz);
    }
    const double axis = 0.5 * std::atan2(2 * xz, xx - zz);  // of the ellipse of second moments
    CHECK(std::abs(axis - kTurn / 8) < 0.07);
    const double mean = 0.5 * (xx + zz);
    const double half_spread = std::hypot(0.5 * (xx - zz), xz);
    CHECK((mean + half_spread) / (mean - half_spread) > 2);
    CHECK(ahead / all > 0.7);
}

TEST_CASE(
    "ocean: with a loop period it repeats after that time, and not before"
    * technique("water.fft-synthesis")) {
    Ocean ocean = kSmall;
    ocean.loop_period = 20;
    const OceanState start = ocean_at_time(ocean, 1.0);
    const auto difference = [&](const OceanState& other) {
        double most = 0;
        for (std::size_t i = 0; i < start.cascades[0].height.size(); ++i) {
            const float there = other.cascades[0].height[i];
            most =
                std::max(most, std::abs(static_cast<double>(there - start.cascades[0].height[i])));
        }
        return most / largest(start.cascades[0].height);
    };
    CHECK(difference(ocean_at_time(ocean, 21.0)) < 1e-5);
    CHECK(difference(ocean_at_time(ocean, 1.0 + 20 * 500)) < 1e-5);
    CHECK(difference(ocean_at_time(ocean, 11.0)) > 0.1);
    ocean.loop_period = 0;
    CHECK(difference(ocean_at_time(ocean, 21.0)) > 0.1);
}

TEST_CASE(
    "ocean: a seed is reproducible bit by bit, another seed differs, finer grids add waves"
    * technique("water.fft-synthesis")) {
    const OceanState once = ocean_at_time(kSmall, 3.0);
    CHECK(same_fields(once, ocean_at_time(kSmall, 3.0)));
    Ocean other = kSmall;
    other.seed = 2;
    CHECK_FALSE(same_fields(once, ocean_at_time(other, 3.0)));

    Ocean coarse = {.cascades = 1, .resolution = 32};
    Ocean fine = coarse;
    fine.resolution = 64;
    const OceanCascade few = make_ocean_cascades(coarse).front();
    const OceanCascade many = make_ocean_cascades(fine).front();
    for (int n = -15; n < 16; ++n) {
        for (int m = -15; m < 16; ++m) {
            const int at = (n + 32) % 32 * 32 + (m + 32) % 32;
            const int fine_at = (n + 64) % 64 * 64 + (m + 64) % 64;
            CHECK(few.ahead_re[at] == many.ahead_re[fine_at]);
            CHECK(few.behind_im[at] == many.behind_im[fine_at]);
        }
    }
}

TEST_CASE("ocean: any number of threads and any order are bit-identical") {
    const int before = thread_count();
    set_thread_count(1);
    Ocean ocean = kSmall;
    ocean.resolution = 64;
    const OceanState alone = ocean_at_time(ocean, 4.0);
    OceanFoam foam_alone;
    ocean.foam_threshold = 1;
    step_ocean_foam(ocean, alone, kStep, foam_alone);
    for (const int threads : {2, 7}) {
        set_thread_count(threads);
        set_task_shuffle(static_cast<std::uint64_t>(threads));
        const OceanState state = ocean_at_time(ocean, 4.0);
        CHECK(same_fields(state, alone));
        OceanFoam foam;
        step_ocean_foam(ocean, state, kStep, foam);
        CHECK(foam.coverage == foam_alone.coverage);
    }
    set_task_shuffle(0);
    set_thread_count(before);
}

TEST_CASE("ocean: SIMD of any width is bit-identical to one lane") {
    const OceanState state = ocean_at_time(kSmall, 0.0);
    for (const OceanCascade& cascade : state.cascades) {
        std::vector<float> wide(kOceanPairs * 2 * kFftColumns * 32);
        std::vector<float> narrow(wide.size());
        for (const std::size_t first : {0, 16}) {
            evolve_waves(cascade, 1.3f, 1234.5, first, wide);
            evolve_waves_scalar(cascade, 1.3f, 1234.5, first, narrow);
            CHECK(wide == narrow);
        }
        std::vector<float> foam(32 * 32, 0.25f);
        std::vector<float> foam_narrow = foam;
        const ShiftDerivatives shift = {cascade.shift_xx, cascade.shift_zz, cascade.shift_xz};
        step_foam(shift, 0.95f, 0.3f, 0.9f, foam, 3, 1001);
        step_foam_scalar(shift, 0.95f, 0.3f, 0.9f, foam_narrow, 3, 1001);
        CHECK(foam == foam_narrow);
        CHECK(foam[2] == 0.25f);
        CHECK(foam[1001] == 0.25f);
    }
}

TEST_CASE("ocean: the previous fields are those of one step earlier, from the first step on") {
    OceanState state;
    step_ocean(kSmall, 2.0, kStep, state);
    const auto has_last_of = [&](double time) {
        const OceanState earlier = ocean_at_time(state.made_for, time);
        bool same = true;
        for (std::size_t c = 0; c < state.cascades.size(); ++c) {
            same = same && state.cascades[c].previous_height == earlier.cascades[c].height
                   && state.cascades[c].previous_shift_x == earlier.cascades[c].shift_x
                   && state.cascades[c].previous_shift_z == earlier.cascades[c].shift_z;
        }
        return same;
    };
    const double step = static_cast<double>(kStep);
    CHECK(has_last_of(2.0 - step));
    step_ocean(kSmall, 2.0 + step, kStep, state);
    CHECK(has_last_of(2.0));
    step_ocean(kSmall, 50.0, kStep, state);  // a jump in time
    CHECK(has_last_of(50.0 - step));
    Ocean gale = kSmall;
    gale.wind_speed = 15;
    step_ocean(gale, 50.0 + step, kStep, state);  // other waves have no past
    CHECK(has_last_of(50.0));
}

TEST_CASE("ocean: foam decays to 1 / e in its lifetime, and grows where water is compressed") {
    OceanCascade calm = lone_wave(16, 40, 1, 0, 1000, 0.0f);
    synthesize_waves(calm, 1.0f, 0.0);
    OceanState state;
    state.cascades = {calm};
    const Ocean ocean = {.foam_threshold = 0.5f, .foam_rate = 10, .foam_decay = 2};
    OceanFoam foam;
    step_ocean_foam(ocean, state, kStep, foam);
    CHECK(largest(foam.coverage) == 0);  // flat water does not foam
    foam.coverage.assign(foam.coverage.size(), 0.8f);
    for (int i = 0; i < 120; ++i) {
        step_ocean_foam(ocean, state, kStep, foam);
    }
    CHECK(foam.coverage[0] == test::near(0.8 * std::exp(-1.0)).epsilon(1e-4).scale(0));

    // A wave so steep that its crests fold: there the shift leaves less than nothing of an area.
    OceanCascade steep = lone_wave(16, 40, 1, 0, 1000, 5.0f);
    synthesize_waves(steep, 1.0f, 0.0);
    state.cascades = {steep};
    foam.coverage.assign(foam.coverage.size(), 0.0f);
    for (int i = 0; i < 3000; ++i) {
        step_ocean_foam(ocean, state, 0.001f, foam);
    }
    const double left = 1 + static_cast<double>(steep.shift_xx[0]);
    CHECK(left < 0);
    const double growth = 10 * (0.5 - left);
    // Where growth and decay are equal.
    CHECK(foam.coverage[0] == test::near(growth / (growth + 0.5)).epsilon(0.01).scale(0));
    CHECK(foam.coverage[8] == 0);  // the trough
}

TEST_CASE("ocean: foam grows with the compression given by the Jacobian of the shift") {
    Ocean ocean = kSmall;
    ocean.wind_speed = 20;
    ocean.choppiness = 2;
    ocean.foam_threshold = 0.9f;
    const OceanState state = ocean_at_time(ocean, 3.0);
    OceanFoam foam;
    foam.coverage.assign(32 * 32, 0.3f);
    step_ocean_foam(ocean, state, 0.02f, foam);
    const double spacing = static_cast<double>(state.cascades[0].patch) / 32;
    double growing = 0;
    for (int j = 0; j < 32; ++j) {
        for (int i = 0; i < 32; ++i) {
            // In the copy of the patch about the origin, by the nearest point of the smaller ones.
            const double x = spacing * (i < 16 ? i : i - 32);
            const double z = spacing * (j < 16 ? j : j - 32);
            double xx = 0;
            double zz = 0;
            double xz = 0;
            for (const OceanCascade& cascade : state.cascades) {
                if (cascade.band_low > kPi) {
                    continue;  // shorter than two meters
                }
                const double points = 32 / static_cast<double>(cascade.patch);
                const int n = (static_cast<int>(std::lround(x * points)) + 3200) % 32;
                const int m = (static_cast<int>(std::lround(z * points)) + 3200) % 32;
                xx += static_cast<double>(cascade.shift_xx[m * 32 + n]);
                zz += static_cast<double>(cascade.shift_zz[m * 32 + n]);
                xz += static_cast<double>(cascade.shift_xz[m * 32 + n]);
            }
            const double left = (1 + xx) * (1 + zz) - xz * xz;
            const double growth = 60 * 0.02 * std::max(0.9 - left, 0.0);
            const double expected = (0.3 + growth) / (1 + growth) * std::exp(-0.02 / 4);
            CHECK(std::abs(foam.coverage[j * 32 + i] - expected) < 1e-6);
            growing += left < 0.9 && std::abs(xz) > 0.05 ? 1 : 0;
        }
    }
    CHECK(growing > 20);
}

TEST_CASE("ocean: waves of all lengths break together, on the crests of the long ones") {
    // Neither of the waves is steep enough to break, nor are short ones where the long one
    // stretches the surface.
    OceanCascade swell = lone_wave(64, 64, 2, 0, 1000, 0.45f);
    OceanCascade chop = lone_wave(64, 16, 4, 0, 1000, 0.06f);
    synthesize_waves(swell, 1.0f, 0.0);
    synthesize_waves(chop, 1.0f, 0.0);
    OceanState state;
    const Ocean ocean = {.foam_threshold = 0.75f};
    for (const OceanCascade& alone : {swell, chop}) {
        state.cascades = {alone};
        OceanFoam foam;
        step_ocean_foam(ocean, state, kStep, foam);
        CHECK(largest(foam.coverage) == 0);
    }
    state.cascades = {swell, chop};
    OceanFoam foam;
    step_ocean_foam(ocean, state, kStep, foam);
    int white = 0;
    for (std::size_t i = 0; i < foam.coverage.size(); ++i) {
        if (foam.coverage[i] > 0) {
            CHECK(swell.height[i] > 0.3f * largest(swell.height));
            ++white;
        }
    }
    CHECK(white > 0);
}

TEST_CASE("ocean: whitecaps cover about as much of the sea as is measured, more in stronger wind") {
    // Monahan and O'Muircheartaigh 1980, with a scatter of a factor of three.
    const auto measured = [](double wind) { return 3.84e-6 * std::pow(wind, 3.41); };
    for (const float wind : {10.0f, 15.0f, 20.0f}) {
        CAPTURE(wind);
        const Ocean sea = {
            .spectrum = OceanSpectrum::Jonswap,
            .wind_speed = wind,
            .resolution = 128,
            .foam_threshold = 0.7f};
        OceanState state;
        OceanFoam foam;
        for (int i = 0; i < 40; ++i) {
            step_ocean(sea, 0.25 * i, 0.25f, state);
            step_ocean_foam(sea, state, 0.25f, foam);
        }
        double white = 0;
        for (const float cover : foam.coverage) {
            const double thin = static_cast<double>(cover);
            white += thin * (0.4 + 0.6 * thin) / (128 * 128);  // as it is drawn
        }
        CHECK(white < 3 * measured(static_cast<double>(wind)));
        CHECK(white > measured(static_cast<double>(wind)) / 3);
    }
}

TEST_CASE("ocean: waves shorter than two meters break without foam") {
    OceanCascade steep = lone_wave(16, 40, 1, 0, 1000, 5.0f);
    synthesize_waves(steep, 1.0f, 0.0);
    for (const float longest : {1.9f, 2.1f}) {
        steep.band_low = 2 * kPi / longest;
        OceanState state;
        state.cascades = {steep};
        OceanFoam foam;
        step_ocean_foam({}, state, kStep, foam);
        CHECK((largest(foam.coverage) > 0) == (longest > 2));
    }
}

TEST_CASE("ocean: foam stays between 0 and 1 for steps of any length") {
    Ocean ocean = kSmall;
    ocean.choppiness = 4;
    ocean.foam_threshold = 1;
    ocean.foam_rate = 1000;
    for (const float step : {1e-4f, kStep, 1.0f, 20.0f}) {
        OceanFoam foam;
        double highest = 0;
        for (int i = 0; i < 5; ++i) {
            step_ocean_foam(ocean, ocean_at_time(ocean, i), step, foam);
            for (const float coverage : foam.coverage) {
                CHECK(coverage >= 0);
                CHECK(coverage <= 1);
                highest = std::max(highest, static_cast<double>(coverage));
            }
        }
        CHECK(highest > 0);
    }
}

TEST_CASE("ocean: without wind it is flat; settings out of range are clamped") {
    Ocean calm = kSmall;
    calm.wind_speed = 0;
    const OceanState still = ocean_at_time(calm, 1.0);
    CHECK(variance(still) == 0);
    CHECK(all_finite(still));

    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Ocean storm = {.wind_speed = 1e6f, .cascades = 1, .resolution = 16};
    const Ocean bad[] = {
        storm,
        {.wind_speed = -5, .resolution = 16},
        {.depth = -10, .resolution = 16},
        {.patch = 0, .resolution = 16},
        {.cascades = 99, .resolution = 16},
        {.cascades = -1, .resolution = 0},
        {.spectrum = OceanSpectrum::Jonswap, .fetch = -1, .gamma = -3, .resolution = 16},
        {.wind_speed = nan, .fetch = nan, .depth = nan, .amplitude = nan, .resolution = 16},
        {.wind_direction = nan, .choppiness = nan, .patch = nan, .loop_period = nan},
    };
    for (const Ocean& ocean : bad) {
        OceanState state;
        step_ocean(ocean, 1.0, kStep, state);
        CHECK(all_finite(state));
        const Ocean limited = clamp_ocean(ocean);
        CHECK(clamp_ocean(limited) == limited);
        CHECK(state.cascades.size() == static_cast<std::size_t>(limited.cascades));
    }
    CHECK(clamp_ocean(storm).wind_speed == 60);
    CHECK(clamp_ocean({.resolution = 100}).resolution == 64);
    CHECK(clamp_ocean({.resolution = 5000}).resolution == 1024);
    CHECK(clamp_ocean(kSmall) == kSmall);
}

TEST_CASE("ocean: its height is the same after an hour, or a day") {
    OceanState state;
    Ocean ocean = kSmall;
    ocean.patch = 300;  // many waves: the sum of their energies hardly beats
    step_ocean(ocean, 0.0, kStep, state);
    double mean[3] = {0, 0, 0};
    const double start[3] = {0, 3600, 86400};
    for (int part = 0; part < 3; ++part) {
        for (int i = 0; i < 20; ++i) {
            step_ocean(ocean, start[part] + 1.3 * i, kStep, state);
            mean[part] += variance(state) / 20;
        }
        CHECK(all_finite(state));
    }
    CHECK(mean[1] / mean[0] == test::near(1).epsilon(0.05).scale(0));
    CHECK(mean[2] / mean[0] == test::near(1).epsilon(0.05).scale(0));
}

TEST_CASE("ocean: a world steps it, and continues bit-identically from a snapshot") {
    register_all_components();
    Ocean ocean = kSmall;
    ocean.foam_threshold = 1;
    World world;
    const Entity sea = world.create(ocean);
    start_world(world);
    REQUIRE(world.has<OceanState>(sea));
    CHECK(world.get<OceanState>(sea).time == 0.0);
    CHECK(largest(world.get<OceanFoam>(sea).coverage) == 0);
    Schedule schedule = make_world_schedule();
    for (int i = 0; i < 3; ++i) {
        step_world(world, schedule);
    }
    CHECK(world.get<OceanState>(sea).time == test::near(0.05));
    CHECK(largest(world.get<OceanFoam>(sea).coverage) > 0);

    const Result<std::vector<std::byte>> saved = save_snapshot(world);
    REQUIRE(saved.ok());
    World other;
    REQUIRE(restore_snapshot(other, saved.value()).ok());
    for (int i = 0; i < 2; ++i) {
        step_world(world, schedule);
        Schedule own = make_world_schedule();
        step_world(other, own);
    }
    CHECK(same_fields(world.get<OceanState>(sea), other.get<OceanState>(sea)));
    CHECK(world.get<OceanFoam>(sea).coverage == other.get<OceanFoam>(sea).coverage);
    CHECK(
        world.get<OceanState>(sea).cascades[0].previous_height
        == other.get<OceanState>(sea).cascades[0].previous_height);
}

}  // namespace limn::ocean_system_test
