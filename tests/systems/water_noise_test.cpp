#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "systems/update_world.h"
#include "systems/water/water_noise_system.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <limits>
#include <random>

namespace limn::water_noise_test {

TEST_CASE(
    "water noise: it is 0 at integer points, and within 1.04" * technique("water.noise-surface")) {
    for (int i = 0; i < 1000; ++i) {
        CHECK(perlin_noise({i % 10 - 5, i / 10 % 10 - 5, i / 100}, 7) == 0);
    }
    std::mt19937 random(1);
    std::uniform_real_distribution<float> place(-100, 100);
    float most = 0;
    double sum = 0;
    constexpr int kSamples = 100000;
    for (int i = 0; i < kSamples; ++i) {
        const float n = perlin_noise({place(random), place(random), place(random)}, 7);
        most = std::max(most, std::abs(n));
        sum += static_cast<double>(n);
    }
    CHECK(most <= 1.04f);
    CHECK(most > 0.75f);
    CHECK(std::abs(sum / kSamples) < 0.02);
}

TEST_CASE(
    "water noise: it and its slope are continuous, also at cell borders"
    * technique("water.noise-surface")) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> unit(0, 1);
    constexpr float kH = 1e-3f;
    for (int i = 0; i < 500; ++i) {
        Vec3 at = {unit(random), unit(random), unit(random)};
        at[i % 3] = 2;  // on a border
        Vec3 step(0);
        step[i % 3] = kH;
        const float here = perlin_noise(at, 3);
        const float before = (here - perlin_noise(at - step, 3)) / kH;
        const float after = (perlin_noise(at + step, 3) - here) / kH;
        CHECK(std::abs(here - perlin_noise(at - step, 3)) < 3 * kH);
        CHECK(std::abs(after - before) < 0.02f);
    }
}

TEST_CASE("water noise: each octave is half as high, twice as fine and twice as fast") {
    NoiseSurface one;
    one.octaves = 1;
    NoiseSurface two = one;
    two.octaves = 2;
    NoiseSurface next = one;
    next.seed += 1;
    next.amplitude *= 0.5f;
    next.frequency *= 2;
    next.speed *= 2;
    for (int i = 0; i < 50; ++i) {
        const Vec2 at = {0.37f * static_cast<float>(i), std::sin(static_cast<float>(i))};
        const double time = 0.11 * i;
        const float sum = noise_height(one, at, time) + noise_height(next, at, time);
        CHECK(noise_height(two, at, time) == test::near(sum).epsilon(1e-5));
    }
}

TEST_CASE(
    "water noise: heights are within their bounds, and normals point up"
    * technique("water.noise-surface")) {
    HeightField field;
    fill_noise_field({}, 2.5, field);
    REQUIRE(field.points == 65);
    REQUIRE(field.height.size() == 65 * 65);
    float low = 1;
    float high = -1;
    for (std::size_t i = 0; i < field.height.size(); ++i) {
        CHECK(field.height[i] >= field.low);
        CHECK(field.height[i] <= field.low + field.range + 1e-7f);
        CHECK(glm::length(field.normal[i]) == test::near(1));
        CHECK(field.normal[i].y > 0);
        low = std::min(low, field.height[i]);
        high = std::max(high, field.height[i]);
    }
    CHECK(low == field.low);
    CHECK(high - low == field.range);
    CHECK(field.range > 0.05f);
    CHECK(field.range < 2 * 1.04f * 0.15f);
}

TEST_CASE(
    "water noise: normals match the heights of the neighboring points"
    * technique("water.noise-surface")) {
    const NoiseSurface noise = {.size = {4, 8}, .points = 33, .amplitude = 0.4f};
    HeightField field;
    fill_noise_field(noise, 1.0, field);
    for (const IVec2 point : {IVec2(16, 16), IVec2(0, 0), IVec2(32, 5), IVec2(7, 32)}) {
        const Vec2 at = Vec2(point) * Vec2(4.0f / 32, 8.0f / 32) - Vec2(2, 4);
        const auto slope = [&](const Vec2& step) {
            return (noise_height(noise, at + step, 1) - noise_height(noise, at - step, 1))
                   / (2 * glm::length(step));
        };
        const Vec3 normal = glm::normalize(Vec3(-slope({4.0f / 32, 0}), 1, -slope({0, 8.0f / 32})));
        const auto i = static_cast<std::size_t>(point.y * 33 + point.x);
        CHECK(field.height[i] == test::near(noise_height(noise, at, 1)));
        CHECK(glm::distance(field.normal[i], normal) < 1e-4f);
    }
}

TEST_CASE(
    "water noise: the same time gives the same field, another time another"
    * technique("water.noise-surface")) {
    HeightField a;
    HeightField b;
    fill_noise_field({}, 3.0, a);
    fill_noise_field({}, 3.0, b);
    CHECK(a.height == b.height);
    fill_noise_field({}, 3.1, b);
    CHECK(a.height != b.height);
    fill_noise_field({.seed = 2}, 3.0, b);
    CHECK(a.height != b.height);
}

TEST_CASE("water noise: invalid settings give a level surface") {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    for (const NoiseSurface& noise :
         {NoiseSurface{.size = {0, 0}, .points = 0}, NoiseSurface{.amplitude = kNan},
          NoiseSurface{.octaves = 0}}) {
        HeightField field;
        fill_noise_field(noise, 1, field);
        CHECK(field.range == 0);
        CHECK(field.normal[0] == Vec3(0, 1, 0));
    }
    CHECK(std::isfinite(noise_height({.frequency = 1e30f}, {3, 4}, 1e12)));
    CHECK(noise_height({}, {kNan, 0}, 1) == 0);
}

TEST_CASE("water noise: a world animates its surfaces") {
    World world;
    Schedule schedule = make_world_schedule();
    const Entity pool = world.create(Transform{}, NoiseSurface{.points = 9});
    start_world(world);
    CHECK(world.get<HeightField>(pool).height.size() == 81);
    step_world(world, schedule);
    const std::vector<float> before = world.get<HeightField>(pool).height;
    step_world(world, schedule);
    CHECK(world.get<HeightField>(pool).height != before);
}

}  // namespace limn::water_noise_test
