#include "ecs/base/jobs.h"
#include "ecs/components/all.h"
#include "ecs/components/animation.h"
#include "ecs/components/foot_plant.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/snapshot.h"
#include "systems/update_world.h"
#include "tests/near.h"
#include "tests/systems/motor_fixture.h"
#include "tests/systems/walk_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace limn::walk_system_test {

using namespace limn::test;

namespace {

/// Walkers in a world, of different styles, on routes.
struct Promenade {
    World world;
    Schedule schedule = make_world_schedule();
    std::vector<Entity> walkers;

    Promenade() {
        Assets assets;
        assets.skeletons.push_back(make_stick_person());
        world.insert_resource(std::move(assets));
    }
    Entity add(const Walk& walk, const WalkRoute& route, const Vec3& at = {}) {
        walkers.push_back(
            world.create(Transform{.position = at}, Skeleton{{0}}, walk, route, MoveIntent{}));
        return walkers.back();
    }
    void step(int count = 1) {
        for (int i = 0; i < count; ++i) {
            step_world(world, schedule);
        }
    }
    /// Of joint `joint`, in the world.
    Vec3 joint(Entity walker, std::uint16_t joint) {
        return transform_point(
            world.get<const WorldTransform>(walker).world,
            transform_point(world.get<const Pose>(walker).joints[joint], Vec3(0)));
    }
};

WalkRoute square() {
    return {.points = {{{0, 0, 3}}, {{3, 0, 3}, 0.5f}, {{3, 0, 0}}, {{0, 0, 0}}}};
}

void fill(Promenade& promenade) {
    for (int i = 0; i < 20; ++i) {
        Walk walk;
        walk.speed = 0.7f + 0.05f * static_cast<float>(i);
        walk.tiredness = i % 4 == 1 ? 0.8f : 0.0f;
        walk.left.knee = i % 3 == 0 ? 0.2f : 1.0f;
        promenade.add(walk, square(), {2.0f * static_cast<float>(i), 0, 0});
    }
}

std::vector<std::uint64_t> hashes(int threads) {
    set_thread_count(threads);
    Promenade promenade;
    fill(promenade);
    std::vector<std::uint64_t> result;
    for (int i = 0; i < 60; ++i) {
        promenade.step();
        result.push_back(state_hash(promenade.world));
    }
    set_thread_count(0);
    return result;
}

}  // namespace

TEST_CASE("walk system: the same bits on 1, 2, 3 and 7 threads" * technique("char.walk-cycle")) {
    const std::vector<std::uint64_t> expected = hashes(1);
    CHECK(expected[0] != expected.back());
    for (const int threads : {2, 3, 7}) {
        CHECK(hashes(threads) == expected);
    }
}

TEST_CASE("walk system: a snapshot in the middle of a step continues with the same bits") {
    register_all_components();
    Promenade promenade;
    fill(promenade);
    promenade.step(47);
    const WalkState& state = promenade.world.get<const WalkState>(promenade.walkers[0]);
    CHECK(state.flying != WalkState::kNoFoot);
    const Result<std::vector<std::byte>> saved = save_snapshot(promenade.world);
    REQUIRE(saved.ok());
    Promenade again;
    REQUIRE(restore_snapshot(again.world, saved.value()).ok());
    for (int i = 0; i < 60; ++i) {
        promenade.step();
        again.step();
        CHECK(state_hash(promenade.world) == state_hash(again.world));
    }
}

TEST_CASE("walk system: a route is followed from point to point, with a rest where it says so") {
    Promenade promenade;
    const Entity walker = promenade.add({}, square());
    float farthest = 0;
    int standing = 0;
    int rounds = 0;
    std::uint32_t next = 0;
    for (int i = 0; i < 60 * 40; ++i) {
        promenade.step();
        const Vec3 at = promenade.world.get<const Transform>(walker).position;
        const WalkState& state = promenade.world.get<const WalkState>(walker);
        farthest = std::max({farthest, -at.x, -at.z, at.x - 3, at.z - 3});
        standing += state.flying == WalkState::kNoFoot ? 1 : 0;
        const std::uint32_t now = promenade.world.get<const WalkRouteState>(walker).next;
        rounds += now == 0 && next == 3 ? 1 : 0;
        next = now;
    }
    CHECK(rounds >= 2);
    CHECK(farthest < 1.0f);
    CHECK(standing > 10);
}

TEST_CASE("walk system: the last point of a route that does not loop is where it stops") {
    Promenade promenade;
    const Entity walker =
        promenade.add({}, {.points = {{{0, 0, 2}}, {{1.5f, 0, 3}}}, .loop = false});
    promenade.step(60 * 10);
    const Vec3 at = promenade.world.get<const Transform>(walker).position;
    CHECK(glm::distance(at, Vec3(1.5f, 0, 3)) < 0.08f);
    CHECK(promenade.world.get<const WalkState>(walker).flying == WalkState::kNoFoot);
}

TEST_CASE("walk system: it walks up a step that is walkable, its feet on the ground") {
    Promenade promenade;
    const Entity walker = promenade.add({}, {.points = {{{0, 0, 8}}}, .loop = false});
    promenade.world.add(walker, FootPlant{.softness = 0.002f});
    // A plane that rises by 1 in 8, as a walkable without a mesh: its local plane y = 0.
    const float slope = std::atan(0.125f);
    promenade.world.create(Transform{.rotation = rotation_about({1, 0, 0}, -slope)}, Walkable{});
    promenade.step(60 * 5);
    const Vec3 at = promenade.world.get<const Transform>(walker).position;
    CHECK(at.z > 4);
    CHECK(at.y == near(0.125 * static_cast<double>(at.z)).epsilon(0.25));
    promenade.step(60 * 5);
    for (const std::uint16_t toes : {std::uint16_t{7}, std::uint16_t{14}}) {
        const Vec3 toe = promenade.joint(walker, toes);
        const float above = toe.y - 0.125f * toe.z;
        CHECK(above > -0.02f);
        CHECK(above < 0.08f);
    }
}

TEST_CASE("walk system: up a flight of steps and down again, each foot stands on a tread") {
    constexpr float kRise = 0.16f;
    constexpr float kTread = 0.34f;
    constexpr int kSteps = 8;
    Promenade promenade;
    MeshData flight;
    add_box(flight, {-2, -1, -3}, {2, 0, 1});
    for (int i = 0; i < kSteps; ++i) {
        const float z = 1 + kTread * static_cast<float>(i);
        add_box(flight, {-2, -1, z}, {2, kRise * static_cast<float>(i + 1), 9});
    }
    promenade.world.resource<Assets>().meshes.push_back(std::move(flight));
    promenade.world.create(Transform{}, MeshInstance{.mesh = {0}, .material = {}}, Walkable{});
    const auto tread = [](float z) {
        const float steps = std::ceil((z - 1) / kTread);
        return kRise * std::clamp(steps, 0.0f, static_cast<float>(kSteps));
    };
    Walk walk;
    walk.speed = 0.9f;
    walk.stride = 0.68f;
    const Entity walker =
        promenade.add(walk, {.points = {{{0, 0, 5.5f}, 0.5f}, {{0, 0, 0}, 0.5f}}});
    promenade.world.add(walker, FootPlant{.speed = 30});
    float highest = 0;
    int standing = 0;
    int off = 0;
    for (int i = 0; i < 60 * 16; ++i) {
        promenade.step();
        const auto& state = promenade.world.get<const WalkState>(walker);
        const auto& body = promenade.world.get<const WalkBody>(walker);
        highest = std::max(highest, promenade.world.get<const Transform>(walker).position.y);
        for (std::uint32_t side = 0; side < 2; ++side) {
            const bool stands = flight_progress(state, side) >= 1 && state.feet[side].pitch == 0;
            if (!stands) {
                continue;
            }
            const Vec3 ankle = promenade.joint(walker, body.legs[side].foot);
            const float above = ankle.y - body.legs[side].ankle.y;
            // A foot across an edge stands on the one tread or the other.
            const float error = std::min(
                std::abs(above - tread(ankle.z - 0.05f)), std::abs(above - tread(ankle.z + 0.05f)));
            ++standing;
            off += error > 0.03f ? 1 : 0;
        }
    }
    CHECK(highest == near(kRise * kSteps).epsilon(0.02));
    CHECK(promenade.world.get<const Transform>(walker).position.y < 0.6f);  // on its way down
    CHECK(standing > 300);
    CHECK(off < standing / 20);
}

TEST_CASE("walk system: without a skeleton, or without an intent, it stands") {
    Promenade promenade;
    const Entity none = promenade.world.create(Transform{}, Walk{});
    const Entity idle = promenade.world.create(Transform{}, Skeleton{{0}}, Walk{});
    const Entity missing = promenade.world.create(Transform{}, Skeleton{{7}}, Walk{});
    promenade.step(60);
    CHECK_FALSE(promenade.world.has<WalkState>(none));
    CHECK(promenade.world.get<const Transform>(idle).position == Vec3(0));
    CHECK(promenade.world.get<const WalkState>(idle).flying == WalkState::kNoFoot);
    CHECK(promenade.world.get<const Transform>(missing).position == Vec3(0));
    // Arms hang, also without a clip that lowers them.
    CHECK(promenade.joint(idle, 10).y < 1.0f);
}

TEST_CASE("walk system: a walker that is placed elsewhere stands there") {
    Promenade promenade;
    const Entity walker = promenade.add({}, {.points = {{{0, 0, 50}}}});
    promenade.step(80);
    promenade.world.get<Transform>(walker).position = {20, 0, 0};
    promenade.step();
    for (const WalkFoot& foot : promenade.world.get<const WalkState>(walker).feet) {
        CHECK(glm::distance(foot.place, Vec3(20, 0, 0)) < 0.3f);
    }
}

}  // namespace limn::walk_system_test
