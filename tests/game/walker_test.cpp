#include "content/game/game.h"
#include "content/game/walker.h"
#include "content/game/walker_system.h"
#include "ecs/components/camera.h"
#include "ecs/components/water_ripples.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"
#include "systems/update_world.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace limn::walker_test {

namespace {

constexpr float kStep = 1.0f / 60;

Ground slab(const Vec3& center, const Vec3& half) {
    return make_ground({.half = half}, affine_from(center, {1, 0, 0, 0}, Vec3(1)));
}

/// A terrace at y = 0 for z > 0; five steps of 0.32 m down to a floor 1.6 m below, at z < -2.
struct Pool {
    std::vector<Ground> grounds;
    WaterSurface water{
        .frame = {.origin = {0, -0.1f, -10}}, .water = {.size = {20, 20}, .depth = 1.5f}};
    Walker settings{};
    WalkerState walker{};
    Vec3 feet = {0, 0, 2};
    MoveInput input{};

    Pool() {
        grounds.push_back(slab({0, -1, 5}, {10, 1, 5}));
        for (int i = 1; i < 5; ++i) {
            const auto k = static_cast<float>(i);
            grounds.push_back(slab({0, -0.32f * k - 2, 0.25f - 0.5f * k}, {10, 2, 0.25f}));
        }
        grounds.push_back(slab({0, -2.6f, -15}, {10, 1, 15}));
    }
    void run(float seconds) {
        for (int i = 0; i < static_cast<int>(seconds / kStep); ++i) {
            step_walker(grounds, {&water, 1}, input, kStep, settings, walker, feet);
        }
    }
};

}  // namespace

TEST_CASE("walker: stands still without input") {
    Pool pool;
    pool.run(3);
    CHECK(pool.feet == Vec3(0, 0, 2));
    CHECK(pool.walker.grounded);
    CHECK(pool.walker.depth < 0);
}

TEST_CASE("walker: walks at full speed on land, in the direction of view") {
    Pool pool;
    pool.walker.yaw = -kPi / 2;  // to the right: +x
    pool.input.move = {0, 0, 1};
    pool.run(1);
    const float before = pool.feet.x;
    pool.run(1);
    CHECK(pool.feet.x - before == test::near(pool.settings.speed).epsilon(0.02));
    CHECK(std::abs(pool.feet.z - 2) < 1e-3f);
    pool.input.move = {1, 0, 0};  // right of +x is +z
    pool.run(0.5f);
    CHECK(pool.feet.z > 2.3f);
}

TEST_CASE("walker: descends the steps, slower in deeper water, until its eyes are under") {
    Pool pool;
    pool.input.move = {0, 0, 1};
    float highest = pool.feet.y;
    float fall = 0;
    for (int i = 0; i < 60 * 8; ++i) {
        const float before = pool.feet.y;
        pool.run(kStep * 1.5f);
        highest = std::max(highest, pool.feet.y);
        fall = std::max(fall, before - pool.feet.y);
    }
    CHECK(highest < 1e-3f);
    CHECK(fall < 0.1f);  // never drops a whole step at once
    CHECK(pool.feet.y == test::near(-1.6).epsilon(0.01));
    CHECK(pool.walker.depth == test::near(1.5).epsilon(0.02));
    CHECK(glm::length(pool.walker.velocity) < 0.45f * pool.settings.speed);
    pool.input.move = {0, -1, 0};
    pool.run(2);
    CHECK(pool.walker.duck > 0.95f);  // its head under water
    CHECK(pool.feet.y == test::near(-1.6).epsilon(0.01));
    // And up again.
    pool.input.move = {0, 0, -1};
    for (int i = 0; i < 60 * 14 && pool.feet.z < 1.5f; ++i) {
        pool.run(1.5f * kStep);
    }
    CHECK(std::abs(pool.feet.y) < 0.05f);
    CHECK(pool.walker.duck < 0.01f);
    CHECK(pool.feet.z > 1);
}

TEST_CASE("walker: a wall stops it, and it slides along") {
    Pool pool;
    pool.grounds.push_back(slab({0, 1, 5}, {10, 2, 0.5f}));
    pool.walker.yaw = kPi;  // toward +z
    pool.input.move = {0.5f, 0, 1};
    pool.run(3);
    CHECK(pool.feet.z == test::near(4.5f - pool.settings.radius).epsilon(0.01));
    CHECK(pool.feet.x < -1);  // its right
    CHECK(pool.feet.y == test::near(0).scale(1).epsilon(0.001));
}

TEST_CASE("walker: swims in deep water with its eyes above the surface, and dives on input") {
    Pool pool;
    pool.water.water.depth = 0;  // deep
    pool.grounds.clear();
    pool.feet = {0, 1, -10};
    pool.run(20);
    const float eyes = pool.feet.y + pool.settings.eye;
    CHECK(eyes > -0.1f);
    CHECK(eyes < 0.15f);
    pool.input.move = {0, -1, 0};
    pool.run(3);
    CHECK(pool.feet.y + pool.settings.eye < -2);
    pool.input.move = {0, 1, 0};
    pool.run(6);
    CHECK(pool.feet.y + pool.settings.eye > -0.1f);
    CHECK(pool.feet.y + pool.settings.eye < 0.2f);
}

TEST_CASE("walker: falls no faster in water than it sinks") {
    Pool pool;
    pool.feet = {0, 3, -10};
    float deepest_speed = 0;
    for (int i = 0; i < 240; ++i) {
        pool.run(kStep * 1.5f);
        if (pool.walker.depth > 1.3f) {
            deepest_speed = std::min(deepest_speed, pool.walker.velocity.y);
        }
    }
    CHECK(deepest_speed > -3);
    CHECK(std::abs(pool.feet.y + pool.settings.eye) < 0.1f);  // and swims then
}

TEST_CASE("walker: NaN and infinite input moves nobody") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Pool pool;
    pool.input.move = {nan, 0, 1};
    pool.input.look = {nan, 0};
    pool.run(1);
    CHECK(pool.feet == Vec3(0, 0, 2));
    pool.input = {};
    pool.walker.velocity = {nan, 0, 0};
    pool.run(1);
    CHECK(pool.feet == Vec3(0, 0, 2));
}

TEST_CASE("walker: in a world it obeys while its camera is active, and pushes the water") {
    register_game_components();
    World world;
    Schedule schedule = make_world_schedule(add_game_systems);
    world.create(
        Transform{.position = {0, -1, 0}}, WorldTransform{}, Footing{.half = {9, 0.5f, 9}});
    const Entity water = world.create(
        Transform{}, WorldTransform{}, Water{.size = {8, 8}, .depth = 0.5f},
        WaterRipples{.cell = 0.1f});
    const Entity walker = world.create(
        Transform{.position = {0, -0.5f, 2}},
        WaterTouch{.shape = TouchShape::Box, .half = {0.2f, 0.6f, 0.2f}, .offset = {0, 0.6f, 0}});
    const Entity eyes = world.create(Transform{}, Camera{.active = false}, Parent{walker});
    world.add(walker, Walker{.camera = eyes});
    start_world(world, add_game_systems);
    set_action(world.resource<Input>(), "walk_forward");
    for (int i = 0; i < 60; ++i) {
        step_world(world, schedule);
    }
    CHECK(world.get<Transform>(walker).position.z == test::near(2));
    world.get<Camera>(eyes).active = true;
    for (int i = 0; i < 60; ++i) {
        step_world(world, schedule);
    }
    CHECK(world.get<Transform>(walker).position.z < 1);
    CHECK(world.get<Transform>(eyes).position.y == test::near(1.5));
    float most = 0;
    for (const float height : world.get<RippleState>(water).height) {
        most = std::max(most, std::abs(height));
    }
    CHECK(most > 0.002f);
}

}  // namespace limn::walker_test
