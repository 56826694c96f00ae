#include "ecs/base/rotation.h"
#include "ecs/components/foot_plant.h"
#include "ecs/components/surface.h"
#include "ecs/world.h"
#include "systems/crowd/crowd_floor.h"
#include "systems/crowd/crowd_system.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace limn::crowd_floor_test {

namespace {

constexpr float kStep = 1.0f / 60;

/// Level ground, and walkers on it.
struct Terrain {
    World world;

    Terrain() {
        world.insert_resource(Assets{});
        world.insert_resource(WalkableMeshes{});
        world.insert_resource(CrowdMemory{});
        world.insert_resource(RandomSeed{});
        world.insert_resource(FrameTime{.step = kStep});
        world.create(Transform{}, Walkable{});
    }
    /// A mesh of horizontal rectangles: x from .x to .y at height .z, 10 m wide.
    void add_tops(const std::vector<Vec3>& tops) {
        MeshData mesh;
        for (const Vec3& top : tops) {
            const auto first = static_cast<std::uint32_t>(mesh.positions.size());
            mesh.positions.insert(
                mesh.positions.end(),
                {{top.x, top.z, -5}, {top.x, top.z, 5}, {top.y, top.z, 5}, {top.y, top.z, -5}});
            for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) {
                mesh.indices.push_back(first + corner);
            }
        }
        Assets& assets = world.resource<Assets>();
        assets.meshes.push_back(std::move(mesh));
        const auto last = static_cast<std::uint32_t>(assets.meshes.size() - 1);
        world.create(Transform{}, Walkable{}, MeshInstance{.mesh = {last}, .material = {}});
    }
    Entity walker(const Vec3& position, const Vec3& goal, const CrowdAgent& agent = {}) {
        return world.create(
            Transform{.position = position}, agent, CrowdState{}, CrowdGoal{.point = goal});
    }
    Vec3 step(Entity walker) {
        world.run(update_crowd);
        return world.get<Transform>(walker).position;
    }
};

}  // namespace

TEST_CASE(
    "crowd floor: a walker goes up and down a ramp on its surface" * technique("char.flock")) {
    Terrain terrain;
    const float slope = std::tan(0.35f);
    terrain.world.create(Transform{.rotation = rotation_about(Vec3(0, 0, 1), 0.35f)}, Walkable{});
    const Entity walker = terrain.walker({-3, 0, 0}, {3, 0, 0});
    float highest = 0;
    for (int i = 0; i < 600; ++i) {
        if (i == 360) {
            terrain.world.get<CrowdGoal>(walker).point = {-3, 0, 0};
        }
        const Vec3 position = terrain.step(walker);
        REQUIRE(
            position.y == test::near(std::max(0.0f, slope * position.x)).epsilon(1e-3).scale(1));
        highest = std::max(highest, position.y);
    }
    CHECK(highest > 0.9f);
    CHECK(terrain.world.get<Transform>(walker).position.x < -2);
}

TEST_CASE("crowd floor: steps are taken without jolts, tables are not climbed") {
    Terrain terrain;
    std::vector<Vec3> tops;
    for (int i = 0; i < 5; ++i) {
        const auto k = static_cast<float>(i);
        tops.emplace_back(2 + 0.3f * k, i == 4 ? 12.0f : 2.3f + 0.3f * k, 0.17f * (k + 1));
    }
    tops.emplace_back(-4, -2, 0.9f);
    terrain.add_tops(tops);
    const Entity walker = terrain.walker({-6, 0, 0}, {8, 0, 0});
    const Entity still = terrain.walker({-7, 2, 3}, {-7, 2, 3});
    const Entity above = terrain.walker({4, 0.6f, 3}, {4, 0, 3});
    const Entity flat = terrain.walker({0, 0, -3}, {8, 0, -3}, {.climb = 0});
    Vec3 before(-6, 0, 0);
    for (int i = 0; i < 900; ++i) {
        const Vec3 now = terrain.step(walker);
        REQUIRE(std::abs(now.y - before.y) <= (0.3f + 1.2f * 1.8f) * kStep + 1e-5f);
        if (now.x < 1.9f) {
            REQUIRE(now.y == 0);
        }
        before = now;
    }
    CHECK(before.x > 7.6f);
    CHECK(before.y == test::near(0.85));
    CHECK(terrain.world.get<Transform>(still).position.y == 2);
    CHECK(terrain.world.get<Transform>(above).position.y == test::near(0.85));
    CHECK(terrain.world.get<Transform>(flat).position.y == 0);
}

TEST_CASE("crowd floor: the highest ground in reach; none for points that are not finite") {
    Terrain terrain;
    terrain.add_tops({{0, 10, 0.3f}, {5, 10, 0.4f}, {5, 10, 2}});
    terrain.world.run([&](GroundQueries grounds) {
        const CrowdFloor floor = place_floor(grounds);
        const auto height = [&](const Vec3& point) {
            return find_floor(floor, point, 0.45f).value_or(-9);
        };
        CHECK(height({-1, 0.1f, 0}) == test::near(0.0).scale(1));
        CHECK(height({1, 0.1f, 0}) == test::near(0.3).scale(1));
        CHECK(height({6, 0.1f, 0}) == test::near(0.4).scale(1));
        CHECK(height({6, 1.9f, 0}) == test::near(2.0).scale(1));
        CHECK(!find_floor(floor, {6, 1.2f, 0}, 0.45f));
        constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
        CHECK(!find_floor(floor, {kNan, 0, 0}, 0.45f));
        CHECK(!find_floor(floor, {1, kNan, 0}, 0.45f));
    });
}

}  // namespace limn::crowd_floor_test
