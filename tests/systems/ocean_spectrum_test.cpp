#include "systems/water/ocean_spectrum.h"
#include "systems/water/water_dispersion.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

namespace limn::ocean_spectrum_test {
namespace {

constexpr double kTurn = 6.283185307179586;

constexpr OceanSpectrum kSpectra[] = {
    OceanSpectrum::WindSea, OceanSpectrum::Phillips, OceanSpectrum::Jonswap, OceanSpectrum::Tma};
constexpr OceanSpreading kSpreadings[] = {
    OceanSpreading::WindSea, OceanSpreading::Hasselmann, OceanSpreading::DonelanBanner,
    OceanSpreading::CosineSquared};

/// Trapezoids over the logarithm: exact to many digits for what vanishes at both ends.
template <typename F>
double integrate_log(double from, double to, const F& f) {
    constexpr int kSteps = 20000;
    const double step = std::log(to / from) / kSteps;
    double sum = 0;
    for (int i = 0; i <= kSteps; ++i) {
        const double x = from * std::exp(step * i);
        sum += (i == 0 || i == kSteps ? 0.5 : 1.0) * f(x) * x;
    }
    return sum * step;
}

/// Simpson over a turn, denser toward the rear, where cos^2p has a kink.
double integrate_turn(const OceanEnergy& sea, double omega) {
    constexpr int kSteps = 4000;
    double sum = 0;
    for (int i = 0; i <= kSteps; ++i) {
        const double u = static_cast<double>(i) / kSteps;
        const double from_rear = u * u * u;
        const double theta = 0.5 * kTurn * (1.0 - from_rear);
        const double weight = i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
        sum += weight * directional_density(sea, omega, theta) * 3.0 * u * u;
    }
    return 2.0 * sum * 0.5 * kTurn / (3.0 * kSteps);
}

/// How far two numbers are from being in the ratio of 1; doctest's Approx is loose below 1.
double ratio(double found, double expected) {
    return std::abs(found / expected - 1);
}

OceanEnergy wind_sea_of_peak(double f_p) {
    return make_ocean_energy({.wind_speed = static_cast<float>(0.13 * kGravity / f_p)});
}

/// Sum of S dkx dkz over the wave numbers of one patch.
double sum_of_grid(const OceanEnergy& sea, int size, double patch) {
    const double step = kTurn / patch;
    double sum = 0;
    for (int n = -size / 2; n < size / 2; ++n) {
        for (int m = -size / 2; m < size / 2; ++m) {
            sum += wave_energy(sea, step * n, step * m) * step * step;
        }
    }
    return sum;
}

}  // namespace

TEST_CASE(
    "ocean_spectrum: the wind sea has the values of its formula and a single maximum, at f_p"
    * technique("water.ocean-spectrum")) {
    CHECK(wind_sea_energy(0.1, 0.1) == test::near(14.329646).epsilon(1e-6).scale(0));
    CHECK(wind_sea_energy(0.2, 0.1) == test::near(1.445521).epsilon(1e-6).scale(0));
    CHECK(ratio(wind_sea_energy(0.05, 0.1), 3.29886e-6) < 2e-6);
    double last = 0;
    for (double f = 0.001; f <= 0.1; f += 0.001) {
        CHECK(wind_sea_energy(f, 0.1) >= last);
        last = wind_sea_energy(f, 0.1);
    }
    last = wind_sea_energy(0.1, 0.1);
    for (double f = 0.101; f <= 3; f += 0.001) {
        CHECK(wind_sea_energy(f, 0.1) < last);
        last = wind_sea_energy(f, 0.1);
    }
    CHECK(wind_sea_energy(1e-3, 0.1) == 0);  // no NaN toward 0
    CHECK(wind_sea_energy(0, 0.1) == 0);
    CHECK(wind_sea_energy(-1, 0.1) == 0);
}

TEST_CASE(
    "ocean_spectrum: the wind sea's integral is alpha g^2 / (5 (2 pi)^4 f_p^4)"
    * technique("water.ocean-spectrum")) {
    for (const double f_p : {0.1, 0.2, 0.5}) {
        const double closed = kPhillipsConstant * square(kGravity) / (5 * std::pow(kTurn * f_p, 4));
        const double sum =
            integrate_log(1e-3, 1e4, [&](double f) { return wind_sea_energy(f, f_p); });
        CHECK(ratio(sum, closed) < 1e-7);
    }
    const auto height = [](double f_p) {
        return 4 * std::sqrt(integrate_log(1e-3, 1e4, [&](double f) {
                   return wind_sea_energy(f, f_p);
               }));
    };
    CHECK(height(0.1) == test::near(4.000615).epsilon(1e-6).scale(0));
    CHECK(height(0.2) == test::near(1.000154).epsilon(1e-6).scale(0));
}

TEST_CASE(
    "ocean_spectrum: waves at the peak run with the wind, longer and shorter ones less so"
    * technique("water.ocean-spectrum")) {
    CHECK(cosine_power_integral(0) == test::near(kTurn));
    CHECK(cosine_power_integral(1) == test::near(0.5 * kTurn));
    CHECK(cosine_power_integral(2) == test::near(2.356194).epsilon(1e-6).scale(0));
    CHECK(cosine_power_integral(9.77) == test::near(1.119705).epsilon(1e-6).scale(0));
    CHECK(wind_sea_spread_power(1) == test::near(9.77));
    CHECK(wind_sea_spread_power(0.5) == test::near(0.585751).epsilon(1e-6).scale(0));
    CHECK(wind_sea_spread_power(2) == test::near(1.929676).epsilon(1e-6).scale(0));
    CHECK(wind_sea_spread_power(4) == test::near(0.381131).epsilon(1e-5).scale(0));
    // Far beyond where the gamma functions overflow it narrows to a bell.
    CHECK(ratio(cosine_power_integral(1e5), 2 * std::sqrt(0.5 * kTurn / 1e5)) < 1e-4);

    const OceanEnergy sea = wind_sea_of_peak(0.1);
    const double at_peak = directional_density(sea, sea.peak, 0);
    CHECK(at_peak == test::near(0.893092).epsilon(1e-6).scale(0));
    const double half = 30.3422 * kTurn / 360;
    CHECK(
        directional_density(sea, sea.peak, half)
        == test::near(0.5 * at_peak).epsilon(1e-5).scale(0));
    CHECK(
        directional_density(sea, sea.peak, -half)
        == test::near(0.5 * at_peak).epsilon(1e-5).scale(0));
}

TEST_CASE(
    "ocean_spectrum: spreading integrates to 1 over all directions, with every method"
    * technique("water.ocean-spectrum")) {
    for (const OceanSpreading spreading : kSpreadings) {
        for (const float swell : {0.0f, 0.4f, 1.0f}) {
            const OceanEnergy sea = make_ocean_energy({.spreading = spreading, .swell = swell});
            const bool closed = sea.spread_scale.empty();
            for (const double x : {0.1, 0.3, 0.5, 0.8, 1.0, 1.37, 2.0, 4.0, 20.0}) {
                CAPTURE(static_cast<int>(spreading));
                CAPTURE(swell);
                CAPTURE(x);
                const double whole = integrate_turn(sea, x * sea.peak);
                CHECK(whole == test::near(1).epsilon(closed ? 1e-6 : 3e-4).scale(0));
            }
        }
    }
}

TEST_CASE(
    "ocean_spectrum: spreading is symmetric about the wind, with its maximum downwind"
    * technique("water.ocean-spectrum")) {
    for (const OceanSpreading spreading : kSpreadings) {
        CAPTURE(static_cast<int>(spreading));
        const OceanEnergy sea = make_ocean_energy({.spreading = spreading, .swell = 0.3f});
        for (const double x : {0.5, 1.0, 3.0}) {
            const double ahead = directional_density(sea, x * sea.peak, 0);
            for (double theta = 0.1; theta < 3.14; theta += 0.1) {
                const double density = directional_density(sea, x * sea.peak, theta);
                CHECK(density <= ahead);
                CHECK(density >= 0);
                CHECK(directional_density(sea, x * sea.peak, -theta) == density);
                const double turned = directional_density(sea, x * sea.peak, theta + kTurn);
                CHECK(turned == test::near(density).epsilon(1e-9).scale(0));
            }
        }
    }
    const OceanEnergy sea = make_ocean_energy({});
    CHECK(directional_density(sea, 2 * sea.peak, 0.5 * kTurn) < 1e-12);
}

TEST_CASE("ocean_spectrum: exponents of Hasselmann and Donelan-Banner are continuous") {
    CHECK(hasselmann_spread_power(1, 0.8) == test::near(6.97));
    CHECK(ratio(hasselmann_spread_power(0.5, 0.8), 6.97 * std::pow(0.5, 4.06)) < 1e-12);
    // Where the wind is 1.17 times as fast as the waves the power is that of the first study.
    CHECK(hasselmann_spread_power(2, 1.17) == test::near(9.77 * std::pow(2, -2.33)));
    CHECK(hasselmann_spread_power(2, 3) < hasselmann_spread_power(2, 1));
    CHECK(donelan_banner_beta(0.3) == donelan_banner_beta(0.56));
    for (const double joint : {0.95, 1.6}) {
        const double before = donelan_banner_beta(joint - 1e-9);
        CHECK(donelan_banner_beta(joint + 1e-9) == test::near(before).epsilon(3e-3).scale(0));
    }
    CHECK(donelan_banner_beta(0.7) == test::near(2.61 * std::pow(0.7, 1.3)));
    CHECK(donelan_banner_beta(1.2) == test::near(2.28 * std::pow(1.2, -1.3)));
    CHECK(donelan_banner_beta(100) == test::near(std::pow(10, -0.4)).epsilon(0.02).scale(0));
    // sech^2 has a closed integral: 2 tanh(pi beta) / beta.
    const OceanEnergy sea = make_ocean_energy({.spreading = OceanSpreading::DonelanBanner});
    for (const double x : {0.7, 1.2, 3.0}) {
        const double beta = donelan_banner_beta(x);
        const double closed = 0.5 * beta / std::tanh(0.5 * kTurn * beta);
        CHECK(
            directional_density(sea, x * sea.peak, 0) == test::near(closed).epsilon(1e-3).scale(0));
    }
}

TEST_CASE("ocean_spectrum: swell narrows long waves about the wind, and short ones less") {
    CHECK(swell_power(1, 0) == 0);
    CHECK(swell_power(1, 1) == test::near(16 * std::tanh(1.0)));
    CHECK(swell_power(1, 0.5) == test::near(4 * std::tanh(1.0)));
    CHECK(swell_power(0.01, 1) == test::near(16));
    CHECK(swell_power(100, 1) == test::near(0.16).epsilon(1e-3).scale(0));
    for (const OceanSpreading spreading : kSpreadings) {
        double last[2] = {0, 0};
        for (const float swell : {0.0f, 0.3f, 0.6f, 1.0f}) {
            const OceanEnergy sea = make_ocean_energy({.spreading = spreading, .swell = swell});
            for (const int i : {0, 1}) {
                const double density = directional_density(sea, (i == 0 ? 0.7 : 3.0) * sea.peak, 0);
                CHECK(density > last[i]);
                last[i] = density;
            }
        }
    }
}

TEST_CASE("ocean_spectrum: JONSWAP peaks at omega_p, gamma times as high as without enhancement") {
    const double alpha = 0.01;
    for (const double gamma : {1.0, 3.3, 7.0}) {
        const double peak = jonswap_energy(0.8, 0.8, alpha, gamma);
        for (double omega = 0.1; omega < 5; omega += 0.01) {
            CHECK(jonswap_energy(omega, 0.8, alpha, gamma) <= peak * (1 + 1e-12));
        }
        CHECK(ratio(peak, gamma * jonswap_energy(0.8, 0.8, alpha, 1)) < 1e-12);
        const double tail = jonswap_energy(4, 0.8, alpha, 1);
        CHECK(ratio(jonswap_energy(4, 0.8, alpha, gamma), tail) < 1e-9);
    }
    // gamma 1 is Pierson and Moskowitz's shape, over omega instead of f.
    const double shape = wind_sea_energy(1.1 / kTurn, 0.8 / kTurn, alpha) / kTurn;
    CHECK(ratio(jonswap_energy(1.1, 0.8, alpha, 1), shape) < 1e-12);
}

TEST_CASE("ocean_spectrum: under JONSWAP the wave height follows gamma and grows with fetch") {
    for (const double gamma : {1.0, 2.0, 3.3, 7.0}) {
        const double m0 = integrate_log(
            1e-2, 1e4, [&](double omega) { return jonswap_energy(omega, 0.8, 0.01, gamma); });
        // A fit of Yamaguchi 1984; 1/5 at gamma 1.
        const double density = 0.06533 * std::pow(gamma, 0.8015) + 0.13467;
        CHECK(ratio(m0, density * 0.01 * square(kGravity) / std::pow(0.8, 4)) < 0.01);
    }
    double last_height = 0;
    double last_peak = 100;
    for (const float fetch : {2e3f, 1e4f, 5e4f, 2e5f}) {
        const OceanEnergy sea = make_ocean_energy(
            {.spectrum = OceanSpectrum::Jonswap, .wind_speed = 12, .fetch = fetch});
        const double m0 =
            integrate_log(1e-2, 1e4, [&](double omega) { return frequency_energy(sea, omega); });
        CHECK(4 * std::sqrt(m0) > last_height);
        CHECK(sea.peak < last_peak);
        last_height = 4 * std::sqrt(m0);
        last_peak = sea.peak;
    }
    const OceanEnergy sea =
        make_ocean_energy({.spectrum = OceanSpectrum::Jonswap, .wind_speed = 10, .fetch = 1e5f});
    CHECK(ratio(sea.peak, 1.0081737) < 1e-6);
    CHECK(ratio(sea.alpha, 0.010061122) < 1e-6);
}

TEST_CASE("ocean_spectrum: Phillips' integral is alpha L^2 / 4, its peak at k L = sqrt(2/3)") {
    for (const double wind : {4.0, 10.0, 30.0}) {
        const double length = square(wind) / kGravity;
        const double sum = integrate_log(
            1e-2 / length, 1e5 / length, [&](double k) { return phillips_energy(k, wind); });
        CHECK(ratio(sum, 0.25 * kPhillipsConstant * square(length)) < 1e-7);
        const double peak = phillips_energy(std::sqrt(2.0 / 3.0) / length, wind);
        for (double k = 0.05 / length; k < 20 / length; k *= 1.01) {
            CHECK(phillips_energy(k, wind) <= peak);
        }
    }
    CHECK(phillips_energy(0, 10) == 0);
    CHECK(phillips_energy(1e-9, 10) == 0);
}

TEST_CASE("ocean_spectrum: finite depth takes energy from long waves (TMA)") {
    for (const double depth : {1.0, 10.0, 200.0}) {
        const double unit = std::sqrt(kGravity / depth);  // omega where omega sqrt(h / g) = 1
        double last = 0;
        for (double x = 0.05; x < 6; x += 0.05) {
            const double factor = depth_factor(x * unit, depth);
            CHECK(factor > last);
            CHECK(factor <= 1);
            last = factor < 1 - 1e-9 ? factor : last;
            // The parabolas of Thompson and Vincent 1983.
            const double fit = x < 1 ? 0.5 * x * x : x < 2 ? 1 - 0.5 * square(2 - x) : 1.0;
            CHECK(std::abs(factor - fit) < 0.045);
        }
        CHECK(depth_factor(10 * unit, depth) == test::near(1).epsilon(1e-9).scale(0));
        CHECK(ratio(depth_factor(0.01 * unit, depth), 0.5e-4) < 1e-3);
    }
    CHECK(depth_factor(0, 10) == 0);
    const Ocean ocean = {.spectrum = OceanSpectrum::Tma, .depth = 8};
    Ocean deep = ocean;
    deep.depth = 12000;
    const OceanEnergy shallow_sea = make_ocean_energy(ocean);
    const OceanEnergy deep_sea = make_ocean_energy(deep);
    const double omega = shallow_sea.peak;
    CHECK(
        frequency_energy(shallow_sea, omega)
        == test::near(frequency_energy(deep_sea, omega) * depth_factor(omega, 8)));
}

TEST_CASE(
    "ocean_spectrum: the energy over wave numbers equals that over frequencies"
    * technique("water.ocean-spectrum")) {
    for (const OceanSpectrum spectrum : kSpectra) {
        for (const float depth : {3.0f, 5000.0f}) {
            const OceanEnergy sea = make_ocean_energy(
                {.spectrum = spectrum,
                 .spreading = OceanSpreading::CosineSquared,
                 .wind_speed = 8,
                 .wind_direction = 0.4f,
                 .depth = depth});
            // Rings of wave numbers; eight directions are exact for cos^2.
            const double over_numbers = integrate_log(1e-3, 1e3, [&](double k) {
                double ring = 0;
                for (int i = 0; i < 8; ++i) {
                    const double theta = kTurn * i / 8;
                    ring += wave_energy(sea, k * std::cos(theta), k * std::sin(theta));
                }
                return k * ring * kTurn / 8;
            });
            const double low = wave_frequency(1e-3, sea.depth);
            const double high = wave_frequency(1e3, sea.depth);
            const double over_frequencies = integrate_log(
                low, high, [&](double omega) { return frequency_energy(sea, omega); });
            CAPTURE(static_cast<int>(spectrum));
            CAPTURE(depth);
            CHECK(ratio(over_numbers, over_frequencies) < 1e-4);
        }
    }
}

TEST_CASE(
    "ocean_spectrum: summed over the grid of a patch it is m0, less the waves that do not fit"
    * technique("water.fft-synthesis")) {
    const OceanEnergy sea = wind_sea_of_peak(0.2);
    CHECK(ratio(sum_of_grid(sea, 256, 200), 0.062462) < 1e-5);
    CHECK(ratio(sum_of_grid(sea, 128, 200), 0.062155) < 1e-5);
    CHECK(ratio(sum_of_grid(sea, 64, 100), 0.061618) < 1e-5);
}

TEST_CASE(
    "ocean_spectrum: without wind there is no energy and no NaN"
    * technique("water.ocean-spectrum")) {
    for (const OceanSpectrum spectrum : kSpectra) {
        for (const OceanSpreading spreading : kSpreadings) {
            for (const float wind : {0.0f, 1e-6f, 0.1f, 60.0f, 1e6f}) {
                const OceanEnergy sea = make_ocean_energy(
                    {.spectrum = spectrum, .spreading = spreading, .wind_speed = wind});
                for (const double k : {0.0, 1e-12, 1e-3, 1.0, 1e3, 1e9}) {
                    const double energy = wave_energy(sea, k, -0.5 * k);
                    CHECK(std::isfinite(energy));
                    CHECK(energy >= 0);
                    CHECK((wind > 0 || energy == 0));
                    CHECK((k > 0 || energy == 0));
                }
            }
        }
    }
}

}  // namespace limn::ocean_spectrum_test
