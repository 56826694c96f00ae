#include "systems/water/water_dispersion.h"
#include "systems/water/water_refraction.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

namespace limn::water_refraction_test {

namespace {

constexpr float kPeriod = 5;
constexpr double kOmega = 2 * 3.14159265358979 / 5;

float number_at(float depth) {
    return static_cast<float>(wave_number(kOmega, static_cast<double>(depth)));
}

/// A beach: as deep as `depth_at` says of z.
template <typename Depth>
DepthGrid beach(int width, int length, float cell, Depth&& depth_at) {
    DepthGrid grid{.points = {width, length}, .cell = cell};
    for (int z = 0; z < length; ++z) {
        grid.depth.insert(
            grid.depth.end(), static_cast<std::size_t>(width),
            depth_at(static_cast<float>(z) * cell));
    }
    return grid;
}

/// From 40 m to 1 m, and so on.
float slope_of(float z) {
    return std::max(40 - 0.2f * z, 1.0f);
}

}  // namespace

TEST_CASE(
    "water refraction: over shallow water, waves of one period are slower and shorter"
    * technique("water.shallow-refraction")) {
    struct Case {
        double depth;
        double speed;
        double length;
    };
    for (const Case& c :
         {Case{1000, 7.80655, 39.0327}, Case{5, 6.06185, 30.3092}, Case{1, 3.04787, 15.2393}}) {
        const double k = wave_number(kOmega, c.depth);
        CHECK(std::abs(kOmega / k / c.speed - 1) < 1e-5);
        CHECK(std::abs(2 * 3.14159265358979 / k / c.length - 1) < 1e-5);
    }
    CHECK(std::abs(kOmega / wave_number(kOmega, 20) / 7.78213 - 1) < 1e-5);
    double last = 0;
    for (double depth = 0.05; depth < 30; depth *= 1.2) {
        const double speed = kOmega / wave_number(kOmega, depth);
        CHECK(speed > last);
        last = speed;
    }
}

TEST_CASE(
    "water refraction: crests turn toward the shore by Snell's law"
    * technique("water.shallow-refraction")) {
    CHECK(std::abs(degrees(snell_angle(radians(45), 1000, 1, kPeriod)) - 16.03f) < 0.005f);
    CHECK(
        degrees(snell_angle(radians(16.0272f), 1, 1000, kPeriod))
        == test::near(45).epsilon(1e-3).scale(0));
    CHECK(snell_angle(radians(80), 1, 1000, kPeriod) == test::near(kPi / 2));

    const DepthGrid grid = beach(201, 101, 2.5f, slope_of);
    const float from = radians(90 - 45);  // toward +z, and 45 degrees toward +x
    const std::vector<Vec2> ray = trace_wave_ray(grid, kPeriod, {20, 0}, from, 400, 0.5f);
    REQUIRE(ray.size() > 100);
    for (std::size_t i = 1; i + 1 < ray.size(); i += 20) {
        const Vec2 chord = ray[i + 1] - ray[i - 1];
        const float expected = snell_angle(radians(45), 40, slope_of(ray[i].y), kPeriod);
        CHECK(std::abs(std::atan2(chord.x, chord.y) - expected) < radians(0.3f));
    }
    const Vec2 last = ray[ray.size() - 1] - ray[ray.size() - 2];
    CHECK(degrees(std::atan2(last.x, last.y)) == test::near(16.03).epsilon(0.02).scale(0));
}

TEST_CASE(
    "water refraction: the phase of a train is the integral of its wave number"
    * technique("water.shallow-refraction")) {
    const DepthGrid grid = beach(41, 201, 1.25f, slope_of);
    for (const float angle : {0.0f, 25.0f, -40.0f}) {
        const WaveTrain train = refract_waves(grid, kPeriod, radians(90 - angle));
        // Along the shore k sin(angle) stays; across it the rest is added up.
        const double along = static_cast<double>(number_at(40) * std::sin(radians(angle)));
        double across = 0;
        CAPTURE(angle);
        for (int z = 0; z < 201; ++z) {
            for (const int x : {0, 17, 40}) {
                const double exact = along * 1.25 * x + across;
                CHECK(
                    std::abs(
                        static_cast<double>(train.phase[static_cast<std::size_t>(z * 41 + x)])
                        - exact)
                    < 0.01);
            }
            for (int part = 0; part < 50; ++part) {
                const float at =
                    1.25f * (static_cast<float>(z) + 0.02f * (static_cast<float>(part) + 0.5f));
                const double k = static_cast<double>(number_at(slope_of(at)));
                across += 1.25 / 50 * std::sqrt(k * k - along * along);
            }
        }
    }
}

TEST_CASE(
    "water refraction: over an even bottom a train stays plane, in any direction"
    * technique("water.shallow-refraction")) {
    const DepthGrid grid = beach(31, 24, 2, [](float) { return 8.0f; });
    const float k = number_at(8);
    for (int i = 0; i < 16; ++i) {
        const float direction = kPi / 8 * static_cast<float>(i) + 0.1f;
        const WaveTrain train = refract_waves(grid, kPeriod, direction);
        CAPTURE(i);
        for (int z = 0; z < 24; z += 5) {
            for (int x = 0; x < 31; x += 6) {
                const float exact = 2 * k
                                    * (std::cos(direction) * static_cast<float>(x)
                                       + std::sin(direction) * static_cast<float>(z));
                CHECK(std::abs(train.phase[static_cast<std::size_t>(z * 31 + x)] - exact) < 2e-3f);
            }
        }
    }
}

TEST_CASE(
    "water refraction: the wave number of a train is everywhere that of its depth"
    * technique("water.shallow-refraction")) {
    // Over a shoal, where nothing is even: |grad S| = k.
    DepthGrid grid{.points = {121, 121}, .cell = 1};
    for (int z = 0; z < 121; ++z) {
        for (int x = 0; x < 121; ++x) {
            const Vec2 from = Vec2(x, z) - Vec2(60, 70);
            grid.depth.push_back(
                20 - 14 * std::exp(-(from.x * from.x + from.y * from.y) / (2 * 30.0f * 30)));
        }
    }
    const WaveTrain train = refract_waves(grid, kPeriod, radians(90));
    double error2 = 0;
    int count = 0;
    for (int z = 10; z < 110; z += 3) {
        for (int x = 10; x < 110; x += 3) {
            const auto phase = [&](int i, int j) {
                return train.phase[static_cast<std::size_t>(j * 121 + i)];
            };
            const Vec2 slope = {
                0.5f * (phase(x + 1, z) - phase(x - 1, z)),
                0.5f * (phase(x, z + 1) - phase(x, z - 1))};
            const float k = train.number[static_cast<std::size_t>(z * 121 + x)];
            error2 += static_cast<double>(
                square(std::sqrt(slope.x * slope.x + slope.y * slope.y) / k - 1));
            ++count;
        }
    }
    CHECK(std::sqrt(error2 / count) < 0.01);
    // Crests bend about the shoal: over it they lag behind.
    CHECK(train.phase[119 * 121 + 60] > train.phase[119 * 121 + 2] + 0.2f);
}

TEST_CASE(
    "water refraction: on land there are no waves, and rays end"
    * technique("water.shallow-refraction")) {
    const DepthGrid grid = beach(21, 61, 1, [](float z) { return 3 - 0.1f * z; });
    const WaveTrain train = refract_waves(grid, kPeriod, radians(90));
    for (int z = 0; z < 61; ++z) {
        const auto at = static_cast<std::size_t>(z * 21 + 10);
        CHECK(train.amplitude[at] == (grid.depth[at] > 0 ? 1.0f : 0.0f));
        CHECK((train.number[at] > 0) == (grid.depth[at] > 0));
        CHECK(std::isfinite(train.phase[at]));
    }
    const std::vector<Vec2> ray = trace_wave_ray(grid, kPeriod, {10, 0}, radians(80), 200, 0.25f);
    REQUIRE(!ray.empty());
    CHECK(ray.back().y < 30.3f);
    CHECK(ray.back().y > 29);
    CHECK(trace_wave_ray(grid, kPeriod, {10, 50}, 0, 10, 1).empty());
    CHECK(trace_wave_ray(grid, kPeriod, {-1, 5}, 0, 10, 1).empty());
}

}  // namespace limn::water_refraction_test
