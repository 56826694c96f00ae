#include "ecs/world.h"
#include "systems/path_system.h"
#include "systems/update_world.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>

namespace limn::path_system_test {

namespace {

/// A square of side 10 with rounded corners, in the x-z plane.
PathData square_path() {
    PathShape shape;
    shape.closed = true;
    for (const Vec3& position :
         {Vec3(0, 0, 0), Vec3(0, 0, 10), Vec3(-10, 0, 10), Vec3(-10, 0, 0)}) {
        shape.knots.emplace_back().position = position;
    }
    return *make_path(shape);
}

struct Follow {
    Follow() {
        world.insert_resource(Assets{}).paths.push_back(square_path());
        schedule = make_world_schedule();
    }
    Entity add(const PathFollower& follower) { return world.create(Transform{}, follower); }
    void start() { start_world(world); }
    void step() { step_world(world, schedule); }

    World world;
    Schedule schedule;
};

}  // namespace

TEST_CASE_FIXTURE(Follow, "path system: a follower moves at its speed, +z ahead, lap after lap") {
    const Entity entity = add({.path = {0}, .speed = 6});
    start();
    CHECK(world.get<WorldTransform>(entity).world.row[2].w == 0);
    const double length = world.resource<Assets>().paths[0].length();
    const int steps = static_cast<int>(2.2 * length / 0.1);
    for (int i = 0; i < steps; ++i) {
        const Vec3 before = world.get<Transform>(entity).position;
        step();
        const Transform& now = world.get<Transform>(entity);
        const Vec3 way = now.position - before;
        REQUIRE(glm::length(way) == test::near(0.1).epsilon(0.02));
        REQUIRE(glm::dot(now.rotation * Vec3(0, 0, 1), way) > 0.0995f);
        REQUIRE((now.rotation * Vec3(0, 1, 0)).y == test::near(1));
    }
    const double distance = world.get<PathFollower>(entity).distance;
    CHECK(distance == test::near(std::fmod(steps * 0.1, length)).epsilon(1e-3));
}

TEST_CASE_FIXTURE(Follow, "path system: offsets are to the right, up and ahead") {
    const Entity entity = add({.path = {0}, .distance = 5, .speed = 0, .offset = {1, 2, 3}});
    const Entity middle = add({.path = {0}, .distance = 5, .speed = 0});
    start();
    const Transform& at = world.get<Transform>(middle);
    const Vec3 offset =
        glm::inverse(at.rotation) * (world.get<Transform>(entity).position - at.position);
    CHECK(glm::distance(offset, Vec3(-1, 2, 3)) < 1e-5f);  // +x is left
}

TEST_CASE_FIXTURE(Follow, "path system: an open path ends, backward as well") {
    PathShape shape;
    shape.knots.resize(2);
    shape.knots[1].position = {0, 5, 5};
    world.resource<Assets>().paths.push_back(*make_path(shape));
    const Entity there = add({.path = {1}, .distance = 6.9, .speed = 60});
    const Entity back = add({.path = {1}, .distance = 0.5, .speed = -60, .level = true});
    start();
    for (int i = 0; i < 3; ++i) {
        step();
    }
    CHECK(glm::distance(world.get<Transform>(there).position, Vec3(0, 5, 5)) < 1e-5f);
    CHECK(world.get<Transform>(back).position == Vec3(0));
    CHECK((world.get<Transform>(back).rotation * Vec3(0, 1, 0)).y == test::near(1));
    CHECK((world.get<Transform>(there).rotation * Vec3(0, 1, 0)).y < 0.8f);
}

TEST_CASE_FIXTURE(Follow, "path system: a follower of a missing path does not move") {
    const Entity entity = add({.path = {7}, .speed = 5});
    const Entity none = add({.speed = 5});
    world.get<Transform>(entity).position = {1, 2, 3};
    start();
    step();
    CHECK(world.get<Transform>(entity).position == Vec3(1, 2, 3));
    CHECK(world.get<Transform>(none).position == Vec3(0));
    CHECK(world.get<PathFollower>(entity).distance == 0);
}

}  // namespace limn::path_system_test
