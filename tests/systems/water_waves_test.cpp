#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "systems/update_world.h"
#include "systems/water/water_dispersion.h"
#include "systems/water/water_wave_kernels.h"
#include "systems/water/water_wave_table.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace limn::water_waves_test {

namespace {

constexpr float kTurn = 2 * kPi;

WaveTable table_of(const WaterWaves& waves, double time, const Water& water = {}) {
    WaveTable table;
    fill_wave_table(water, waves, time, table);
    return table;
}
WaveTable table_of(const WaterWave& wave, double time, const Water& water = {}) {
    return table_of(WaterWaves{.waves = {wave}}, time, water);
}
float height_of(const WaveTable& table, const Vec2& at) {
    return evaluate_waves(table, at).offset.y;
}

/// Where the water at rest at `at` is.
Vec3 surface(const WaveTable& table, const Vec2& at) {
    return Vec3(at.x, 0, at.y) + evaluate_waves(table, at).offset;
}

/// The derivatives of offsets against central differences, in space and in time.
void check_derivatives(const WaterWaves& waves, const Vec2& at, double time, double tolerance) {
    const float h = 1e-2f;
    const WavePoint point = evaluate_waves(table_of(waves, time), at);
    const WaveTable table = table_of(waves, time);
    const auto at_offset = [&](const Vec2& step) {
        return evaluate_waves(table, at + step).offset;
    };
    const Vec3 by_x = (at_offset({h, 0}) - at_offset({-h, 0})) / (2 * h);
    const Vec3 by_z = (at_offset({0, h}) - at_offset({0, -h})) / (2 * h);
    const auto at_time = [&](double t) { return evaluate_waves(table_of(waves, t), at).offset; };
    const Vec3 by_time = (at_time(time + 0.005) - at_time(time - 0.005)) / 0.01f;
    for (int i = 0; i < 3; ++i) {
        CAPTURE(i);
        CHECK(std::abs(point.by_x[i] - by_x[i]) < tolerance);
        CHECK(std::abs(point.by_z[i] - by_z[i]) < tolerance);
        CHECK(std::abs(point.velocity[i] - by_time[i]) < 4 * tolerance);
    }
}

}  // namespace

TEST_CASE(
    "water waves: a wave of 10 m runs at 3.95 m/s, along its direction"
    * technique("water.travelling-wave")) {
    const WaterWave wave = {.amplitude = 0.3f, .length = 10, .direction = 0.6f};
    const WaveTable start = table_of(wave, 0);
    CHECK(glm::length(start.lines[0].k) == test::near(0.628319).epsilon(1e-5).scale(0));
    const double speed = 3.951342;
    CHECK(
        start.lines[0].frequency / glm::length(start.lines[0].k)
        == test::near(speed).epsilon(1e-5).scale(0));
    const Vec2 along = {std::cos(0.6f), std::sin(0.6f)};
    for (const double t : {0.5, 3.0, 1000.0}) {
        const WaveTable later = table_of(wave, t);
        for (const Vec2 at : {Vec2(0, 0), Vec2(3, -2), Vec2(-7.5f, 4)}) {
            const double distance = std::fmod(speed * t, 10.0);
            CHECK(
                std::abs(
                    height_of(later, at + static_cast<float>(distance) * along)
                    - height_of(start, at))
                < 4e-3f);
        }
    }
    // The period is 2.530786 s; in it nothing changes.
    CHECK(
        height_of(table_of(wave, 2.530786), {1, 2})
        == test::near(height_of(start, {1, 2})).epsilon(1e-4).scale(0));
}

TEST_CASE(
    "water waves: longer ones are faster, with the root of the length"
    * technique("water.travelling-wave")) {
    const auto speed = [](float length) {
        const WaveTable table = table_of(WaterWave{.length = length}, 0);
        return table.lines[0].frequency / glm::length(table.lines[0].k);
    };
    CHECK(speed(1) == test::near(1.249524).epsilon(1e-5).scale(0));
    CHECK(speed(100) == test::near(12.495239).epsilon(1e-5).scale(0));
}

TEST_CASE(
    "water waves: they are within their amplitude, periodic, with mean 0"
    * technique("water.travelling-wave")) {
    const WaterWave wave = {.amplitude = 0.3f, .length = 4, .direction = 1.1f, .phase = 0.4f};
    const WaveTable table = table_of(wave, 12.3);
    const Vec2 along = {std::cos(1.1f), std::sin(1.1f)};
    double sum = 0;
    float most = 0;
    for (int i = 0; i < 400; ++i) {
        const Vec2 at = 0.01f * static_cast<float>(i) * along;
        const float h = height_of(table, at);
        sum += static_cast<double>(h);
        most = std::max(most, std::abs(h));
        CHECK(h == test::near(height_of(table, at + 4.0f * along)).epsilon(1e-3).scale(0));
    }
    CHECK(std::abs(sum / 400) < 1e-5);
    CHECK(most <= 0.3f);
    CHECK(most > 0.2999f);
}

TEST_CASE(
    "water waves: slopes and velocity match the surface"
    * technique("water.gerstner, water.travelling-wave")) {
    const WaterWaves lines = {
        .waves = {
            {.amplitude = 0.3f, .length = 5, .direction = 0.7f, .sharpness = 0.8f},
            {.amplitude = 0.1f, .length = 3, .direction = -2, .phase = 1, .lean = 0.5f}}};
    const WaterWaves rings = {
        .radial =
            {{.center = {1, 2}, .amplitude = 0.2f, .length = 3, .fade_radius = 2},
             {.center = {-1, 0}, .amplitude = 0.1f, .length = 2, .inward = true}},
    };
    for (const Vec2 at : {Vec2(0.2f, 0.3f), Vec2(4, -3), Vec2(-6.1f, 7.7f)}) {
        for (const double time : {0.1, 7.77}) {
            check_derivatives(lines, at, time, 1e-3);
            check_derivatives(rings, at, time, 1e-3);
        }
    }
}

TEST_CASE("water waves: shallow water slows them down, in deep water depth is irrelevant") {
    const auto speed = [](float length, float depth) {
        const WaveTable table = table_of(WaterWave{.length = length}, 0, Water{.depth = depth});
        return table.lines[0].frequency / glm::length(table.lines[0].k);
    };
    CHECK(speed(10, 10) == test::near(3.951328).epsilon(1e-5).scale(0));
    CHECK(speed(100, 1) == test::near(3.130034).epsilon(1e-5).scale(0));
    CHECK(speed(10, 0) == test::near(3.951342).epsilon(1e-5).scale(0));
}

TEST_CASE(
    "water waves: circles run outward or inward, and are rotationally symmetric"
    * technique("water.radial-wave")) {
    for (const bool inward : {false, true}) {
        const RadialWave wave = {
            .center = {1, -2}, .amplitude = 0.2f, .length = 3, .inward = inward};
        const auto at_radius = [&](float r, float angle, double t) {
            return height_of(
                table_of(WaterWaves{.radial = {wave}}, t),
                wave.center + r * Vec2(std::cos(angle), std::sin(angle)));
        };
        CHECK(at_radius(0, 0, 0) == 0);
        const auto speed = static_cast<float>(wave_frequency(2.0943951, 1e9) / 2.0943951);
        for (const float r : {2.0f, 5.5f}) {
            CHECK(at_radius(r, 0.3f, 1) == test::near(at_radius(r, 4, 1)).epsilon(1e-4).scale(0));
            const float moved = r + (inward ? -speed : speed) * 0.25f;
            CHECK(
                at_radius(moved, 1, 1.25) == test::near(at_radius(r, 1, 1)).epsilon(1e-3).scale(0));
        }
    }
    // The gradient points straight out; there is none at the center.
    const WaveTable table = table_of(WaterWaves{.radial = {{.center = {1, -2}}}}, 0.3);
    const WavePoint point = evaluate_waves(table, {4, 2});
    CHECK(point.by_x.y * 4 == test::near(point.by_z.y * 3).epsilon(1e-4).scale(0));
    CHECK(evaluate_waves(table, {1, -2}).by_x.y == 0);
}

TEST_CASE(
    "water waves: circles fall off with the root of the distance beyond their radius"
    * technique("water.radial-wave")) {
    const RadialWave wave = {.amplitude = 0.2f, .length = 1, .fade_radius = 2};
    const WaveTable table = table_of(WaterWaves{.radial = {wave}}, 0);
    CHECK(height_of(table, {1.25f, 0}) == test::near(0.2).epsilon(1e-4).scale(0));
    CHECK(
        height_of(table, {8.25f, 0})
        == test::near(0.2 * std::sqrt(2 / 8.25)).epsilon(1e-4).scale(0));
}

TEST_CASE(
    "water waves: a drop's ring is 0 before its front and behind its tail"
    * technique("water.radial-packet")) {
    WavePacket drop = {
        .center = {0.5f, 0}, .length = 0.2f, .waves = 3, .decay = 0, .smooth = false};
    const auto height = [&](float age, float r) {
        drop.age = age;
        return height_of(table_of(WaterWaves{.packets = {drop}}, 0), {0.5f + r, 0});
    };
    const auto speed = static_cast<float>(wave_frequency(31.4159265, 1e9) / 31.4159265);
    for (float r = 0; r < 3; r += 0.01f) {
        CHECK(height(0, r) == 0);
        const float front = speed * 1.5f;
        const float h = height(1.5f, r);
        CHECK(std::abs(h) <= drop.amplitude);
        if (r > front || r < front - 0.6f) {
            CHECK(h == 0);
        }
        CHECK(height(drop.lifetime, r) == 0);
    }
    // A whole number of waves: the front and the end are level, so that there is no step.
    CHECK(std::abs(height(1.5f, speed * 1.5f - 1e-4f)) < 1e-4f);
    CHECK(std::abs(height(1.5f, speed * 1.5f - 0.6f + 1e-4f)) < 1e-4f);
    CHECK(std::abs(height(1.5f, speed * 1.5f - 0.05f)) > 0.9f * drop.amplitude);
}

TEST_CASE(
    "water waves: drops fade, age by the step, and are removed when they end"
    * technique("water.radial-packet")) {
    const WavePacket young = {.age = 0.5f, .decay = 0.5f, .smooth = false};
    const WaveTable table = table_of(WaterWaves{.packets = {young}}, 0);
    CHECK(table.rings[0].amplitude == test::near(0.02 * std::exp(-1.0)));
    World world;
    Schedule schedule = make_world_schedule();
    const Entity pond = world.create(
        Transform{}, Water{}, WaterWaves{.packets = {{.lifetime = 0.05f}, {.lifetime = 10}}});
    for (int i = 0; i < 6; ++i) {
        step_world(world, schedule);
    }
    REQUIRE(world.get<WaterWaves>(pond).packets.size() == 1);
    CHECK(world.get<WaterWaves>(pond).packets[0].age == test::near(0.1));
    CHECK(world.get<WaveTable>(pond).rings.size() == 1);
}

TEST_CASE(
    "water waves: smooth drops are continuous at both edges, with matching slopes"
    * technique("water.radial-packet")) {
    const WaterWaves waves = {.packets = {{.age = 1.9f, .length = 1, .waves = 2, .decay = 0}}};
    const WaveTable table = table_of(waves, 0);
    const WaveRing& ring = table.rings[0];
    for (const float edge : {ring.first, ring.last}) {
        CHECK(std::abs(evaluate_waves(table, {edge - 1e-3f, 0}).by_x.y) < 1e-3f);
        CHECK(std::abs(evaluate_waves(table, {edge + 1e-3f, 0}).by_x.y) < 1e-3f);
    }
    WaterWaves later = waves;
    later.packets[0].age += 1e-3f;
    const WaveTable after = table_of(later, 0);
    const float h = 1e-3f;
    for (float r = ring.first + 0.1f; r < ring.last - 0.1f; r += 0.13f) {
        const float slope = (height_of(table, {r + h, 0}) - height_of(table, {r - h, 0})) / (2 * h);
        CHECK(std::abs(evaluate_waves(table, {r, 0}).by_x.y - slope) < 1e-3f);
        const float rise = (height_of(after, {r, 0}) - height_of(table, {r, 0})) / 1e-3f;
        CHECK(std::abs(evaluate_waves(table, {r, 0}).velocity.y - rise) < 1e-3f);
    }
}

TEST_CASE(
    "water waves: a group is within its bounds, and reproducible by its seed"
    * technique("water.wave-sum")) {
    const WaveGroup group = {
        .count = 200, .length = {0.3f, 3}, .amplitude = {0.002f, 0.02f}, .direction = 2, .seed = 9};
    const std::vector<WaterWave> waves = generate_waves(group);
    REQUIRE(waves.size() == 200);
    float shortest = 1e9f;
    float longest = 0;
    for (const WaterWave& wave : waves) {
        CHECK((wave.length >= 0.3f && wave.length <= 3.0f));
        CHECK((wave.amplitude >= 0.002f && wave.amplitude <= 0.02f));
        CHECK(std::abs(wave.direction - 2) <= group.spread);
        shortest = std::min(shortest, wave.length);
        longest = std::max(longest, wave.length);
    }
    CHECK(longest - shortest > 2);
    const auto aside = std::count_if(
        waves.begin(), waves.end(), [](const WaterWave& wave) { return wave.direction < 2; });
    CHECK((aside > 70 && aside < 130));
    const std::vector<WaterWave> again = generate_waves(group);
    CHECK(again[77].phase == waves[77].phase);
    WaveGroup other = group;
    other.seed = 10;
    CHECK(generate_waves(other)[77].phase != waves[77].phase);
    other.count = 4000000000u;
    CHECK(generate_waves(other).size() == 256);
}

TEST_CASE(
    "water waves: waves add up, with the variance of half the sum of squares"
    * technique("water.wave-sum")) {
    const WaterWaves low = {.groups = {{.count = 4}}};
    const WaterWaves high = {
        .groups = {
            {.count = 16, .length = {0.3f, 3}, .amplitude = {0.002f, 0.02f}, .spread = 1.3f}}};
    const WaterWaves both = {.groups = {low.groups[0], high.groups[0]}};
    const WaveTable sums[] = {table_of(low, 3), table_of(high, 3), table_of(both, 3)};
    CHECK(sums[2].lines.size() == 20);
    float most = 0;
    double half_squares = 0;
    for (const WaveLine& line : sums[2].lines) {
        most += line.amplitude;
        half_squares += 0.5 * static_cast<double>(square(line.amplitude));
    }
    double mean = 0;
    double squares = 0;
    constexpr int kPoints = 100000;
    for (int i = 0; i < kPoints; ++i) {
        // A lattice without common measure with the waves (R2, Roberts 2018), over 2 km.
        const auto n = static_cast<double>(i);
        const Vec2 at(
            2000 * std::fmod(0.7548776662466927 * n, 1.0),
            2000 * std::fmod(0.5698402909980532 * n, 1.0));
        const float h = height_of(sums[2], at);
        CHECK(std::abs(h) <= most);
        mean += static_cast<double>(h) / kPoints;
        squares += static_cast<double>(h * h) / kPoints;
        if (i % 1000 == 0) {
            CHECK(std::abs(h - height_of(sums[0], at) - height_of(sums[1], at)) < 1e-4f);
        }
    }
    CHECK(std::abs(mean) < 0.01 * std::sqrt(half_squares));
    CHECK(squares == test::near(half_squares).epsilon(0.05).scale(0));
}

TEST_CASE(
    "water waves: without sharpness water moves only vertically" * technique("water.gerstner")) {
    const WaveTable table = table_of(WaterWave{.sharpness = 0}, 1);
    const WavePoint point = evaluate_waves(table, {3, 4});
    CHECK(point.offset.x == 0);
    CHECK(point.offset.z == 0);
    CHECK(point.offset.y != 0);
}

TEST_CASE(
    "water waves: sharp ones are trochoids, the path of a point on a rolling wheel"
    * technique("water.trochoid")) {
    // Of a wheel of radius 1 / k, at A from the axle, turned upside down (water.trochoid).
    const float length = 10;
    const float amplitude = 0.9f;
    const WaveTable table =
        table_of(WaterWave{.amplitude = amplitude, .length = length, .sharpness = 1}, 0);
    const float a = length / kTurn;
    for (int i = 0; i < 50; ++i) {
        const float theta = 0.2f * static_cast<float>(i);
        // The wheel begins at the crest, which is a quarter of a wave from the origin.
        const Vec3 point = surface(table, {a * theta + length / 4, 0});
        CHECK(
            point.x - length / 4
            == test::near(a * theta - amplitude * std::sin(theta)).epsilon(1e-4));
        CHECK(point.y == test::near(amplitude * std::cos(theta)).epsilon(1e-4).scale(0));
    }
    // Crests are rounder than troughs by ((a + b) / (a - b))^2.
    const auto curvature = [&](float x) {
        const float h = 0.05f;
        const Vec3 left = surface(table, {x - h, 0});
        const Vec3 here = surface(table, {x, 0});
        const Vec3 right = surface(table, {x + h, 0});
        return std::abs(left.y + right.y - 2 * here.y) / square((right.x - left.x) / 2);
    };
    CHECK(
        curvature(length / 4) / curvature(3 * length / 4)
        == test::near(square((a + amplitude) / (a - amplitude))).epsilon(0.02).scale(0));
}

TEST_CASE(
    "water waves: sharpness keeps height and period, and concentrates points at crests"
    * technique("water.gerstner")) {
    const float a = 0.5f;
    const float k = kTurn / 10;
    for (const float q : {0.0f, 1.0f, 3.0f}) {
        const WaveTable table =
            table_of(WaterWave{.amplitude = a, .length = 10, .sharpness = q}, 0);
        CHECK(surface(table, {2.5f, 0}).y == test::near(a));
        CHECK(surface(table, {7.5f, 0}).y == test::near(-a));
        const float h = 0.01f;
        const auto gap = [&](float x) {
            return (surface(table, {x + h, 0}).x - surface(table, {x - h, 0}).x) / (2 * h);
        };
        CHECK(gap(2.5f) == test::near(1 - q * k * a).epsilon(1e-3).scale(0));
        CHECK(gap(7.5f) == test::near(1 + q * k * a).epsilon(1e-3).scale(0));
        CHECK(
            1 + evaluate_waves(table, {2.5f, 0}).by_x.x
            == test::near(1 - q * k * a).epsilon(1e-4).scale(0));
    }
}

TEST_CASE(
    "water waves: the sharpest are cusps, and any number of them never folds over"
    * technique("water.gerstner, water.trochoid")) {
    // Q = 3.183099 is the cusp of this wave.
    const WaveTable cusp =
        table_of(WaterWave{.amplitude = 0.5f, .length = 10, .sharpness = 3.183099f}, 0);
    CHECK(std::abs(1 + evaluate_waves(cusp, {2.5f, 0}).by_x.x) < 1e-5f);
    const WaveTable folded =
        table_of(WaterWave{.amplitude = 0.5f, .length = 10, .sharpness = 50}, 0);
    CHECK(std::abs(1 + evaluate_waves(folded, {2.5f, 0}).by_x.x) < 1e-5f);
    const WaterWaves many = {
        .groups = {{.count = 60, .length = {1, 9}, .amplitude = {0.1f, 0.3f}, .sharpness = 5}}};
    const WaveTable table = table_of(many, 1);
    for (int i = 0; i < 5000; ++i) {
        const Vec2 at(0.37f * static_cast<float>(i % 71), 0.41f * static_cast<float>(i / 71));
        const WavePoint p = evaluate_waves(table, at);
        CHECK((1 + p.by_x.x) * (1 + p.by_z.z) - p.by_x.z * p.by_z.x > -1e-4f);
    }
}

TEST_CASE("water waves: in a Gerstner wave water moves in circles" * technique("water.gerstner")) {
    const WaterWave wave = {.amplitude = 0.4f, .length = 10, .sharpness = 1};
    for (int i = 0; i < 24; ++i) {
        const Vec3 offset = evaluate_waves(table_of(wave, 2.530786 * i / 24), {1.3f, 0.7f}).offset;
        CHECK(glm::length(offset) == test::near(0.4).epsilon(1e-4).scale(0));
    }
    // Forward on the crest.
    CHECK(evaluate_waves(table_of(wave, 0), {2.5f, 0}).velocity.x > 0.9f);
}

TEST_CASE(
    "water waves: crests lean with the wind, and stay as high" * technique("water.wind-crest")) {
    const auto profile = [](float lean, float phase) {
        const WaveTable table =
            table_of(WaterWave{.amplitude = 1, .length = kTurn, .lean = lean}, 0);
        return height_of(table, {phase, 0});
    };
    for (float phase = 0; phase < kTurn; phase += 0.1f) {
        CHECK(profile(0, phase) == test::near(std::sin(phase)).epsilon(1e-4));
        if (phase > kPi) {
            CHECK(profile(0.3f, phase) == test::near(std::sin(phase)).epsilon(1e-4));
        }
    }
    CHECK(std::abs(profile(0.3f, 0)) < 1e-6f);
    CHECK(std::abs(profile(0.3f, kPi)) < 1e-5f);
    // The crest is where phase - lean sin(phase) is a right angle.
    float crest = kPi / 2;
    for (int i = 0; i < 50; ++i) {
        crest = kPi / 2 + 0.3f * std::sin(crest);
    }
    CHECK(crest > kPi / 2);
    CHECK(profile(0.3f, crest) == test::near(1));
    // Steeper in front, toward pi, than behind.
    CHECK(1 / (kPi - crest) > 1.3f / crest);
    // There is one crest, up to the most that it may lean.
    for (const float lean : {0.3f, 0.99f, 5.0f}) {
        int turns = 0;
        float last = 0;
        bool rising = true;
        for (float phase = 0.01f; phase < kPi; phase += 0.01f) {
            const float h = profile(lean, phase);
            turns += (h > last) != rising ? 1 : 0;
            rising = h > last;
            last = h;
        }
        CHECK(turns == 1);
    }
}

TEST_CASE(
    "water waves: batches equal single points, and SIMD equals scalar code"
    * technique("water.wave-sum")) {
    const WaterWaves waves = {
        .waves = {{.amplitude = 0.3f, .length = 7, .sharpness = 1, .lean = 0.4f}},
        .groups = {{.count = 20, .length = {0.5f, 20}, .sharpness = 0.7f}}};
    const WaveTable table = table_of(waves, 123.4);
    std::vector<float> x;
    std::vector<float> z;
    for (int i = 0; i < 77; ++i) {
        x.push_back(31.7f * std::sin(static_cast<float>(i)));
        z.push_back(-25.1f + 0.9f * static_cast<float>(i));
    }
    std::vector<float> found[3];
    std::vector<float> plain[3];
    for (int i = 0; i < 3; ++i) {
        found[i].resize(x.size());
        plain[i].resize(x.size());
    }
    sum_waves(table.lines, x, z, {found[0], found[1], found[2]});
    sum_waves_scalar(table.lines, x, z, {plain[0], plain[1], plain[2]});
    for (std::size_t i = 0; i < x.size(); ++i) {
        const Vec3 expected = evaluate_waves(table, {x[i], z[i]}).offset;
        for (int axis = 0; axis < 3; ++axis) {
            CHECK(found[axis][i] == plain[axis][i]);
            CHECK(std::abs(found[axis][i] - expected[axis]) < 2e-5f);
        }
    }
}

TEST_CASE("water waves: offset, derivatives and velocity are the same by SIMD and scalar code") {
    using Numbers = std::array<double, 12>;
    const auto numbers = [](const WavePoint& p) {
        Numbers all{};
        int i = 0;
        for (const Vec3& v : {p.offset, p.by_x, p.by_z, p.velocity}) {
            for (int axis = 0; axis < 3; ++axis) {
                all[static_cast<std::size_t>(i++)] = static_cast<double>(v[axis]);
            }
        }
        return all;
    };
    for (std::uint32_t count = 0; count < 10; ++count) {
        CAPTURE(count);
        const WaveTable table = table_of(
            {.waves = {{.amplitude = 0.3f, .length = 7, .sharpness = 1, .lean = 0.4f}},
             .groups = {{.count = count, .length = {2, 20}, .sharpness = 0.7f}}},
            12.3);
        const Vec2 at = {3.1f + static_cast<float>(count), -7.7f};
        Numbers expected{};
        for (const WaveLine& line : table.lines) {
            const glm::dvec2 k = line.k;
            const glm::dvec2 side = line.side;
            const double lean = static_cast<double>(line.lean);
            const double amplitude = static_cast<double>(line.amplitude);
            const double phase = glm::dot(k, glm::dvec2(at)) + static_cast<double>(line.phase);
            const double moved = phase - lean * std::max(std::sin(phase), 0.0);
            const double rate = std::sin(phase) > 0 ? 1 - lean * std::cos(phase) : 1.0;
            const double offset[3] = {
                side.x * std::cos(phase), amplitude * std::sin(moved), side.y * std::cos(phase)};
            const double by_phase[3] = {
                -side.x * std::sin(phase), amplitude * std::cos(moved) * rate,
                -side.y * std::sin(phase)};
            for (std::size_t i = 0; i < 3; ++i) {
                expected[i] += offset[i];
                expected[3 + i] += k.x * by_phase[i];
                expected[6 + i] += k.y * by_phase[i];
                expected[9 + i] -= static_cast<double>(line.frequency) * by_phase[i];
            }
        }
        const Numbers found = numbers(sum_lines(table.lines, at));
        const Numbers plain = numbers(sum_lines_scalar(table.lines, at));
        for (std::size_t i = 0; i < expected.size(); ++i) {
            CAPTURE(i);
            CHECK(found[i] == plain[i]);
            CHECK(std::abs(found[i] - expected[i]) < 1e-5);
        }
    }
}

TEST_CASE("water waves: far from the origin, where phases are large, SIMD is as accurate") {
    const WaveTable table = table_of(WaterWave{.amplitude = 1, .length = 3}, 0);
    std::vector<float> x;
    for (int i = 0; i < 64; ++i) {
        x.push_back(3000.0f + 1.7f * static_cast<float>(i));
    }
    const std::vector<float> z(x.size());
    std::vector<float> found[3] = {z, z, z};
    sum_waves(table.lines, x, z, {found[0], found[1], found[2]});
    for (std::size_t i = 0; i < x.size(); ++i) {
        const WaveLine& line = table.lines[0];
        const float phase = (line.k.x * x[i] + line.k.y * z[i]) + line.phase;
        const double expected = std::sin(static_cast<double>(phase));
        CHECK(std::abs(static_cast<double>(found[1][i]) - expected) < 1e-5);
    }
}

TEST_CASE("water waves: invalid waves are skipped") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const WaterWaves bad = {
        .waves =
            {{.length = 0},
             {.length = -3},
             {.amplitude = nan},
             {.direction = nan},
             {.sharpness = nan}},
        .radial = {{.length = 0}, {.center = {nan, 0}}},
        .packets = {{.age = 1, .length = 0}, {.age = nan}}};
    const WaveTable table = table_of(bad, 1);
    CHECK(table.lines.empty());
    CHECK(table.rings.empty());
    CHECK(height_of(table, {0, 0}) == 0);
}

}  // namespace limn::water_waves_test
