#include "ecs/base/jobs.h"
#include "ecs/components/all.h"
#include "ecs/components/camera.h"
#include "ecs/components/input.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/snapshot.h"
#include "systems/update_world.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn::update_world_test {
namespace {

/// Boxes that turn and sway, some of them on others, with two cameras.
void fill(World& world) {
    for (int i = 0; i < 3000; ++i) {
        const auto x = static_cast<float>(i);
        const Entity e = world.create(
            Transform{.position = {x, 0, 0}}, Spin{.axis = {1, x, 2}, .speed = 0.1f * x},
            Sway{.center = {x, 1, 0}, .phase = {x, 0, 1}});
        if (i % 10 == 0) {
            world.create(Transform{.position = {0, 1, 0}}, Parent{e}, Spin{});
        }
        if (i == 500) {
            world.create(Transform{}, Camera{}, OrbitCamera{.target = e});
            world.create(Transform{}, FlyCamera{});
        }
    }
}

std::vector<std::uint64_t> hashes(int threads, int steps) {
    set_thread_count(threads);
    World world;
    fill(world);
    Schedule schedule = make_world_schedule();
    schedule.set_always_parallel(threads > 1);
    std::vector<std::uint64_t> all;
    for (int i = 0; i < steps; ++i) {
        step_world(world, schedule);
        world.resource<Input>().look = {static_cast<float>(i % 7), 1};
        set_action(world.resource<Input>(), "move_forward");
        all.push_back(state_hash(world));
    }
    return all;
}

}  // namespace

TEST_CASE(
    "update_world: time is the number of steps times their length, without drift"
    * technique("engine.animate")) {
    World world;
    Schedule schedule = make_world_schedule();
    for (int i = 0; i < 600; ++i) {
        step_world(world, schedule);
        CHECK(world.resource<FrameTime>().frame == static_cast<std::uint64_t>(i));
    }
    CHECK(world.resource<FrameTime>().time == test::near(10.0).epsilon(1e-7));
}

TEST_CASE("update_world: in steps of length 0 nothing moves" * technique("engine.object-step")) {
    const auto largest_motion = [](float step) {
        World world;
        world.insert_resource(FrameTime{.step = step});
        fill(world);
        Schedule schedule = make_world_schedule();
        start_world(world);
        const auto positions = [&] {
            std::vector<Vec3> all;
            world.query<const WorldTransform>().each([&](const WorldTransform& transform) {
                all.push_back(transform_point(transform.world, {1, 2, 3}));
            });
            return all;
        };
        const std::vector<Vec3> before = positions();
        for (int i = 0; i < 3; ++i) {
            step_world(world, schedule);
        }
        const std::vector<Vec3> after = positions();
        REQUIRE(after.size() == before.size());
        float largest = 0;
        for (std::size_t i = 0; i < after.size(); ++i) {
            largest = std::max(largest, glm::distance(after[i], before[i]));
        }
        return largest;
    };
    CHECK(largest_motion(0) < 1e-3f);  // at up to 3000 m, one unit in the last place
    CHECK(largest_motion(1.0f / 60.0f) > 0.1f);
}

TEST_CASE(
    "update_world: even rotation is the same after one step as after two of half its length"
    * technique("engine.animate")) {
    const auto turned = [](float step, int steps) {
        World world;
        world.insert_resource(FrameTime{.step = step});
        const Entity wheel = world.create(Transform{}, Spin{.axis = {1, 2, 3}, .speed = 4});
        Schedule schedule = make_world_schedule();
        for (int i = 0; i < steps; ++i) {
            step_world(world, schedule);
        }
        return world.get<Transform>(wheel).rotation;
    };
    const Quat once = turned(1.0f / 30.0f, 15);
    const Quat twice = turned(1.0f / 60.0f, 30);
    CHECK(std::abs(glm::dot(once, twice)) == test::near(1.0f).epsilon(1e-6));
    CHECK(once.w == test::near(std::cos(1.0f)).epsilon(1e-5));  // half of 2 rad in half a second
}

TEST_CASE(
    "update_world: a spawned entity has its matrix after one step"
    * technique("engine.object-step")) {
    World world;
    Schedule schedule = make_world_schedule();
    const Entity parent = world.create(Transform{.position = {1, 0, 0}});
    const Entity child = world.create(Transform{.position = {0, 2, 0}}, Parent{parent});
    step_world(world, schedule);
    const Affine pose = world.get<WorldTransform>(child).world;
    CHECK(Vec3(pose.row[0].w, pose.row[1].w, pose.row[2].w) == Vec3(1, 2, 0));
    CHECK(world.has<PreviousWorldTransform>(child));
}

TEST_CASE("update_world: a started world is complete before its first step, which makes no jump") {
    World world;
    const Entity box = world.create(Transform{.position = {1, 2, 3}}, Sway{.center = {5, 0, 0}});
    start_world(world);
    CHECK(world.resource<FrameTime>().time == 0);
    CHECK(transform_point(world.get<WorldTransform>(box).world, Vec3(0)) == Vec3(5, 0, 0));
    Schedule schedule = make_world_schedule();
    step_world(world, schedule);
    CHECK(transform_point(world.get<PreviousWorldTransform>(box).world, Vec3(0)) == Vec3(5, 0, 0));
}

TEST_CASE("update_world: the same start gives the same worlds, from run to run and on any number "
          "of threads") {
    const int before = thread_count();
    const std::vector<std::uint64_t> one = hashes(1, 12);
    CHECK(hashes(1, 12) == one);
    CHECK(hashes(2, 12) == one);
    CHECK(hashes(4, 12) == one);
    CHECK(one[0] != one[1]);
    set_thread_count(before);
}

TEST_CASE("update_world: a world restored from a snapshot continues the same") {
    register_all_components();
    register_component<Parent>();
    World world;
    fill(world);
    Schedule schedule = make_world_schedule();
    for (int i = 0; i < 5; ++i) {
        step_world(world, schedule);
    }
    const Result<std::vector<std::byte>> image = save_snapshot(world);
    REQUIRE(image.ok());
    World other;
    const Status restored = restore_snapshot(other, *image);
    REQUIRE(restored.ok());
    Schedule other_schedule = make_world_schedule();
    for (int i = 0; i < 5; ++i) {
        step_world(world, schedule);
        step_world(other, other_schedule);
        REQUIRE(state_hash(other) == state_hash(world));
    }
}

}  // namespace limn::update_world_test
