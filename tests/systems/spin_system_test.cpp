#include "ecs/base/rng.h"
#include "ecs/world.h"
#include "systems/motion_kernels.h"
#include "systems/spin_system.h"
#include "tests/near.h"

#include <doctest/doctest.h>

#include <cstring>
#include <vector>

namespace limn::spin_system_test {

TEST_CASE("spin: a turn of 2 pi in 60 steps returns to its start") {
    World world;
    world.insert_resource(FrameTime{.step = 1.0f / 60.0f});
    const Quat start = glm::normalize(Quat(1, 0.2f, 0.3f, -0.1f));
    const Entity e =
        world.create(Transform{.rotation = start}, Spin{.axis = {1, 2, 3}, .speed = 2 * kPi});
    for (int i = 0; i < 60; ++i) {
        world.run(update_spins);
    }
    CHECK(
        std::abs(glm::dot(world.get<Transform>(e).rotation, start))
        == test::near(1.0f).epsilon(1e-6));
}

TEST_CASE(
    "spin: it rotates by speed times step about its own axis, whatever the length of the axis") {
    World world;
    world.insert_resource(FrameTime{.step = 0.5f});
    const Quat start = glm::angleAxis(0.7f, glm::normalize(Vec3(1, 1, 0)));
    const Entity e =
        world.create(Transform{.rotation = start}, Spin{.axis = {0, 5, 0}, .speed = 0.6f});
    world.run(update_spins);
    const Quat expected = start * glm::angleAxis(0.3f, Vec3(0, 1, 0));
    CHECK(glm::dot(world.get<Transform>(e).rotation, expected) == test::near(1.0f).epsilon(1e-6));
}

TEST_CASE("spin: nothing rotates about an axis of length 0 or in a step of length 0") {
    World world;
    world.insert_resource(FrameTime{.step = 0.5f});
    const Entity none = world.create(Transform{}, Spin{.axis = {0, 0, 0}, .speed = 3});
    world.run(update_spins);
    CHECK(world.get<Transform>(none).rotation == Quat(1, 0, 0, 0));
    world.get<Spin>(none).axis = {1, 0, 0};
    world.resource<FrameTime>().step = 0;
    const std::uint32_t since = world.version();
    world.run(update_spins);
    CHECK(world.get<const Transform>(none).rotation == Quat(1, 0, 0, 0));
    CHECK(world.query<const Transform, Changed<Transform>>().since(since).count() == 0);
}

TEST_CASE("spin: the rotation stays unit through 100,000 steps") {
    std::vector<Spin> spin(16);
    std::vector<Transform> transform(16);
    for (std::size_t i = 0; i < spin.size(); ++i) {
        spin[i] = {.axis = {1, static_cast<float>(i), -2}, .speed = 1.7f * static_cast<float>(i)};
    }
    for (int step = 0; step < 100000; ++step) {
        turn_rotations(spin, 1.0f / 60.0f, transform);
    }
    for (const Transform& t : transform) {
        CHECK(glm::length(t.rotation) == test::near(1.0f).epsilon(1e-6));
    }
}

TEST_CASE("spin: the SIMD kernel gives the bits of the scalar one, whatever the count") {
    Random random(1, 0, name_hash("spin"), 0);
    for (std::size_t count = 1; count < 70; ++count) {
        std::vector<Spin> spin(count);
        std::vector<Transform> transform(count);
        for (std::size_t i = 0; i < count; ++i) {
            spin[i] = {
                .axis = random.direction() * random.uniform(0, 3),
                .speed = random.uniform(-100, 100)};
            if (i % 5 == 0) {
                spin[i].axis = {0, 0, 0};
            }
            transform[i].rotation = glm::normalize(
                Quat(random.normal(), random.normal(), random.normal(), random.normal()));
        }
        std::vector<Transform> plain = transform;
        for (int step = 0; step < 5; ++step) {
            turn_rotations(spin, 1.0f / 60.0f, transform);
            turn_rotations_scalar(spin, 1.0f / 60.0f, plain);
        }
        CHECK(std::memcmp(transform.data(), plain.data(), count * sizeof(Transform)) == 0);
    }
}

}  // namespace limn::spin_system_test
