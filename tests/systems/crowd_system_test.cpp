#include "ecs/base/jobs.h"
#include "ecs/components/all.h"
#include "ecs/components/flock.h"
#include "ecs/snapshot.h"
#include "ecs/world.h"
#include "systems/crowd/crowd_places.h"
#include "systems/crowd/crowd_system.h"
#include "systems/update_world.h"
#include "tests/near.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace limn::crowd_system_test {

namespace {

struct Plaza {
    World world;
    Schedule schedule = make_world_schedule();

    Entity walker(const Vec3& position, const CrowdGoal& goal = {}, const CrowdAgent& agent = {}) {
        return world.create(Transform{.position = position}, agent, goal);
    }
    Entity exit(const Vec3& position, const CrowdExit& exit = {}) {
        return world.create(Transform{.position = position}, exit);
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) {
            step_world(world, schedule);
        }
    }
    Vec3 position(Entity entity) { return world.get<Transform>(entity).position; }
    Vec3 front(Entity entity) { return world.get<Transform>(entity).rotation * Vec3(0, 0, 1); }
};

/// Two streams that cross around a pillar, a flock, and a walker of a wall's other side.
void fill_plaza(Plaza& plaza) {
    const Entity space = plaza.world.create(Transform{}, CrowdSpace{.size = {30, 30}});
    plaza.world.create(Transform{}, CrowdObstacle{.size = {2, 2}, .round = true});
    const Entity east = plaza.exit({12, 0, 0});
    const Entity west = plaza.exit({-12, 0, 0}, {.next = east});
    plaza.world.get<CrowdExit>(east).next = west;
    for (int i = 0; i < 40; ++i) {
        const auto k = static_cast<float>(i);
        plaza.walker(
            {-5 - 0.7f * std::floor(k / 4), 0, std::fmod(k, 4.0f) - 1.5f},
            {.exit = i % 2 == 0 ? east : west});
    }
    const Entity flock = plaza.world.create(Transform{}, FlockParams{.planar = true});
    for (int i = 0; i < 20; ++i) {
        plaza.world.create(
            Transform{.position = {0.3f * static_cast<float>(i), 0, 20}}, Boid{flock});
    }
    plaza.world.get<Transform>(space).position.x = 0.5f;
}

std::vector<std::uint64_t> plaza_hashes(int threads) {
    set_thread_count(threads);
    Plaza plaza;
    fill_plaza(plaza);
    std::vector<std::uint64_t> hashes;
    for (int i = 0; i < 90; ++i) {
        plaza.run(1);
        hashes.push_back(state_hash(plaza.world));
    }
    set_thread_count(0);
    return hashes;
}

}  // namespace

TEST_CASE("crowd system: a walker goes to its point, turns smoothly, and stops there") {
    Plaza plaza;
    const Entity walker =
        plaza.walker({1, 2, 0}, {.point = {5, 0, 0}}, {.speed = 1, .turn_speed = 2});
    Vec3 front = plaza.front(walker);
    for (int i = 0; i < 360; ++i) {
        plaza.run(1);
        const Vec3 now = plaza.front(walker);
        REQUIRE(glm::dot(now, front) > std::cos(2.1f / 60));
        REQUIRE(now.y == 0);
        front = now;
        if (i == 59) {
            CHECK(plaza.position(walker).x == test::near(2).epsilon(0.02));
        }
    }
    CHECK(glm::distance(plaza.position(walker), Vec3(5, 2, 0)) < 0.31f);
    CHECK(front.x == test::near(1));
    CHECK(plaza.world.get<CrowdState>(walker).velocity == Vec2(0));
}

TEST_CASE("crowd system: walkers without a goal follow their intent, and face where it says") {
    Plaza plaza;
    const Entity walker = plaza.world.create(
        Transform{}, CrowdAgent{}, MoveIntent{.velocity = {0, 0, -1}, .facing = {1, 0, 0}});
    const Entity still = plaza.world.create(Transform{.position = {5, 0, 0}}, CrowdAgent{});
    plaza.run(120);
    CHECK(plaza.position(walker).z == test::near(-2).epsilon(0.02));
    CHECK(plaza.front(walker).x == test::near(1));
    CHECK(plaza.position(still) == Vec3(5, 0, 0));
}

TEST_CASE(
    "crowd system: to an exit walkers go around the obstacles of their space, and on to the next") {
    Plaza plaza;
    plaza.world.create(Transform{}, CrowdSpace{.size = {24, 24}});
    // A pocket that is open to the left: straight ways end in it.
    const auto wall = [&](const Vec3& position, const Vec2& size) {
        plaza.world.create(Transform{.position = position}, CrowdObstacle{.size = size});
    };
    wall({2, 0, 0}, {1, 9});
    wall({0, 0, 4}, {5, 1});
    wall({0, 0, -4}, {5, 1});
    const Entity home = plaza.exit({-8, 0, 0});
    const Entity goal = plaza.exit({8, 0, 0}, {.next = home});
    const Entity walker = plaza.walker({0, 0, 0.3f}, {.exit = goal});
    const Entity straight = plaza.walker({0, 0, -1}, {.point = {8, 0, 0}});
    float farthest = 0;
    for (int i = 0; i < 2400 && plaza.world.get<CrowdGoal>(walker).exit == goal; ++i) {
        plaza.run(1);
        farthest = std::max(farthest, std::abs(plaza.position(walker).z));
    }
    CHECK(farthest > 4);
    CHECK(plaza.world.get<CrowdGoal>(walker).exit == home);
    plaza.run(2400);
    CHECK(glm::distance(plaza.position(walker), plaza.position(home)) < 1.1f);
    CHECK(plaza.position(straight).x < 2);
}

TEST_CASE(
    "crowd system: an exit within an obstacle is reached as far as there is room, with a warning") {
    Plaza plaza;
    plaza.world.create(Transform{}, CrowdSpace{.size = {24, 24}});
    plaza.world.create(Transform{.position = {6, 0, 0}}, CrowdObstacle{.size = {4, 4}});
    const Entity goal = plaza.exit({6, 0, 0}, {.radius = 0.5f});
    const Entity walker = plaza.walker({-6, 0, 0}, {.exit = goal});
    const std::vector<std::string> messages = test::messages_of([&] { plaza.run(900); });
    REQUIRE(messages.size() == 1);
    CHECK(messages[0].find("crowd_exit at (6, 0): nothing is free there") != std::string::npos);
    CHECK(glm::distance(plaza.position(walker), Vec3(6, 0, 0)) < 4);
    const CrowdBarrier box = {.center = {6, 0}, .half = {2, 2}};
    const Vec3 end = plaza.position(walker);
    CHECK(find_barrier(box, {end.x, end.z}).distance == test::near(0.4).epsilon(0.5));
}

TEST_CASE("crowd system: NaN, infinite and senseless numbers stop a walker, not the others") {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    Plaza plaza;
    plaza.walker({kNan, 0, 0}, {.point = {5, 0, 0}});
    plaza.walker({0, 0, 4}, {.point = {5, 0, 0}}, {.radius = kNan});
    plaza.walker({0, 0, 8}, {.point = {5, 0, 0}}, {.horizon = 0});
    plaza.walker({0, 0, 2}, {.point = {kNan, 0, INFINITY}});
    plaza.world.create(Transform{.position = {INFINITY, 0, 0}}, CrowdObstacle{});
    plaza.world.create(Transform{}, CrowdSpace{.size = {kNan, 1}});
    plaza.world.create(Transform{}, CrowdSpace{.cell = 0});
    plaza.exit({kNan, 0, 0});
    const Entity flock = plaza.world.create(Transform{}, FlockParams{.radius = kNan});
    plaza.world.create(Transform{}, Boid{flock});
    plaza.world.create(Transform{}, Boid{.velocity = {kNan, 0, 0}});
    const Entity sound = plaza.walker({0, 0, 0}, {.point = {5, 0, 0}});
    plaza.run(300);
    CHECK(glm::distance(plaza.position(sound), Vec3(5, 0, 0)) < 0.31f);
}

TEST_CASE("crowd system: feet keep step: clips advance by the distance over the stride") {
    Plaza plaza;
    Assets assets;
    assets.clips.emplace_back().duration = 0.8f;
    plaza.world.insert_resource(std::move(assets));
    const Entity walker =
        plaza.walker({0, 0, 0}, {.point = {30, 0, 0}}, {.speed = 1.5f, .stride = 2});
    plaza.world.add(walker, ClipPlayer{.clip = {0}, .loop = true});
    float time = 0;
    for (int i = 0; i < 100; ++i) {
        const float before = plaza.position(walker).x;
        plaza.run(1);
        time += (plaza.position(walker).x - before) * 0.8f / 2;
        const float now = plaza.world.get<ClipPlayer>(walker).time;
        REQUIRE(std::abs(std::remainder(now - time, 0.8f)) < 1e-3f);
    }
    CHECK(time > 0.9f);
}

TEST_CASE(
    "crowd system: the same bits on 1, 2, 3 and 7 threads, and from a snapshot"
    * technique("char.flock")) {
    register_all_components();
    const std::vector<std::uint64_t> expected = plaza_hashes(1);
    for (const int threads : {2, 3, 7}) {
        CHECK(plaza_hashes(threads) == expected);
    }
    Plaza plaza;
    fill_plaza(plaza);
    plaza.run(45);
    const Result<std::vector<std::byte>> saved = save_snapshot(plaza.world);
    REQUIRE(saved.ok());
    Plaza restored;
    REQUIRE(restore_snapshot(restored.world, saved.value()).ok());
    restored.run(45);
    CHECK(state_hash(restored.world) == expected.back());
}

TEST_CASE("crowd system: headings are upright and turn by the angle, to both sides") {
    const Quat none(1, 0, 0, 0);
    for (const float side : {1.0f, -1.0f}) {
        const Vec3 turned = turn_heading(none, {side, 0}, 0.5f) * Vec3(0, 0, 1);
        CHECK(turned.x == test::near(side * std::sin(0.5f)));
        CHECK(turned.z == test::near(std::cos(0.5f)));
        const Vec3 reached = turn_heading(none, {side * 0.1f, 1}, 0.5f) * Vec3(0, 0, 1);
        CHECK(reached.x / reached.z == test::near(side * 0.1f));
    }
    const Quat back = turn_heading(none, {0, -1}, 1);
    CHECK((back * Vec3(0, 1, 0)).y == test::near(1));
    CHECK((back * Vec3(0, 0, 1)).z == test::near(std::cos(1.0f)));
}

}  // namespace limn::crowd_system_test
