#include "ecs/base/rng.h"
#include "ecs/world.h"
#include "systems/motion_kernels.h"
#include "systems/sway_system.h"
#include "tests/near.h"
#include "tests/systems/sway_table.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <vector>

namespace limn::sway_system_test {

TEST_CASE("sway: sine and cosine are within 1e-7 of the library's, near zero and after days") {
    double worst = 0;
    for (int i = -20000; i <= 20000; ++i) {
        for (const double scale : {1e-4, 1e-2, 1.0, 977.0}) {
            const double x = scale * i;
            worst = std::max(worst, std::abs(static_cast<double>(sine(x)) - std::sin(x)));
            worst = std::max(worst, std::abs(static_cast<double>(cosine(x)) - std::cos(x)));
        }
    }
    CHECK(worst < 1e-7);
    CHECK(sine(0) == 0);
    CHECK(cosine(0) == 1);
    for (int i = 0; i < 100; ++i) {
        CHECK(sine(-0.1 * i) == -sine(0.1 * i));
    }
}

TEST_CASE("sway: each axis is center + amplitude sin(frequency t + phase)") {
    World world;
    world.insert_resource(FrameTime{.time = 12.5});
    const Sway sway = {
        .center = {1, 2, 3},
        .amplitude = {0.5f, 1, 2},
        .frequency = {1, 2, 0.3f},
        .phase = {0, 1, -2}};
    const Entity e = world.create(Transform{}, sway);
    world.run(update_sways);
    for (int axis = 0; axis < 3; ++axis) {
        const double angle = static_cast<double>(sway.frequency[axis]) * 12.5
                             + static_cast<double>(sway.phase[axis]);
        const double expected = static_cast<double>(sway.center[axis])
                                + static_cast<double>(sway.amplitude[axis]) * std::sin(angle);
        CHECK(world.get<Transform>(e).position[axis] == test::near(expected).epsilon(1e-6));
    }
}

TEST_CASE("sway: it repeats after one period, also after a day") {
    World world;
    FrameTime& time = world.insert_resource(FrameTime{.time = 86400.0});
    const Entity e =
        world.create(Transform{}, Sway{.amplitude = {1, 1, 1}, .frequency = {2, 4, 8}});
    world.run(update_sways);
    const Vec3 before = world.get<Transform>(e).position;
    time.time += 3.14159265358979323846;
    world.run(update_sways);
    CHECK(glm::length(world.get<Transform>(e).position - before) < 1e-6f);
}

TEST_CASE("sway: only the position changes") {
    World world;
    world.insert_resource(FrameTime{.time = 1});
    const Transform start = {.rotation = Quat(0, 1, 0, 0), .scale = {2, 3, 4}};
    const Entity e = world.create(start, Sway{});
    world.run(update_sways);
    CHECK(world.get<Transform>(e).rotation == start.rotation);
    CHECK(world.get<Transform>(e).scale == start.scale);
}

TEST_CASE("sway: the SIMD kernel gives the bits of the scalar one, whatever the count") {
    Random random(1, 0, name_hash("sway"), 0);
    for (std::size_t count = 1; count < 70; ++count) {
        std::vector<Sway> sway(count);
        std::vector<Transform> transform(count);
        for (Sway& s : sway) {
            s = {
                .center = random.direction(),
                .amplitude = random.direction(),
                .frequency = 10.0f * random.direction(),
                .phase = 4.0f * random.direction()};
        }
        std::vector<Transform> plain = transform;
        const test::SwayTable table(sway);
        for (const double time : {0.0, 0.016666, 1000.3}) {
            sway_positions(table.arrays(), time, transform);
            sway_positions_scalar(table.arrays(), time, plain);
            CHECK(std::memcmp(transform.data(), plain.data(), count * sizeof(Transform)) == 0);
        }
    }
}

}  // namespace limn::sway_system_test
