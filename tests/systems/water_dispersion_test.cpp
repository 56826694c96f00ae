#include "systems/water/water_dispersion.h"
#include "tests/near.h"

#include <doctest/doctest.h>

namespace limn::water_dispersion_test {
namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr double kDeep = 1e4;

double number_of_length(double length) {
    return kTwoPi / length;
}

/// Of waves that pass every 5 seconds.
double length_at(double depth) {
    return kTwoPi / wave_number(kTwoPi / 5.0, depth);
}

}  // namespace

TEST_CASE("water_dispersion: in deep water the speed grows with the root of the wavelength") {
    CHECK(phase_speed(number_of_length(1), kDeep) == test::near(1.249524).epsilon(1e-6).scale(0));
    CHECK(phase_speed(number_of_length(10), kDeep) == test::near(3.951342).epsilon(1e-6).scale(0));
    CHECK(
        phase_speed(number_of_length(100), kDeep) == test::near(12.495239).epsilon(1e-6).scale(0));
    const double k = number_of_length(10);
    CHECK(k == test::near(0.628319).epsilon(1e-6).scale(0));
    CHECK(kTwoPi / wave_frequency(k, kDeep) == test::near(2.530786).epsilon(1e-6).scale(0));
    CHECK(group_speed(k, kDeep) == test::near(0.5 * phase_speed(k, kDeep)).epsilon(1e-12).scale(0));
    CHECK(
        wave_frequency(k, INFINITY) == test::near(std::sqrt(kGravity * k)).epsilon(1e-14).scale(0));
}

TEST_CASE("water_dispersion: waves of one period get shorter and slower over shoals") {
    CHECK(length_at(1000) == test::near(39.0327).epsilon(1e-5).scale(0));
    CHECK(length_at(1000) / 5 == test::near(7.80655).epsilon(1e-5).scale(0));
    CHECK(length_at(20) / 5 == test::near(7.78213).epsilon(1e-5).scale(0));
    CHECK(length_at(5) == test::near(30.3092).epsilon(1e-5).scale(0));
    CHECK(length_at(5) / 5 == test::near(6.06185).epsilon(1e-5).scale(0));
    CHECK(length_at(1) == test::near(15.2393).epsilon(1e-5).scale(0));
    CHECK(length_at(1) / 5 == test::near(3.04787).epsilon(1e-5).scale(0));
    double last = 0;
    for (double depth = 0.01; depth < 30; depth *= 1.1) {
        const double speed = length_at(depth) / 5;
        CHECK(speed > last);
        last = speed;
    }
}

TEST_CASE("water_dispersion: in very shallow water all waves have the speed sqrt(g h)") {
    CHECK(phase_speed(number_of_length(10), 10) == test::near(3.951328).epsilon(1e-6).scale(0));
    CHECK(phase_speed(number_of_length(100), 1) == test::near(3.130034).epsilon(1e-6).scale(0));
    const double limit = std::sqrt(kGravity * 1.0);
    CHECK(limit == test::near(3.132092).epsilon(1e-6).scale(0));
    CHECK(phase_speed(number_of_length(1e5), 1) == test::near(limit).epsilon(1e-8).scale(0));
    CHECK(group_speed(number_of_length(1e5), 1) == test::near(limit).epsilon(1e-8).scale(0));
    CHECK(phase_speed(0, 1) == test::near(limit).epsilon(1e-12).scale(0));
    CHECK(group_speed(0, 1) == test::near(limit).epsilon(1e-12).scale(0));
}

TEST_CASE("water_dispersion: the wave number of a frequency inverts the frequency") {
    for (double depth = 1e-3; depth < 1e5; depth *= 3) {
        for (double omega = 1e-3; omega < 100; omega *= 1.7) {
            CAPTURE(depth);
            CAPTURE(omega);
            const double k = wave_number(omega, depth);
            CHECK(std::abs(wave_frequency(k, depth) / omega - 1) < 1e-12);
        }
    }
}

TEST_CASE("water_dispersion: the group speed is the derivative of the frequency") {
    for (double depth = 0.1; depth < 1000; depth *= 4) {
        for (double k = 1e-3; k < 30; k *= 2) {
            CAPTURE(depth);
            CAPTURE(k);
            const double step = 1e-4 * k;
            const double slope =
                (wave_frequency(k + step, depth) - wave_frequency(k - step, depth)) / (2 * step);
            CHECK(std::abs(group_speed(k, depth) / slope - 1) < 1e-6);
        }
    }
}

TEST_CASE("water_dispersion: on land speeds are 0, and no input gives NaN") {
    CHECK(wave_frequency(1, 0) == 0);
    CHECK(wave_frequency(1, -3) == 0);
    CHECK(wave_frequency(0, 10) == 0);
    CHECK(phase_speed(1, -3) == 0);
    CHECK(group_speed(1, 0) == 0);
    CHECK(wave_number(0, 10) == 0);
    CHECK(std::isinf(wave_number(1, 0)));
    CHECK(phase_speed(1e6, 1e6) > 0);
    CHECK(group_speed(1e6, 1e6) == test::near(0.5 * phase_speed(1e6, 1e6)));
}

}  // namespace limn::water_dispersion_test
