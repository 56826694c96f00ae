#include "content/game/game.h"
#include "content/game/stone_system.h"
#include "content/game/stones.h"
#include "ecs/components/buoyancy.h"
#include "ecs/components/input.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "systems/update_world.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace limn::stones_test {

namespace {

/// Somebody at a pool, 2 m above its edge.
struct Poolside {
    explicit Poolside(const StoneThrower& thrower) {
        schedule = make_world_schedule(add_game_systems);
        pool = world.create(
            Transform{}, Water{.size = {12, 12}, .depth = 2}, WaterRipples{.cell = 0.1f});
        hand = world.create(Transform{}, thrower);
        start_world(world, add_game_systems);
    }
    void click_on(const Vec3& target, const Vec3& eye = {0, 2, 6.5f}) {
        world.resource<Input>() = {.click = true, .eye = eye, .pointing = target - eye};
        run(1);
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) {
            step_world(world, schedule);
        }
    }
    [[nodiscard]] int stones() {
        int count = 0;
        world.query<const ThrownStone>().each([&](const ThrownStone&) { ++count; });
        return count;
    }
    /// Where the water is highest or lowest.
    [[nodiscard]] Vec2 disturbed() {
        const RippleState& state = world.get<RippleState>(pool);
        const auto most =
            std::max_element(state.height.begin(), state.height.end(), [](float a, float b) {
                return std::abs(a) < std::abs(b);
            });
        const auto index = static_cast<int>(most - state.height.begin());
        const Vec2 cell(index % state.stride - 1, index / state.stride - 1);
        return std::abs(*most) < 1e-3f ? Vec2(std::numeric_limits<float>::infinity())
                                       : state.cell * (cell + 0.5f - 0.5f * Vec2(state.cells));
    }

    World world;
    Schedule schedule;
    Entity pool;
    Entity hand;
};

constexpr StoneThrower kSplashes = {.radius = 0.15f};
constexpr StoneThrower kStones = {.mesh = {0}, .material = {0}, .radius = 0.15f, .max_stones = 3};

}  // namespace

TEST_CASE("water stones: a click makes the water splash where the pointer is, once") {
    Poolside scene(kSplashes);
    scene.click_on({2, 0, -1});
    CHECK(glm::distance(scene.disturbed(), Vec2(2, -1)) < 0.3f);
    CHECK(scene.stones() == 0);
    CHECK(!scene.world.resource<Input>().click);
    scene.run(5);
    CHECK(scene.world.get<StoneThrowerState>(scene.hand).thrown == 1);
}

TEST_CASE("water stones: nothing is thrown beside the water, above it or too far away") {
    Poolside scene(kStones);
    scene.click_on({9, 0, 0});
    scene.click_on({0, 9, 0});
    scene.click_on({0, 0, 0}, {0, 90, 0});
    scene.world.resource<Input>() = {.click = true};  // at nothing
    scene.run(1);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    scene.world.resource<Input>() = {.click = true, .eye = {0, 2, 0}, .pointing = {0, nan, 0}};
    scene.run(1);
    scene.world.resource<Input>() = {.click = true, .eye = {nan, 2, 0}, .pointing = {0, -1, 0}};
    scene.run(1);
    scene.run(60);
    CHECK(scene.stones() == 0);
    CHECK(scene.world.get<StoneThrowerState>(scene.hand).thrown == 0);
    CHECK(std::isinf(scene.disturbed().x));
}

TEST_CASE("water stones: a stone flies, falls in where it was aimed at, and sinks") {
    Poolside scene(kStones);
    scene.click_on({-2, 0, 1});
    CHECK(scene.stones() == 1);
    scene.run(3);
    CHECK(std::isinf(scene.disturbed().x));  // still in flight
    int steps = 0;
    while (std::isinf(scene.disturbed().x) && steps < 120) {
        scene.run(1);
        ++steps;
    }
    CHECK(glm::distance(scene.disturbed(), Vec2(-2, 1)) < 0.45f);
    scene.run(60 * 5);
    float depth = 0;
    scene.world.query<const ThrownStone, const Transform>().each(
        [&](const ThrownStone&, const Transform& transform) { depth = -transform.position.y; });
    CHECK(depth == test::near(2 - 0.15).epsilon(0.01).scale(0));
}

TEST_CASE("water stones: the oldest are removed beyond the limit") {
    Poolside scene(kStones);
    for (int i = 0; i < 7; ++i) {
        scene.click_on({1, 0, static_cast<float>(i) * 0.3f});
    }
    scene.run(2);
    CHECK(scene.stones() == 3);
    std::uint32_t first = 100;
    scene.world.query<const ThrownStone>().each(
        [&](const ThrownStone& stone) { first = std::min(first, stone.number); });
    CHECK(first == 5);
    scene.world.get<StoneThrower>(scene.hand).max_stones = 0;
    scene.click_on({1, 0, 0});
    scene.run(2);
    CHECK(scene.stones() == 0);
}

TEST_CASE("water stones: a throw hits what it aims at") {
    const Vec3 from = {1, 2, 3};
    const Vec3 to = {-4, -1, 9};
    const Vec3 v = velocity_to_hit(from, to, 12);
    const float time = glm::distance(from, to) / 12;
    const Vec3 there = from + v * time - Vec3(0, 0.5f * 9.81f * time * time, 0);
    CHECK(glm::distance(there, to) < 1e-4f);
    CHECK(std::isfinite(velocity_to_hit(from, from, 12).y));
}

}  // namespace limn::stones_test
