#include "ecs/base/air.h"
#include "tests/near.h"

#include <doctest/doctest.h>

#include <cmath>

namespace limn::air_test {
namespace {

using test::near;

double sine_of(double degrees) {
    return std::sin(degrees * 3.14159265358979323846 / 180);
}

}  // namespace

TEST_CASE("air: from space to the ground passes what 20,000 steps find") {
    struct Row {
        double zenith_angle;
        glm::dvec3 clear;
        glm::dvec3 hazy;  ///< haze 20
    };
    const Row rows[] = {
        {0, {0.9404, 0.8676, 0.7623}, {0.850, 0.784, 0.689}},
        {30, {0.9315, 0.8488, 0.7311}, {0.829, 0.755, 0.650}},
        {60, {0.8848, 0.7539, 0.5823}, {0.723, 0.616, 0.476}},
        {75, {0.7924, 0.5850, 0.3565}, {0.536, 0.396, 0.241}},
        {80, {0.7129, 0.4594, 0.2216}, {0.399, 0.257, 0.124}},
        {85, {0.5436, 0.2495, 0.0636}, {0.175, 0.080, 0.020}},
        {88, {0.3308, 0.0853, 0.0062}, {0.025, 0.006, 0.0005}}};
    for (const Row& row : rows) {
        CAPTURE(row.zenith_angle);
        const double sine = sine_of(90 - row.zenith_angle);
        const glm::dvec3 clear = air_transmittance(kGroundRadius, sine, 1);
        const glm::dvec3 hazy = air_transmittance(kGroundRadius, sine, 20);
        for (int c = 0; c < 3; ++c) {
            CHECK(std::abs(clear[c] - row.clear[c]) < 0.01 * row.clear[c] + 5e-5);
            CHECK(std::abs(hazy[c] - row.hazy[c]) < 0.01 * row.hazy[c] + 6e-4);
        }
    }
}

TEST_CASE("air: a path in two parts passes the product of the parts") {
    // Along one ray at 20 degrees: from the ground, and from where it is 12 km long.
    const double sine = sine_of(20);
    const double length = 12;
    const double radius = std::sqrt(
        kGroundRadius * kGroundRadius + length * length + 2 * kGroundRadius * length * sine);
    const double there = (kGroundRadius * sine + length) / radius;
    const glm::dvec3 whole = air_transmittance(kGroundRadius, sine, 3);
    const glm::dvec3 rest = air_transmittance(radius, there, 3);
    glm::dvec3 depth(0);
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
        const double t = length * (i + 0.5) / kSteps;
        const double r =
            std::sqrt(kGroundRadius * kGroundRadius + t * t + 2 * kGroundRadius * t * sine);
        depth += sample_air(r - kGroundRadius, 3).extinction * (length / kSteps);
    }
    for (int c = 0; c < 3; ++c) {
        CHECK(whole[c] == near(rest[c] * std::exp(-depth[c])).epsilon(1e-3));
    }
}

TEST_CASE("air: the Earth is in the way below the horizon, which is lower from higher up") {
    CHECK(air_transmittance(kGroundRadius, -1e-6, 1) == glm::dvec3(0));
    CHECK(air_transmittance(kGroundRadius, 0, 1).x == near(0.1064).epsilon(0.01));
    const double high = kGroundRadius + 10;  // its horizon is 3.2 degrees below the horizontal
    CHECK(air_transmittance(high, sine_of(-3), 1).x > 0.01);
    CHECK(air_transmittance(high, sine_of(-3.4), 1) == glm::dvec3(0));
    CHECK(air_transmittance(kGroundRadius, 1, 0).y > air_transmittance(kGroundRadius, 1, 1).y);
}

}  // namespace limn::air_test
