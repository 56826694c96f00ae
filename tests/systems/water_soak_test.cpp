#include "ecs/components/buoyancy.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "systems/transform_system.h"
#include "systems/update_world.h"
#include "systems/water/buoyancy_system.h"
#include "systems/water/water_ripple_field.h"
#include "systems/water/water_ripple_system.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn::water_soak_test {

TEST_CASE("water soak: after an hour of rain a pool keeps its water and its floating bodies") {
    constexpr int kStepsAMinute = 60 * 60;
    constexpr Vec3 kHalf = {0.2f, 0.1f, 0.15f};
    constexpr float kDensity = 400;
    World world;
    const Entity pool = world.create(
        Transform{}, Water{.size = {3, 2}, .depth = 1},
        WaterRipples{.cell = 0.15f, .rain = 3, .rain_height = 0.01f});
    const Entity crate = world.create(
        Transform{.position = {0.3f, 1, -0.2f}},
        WaterTouch{.shape = TouchShape::Box, .half = kHalf}, Floating{.density = kDensity});
    const Entity stone = world.create(
        Transform{.position = {-0.8f, 2, 0.4f}},
        WaterTouch{.shape = TouchShape::Ball, .half = Vec3(0.1f)}, Floating{.density = 2500});
    start_world(world);
    Schedule schedule;  // only what an hour of this needs
    schedule.add<update_floating_bodies>();
    schedule.add<update_transforms>();
    schedule.add<update_water_ripples>();

    const float crate_volume = 8 * kHalf.x * kHalf.y * kHalf.z;
    const float displaced = crate_volume * kDensity / 1000 + 4.0f / 3 * kPi * 0.001f;
    double rained = 0;
    for (int minute = 0; minute < 60; ++minute) {
        CAPTURE(minute);
        double most = 0;
        for (int i = 0; i < kStepsAMinute; ++i) {
            step_world(world, schedule);
        }
        const RippleState& state = world.get<RippleState>(pool);
        for (const float height : state.height) {
            most = std::max(most, std::abs(static_cast<double>(height)));
        }
        rained = std::max(rained, most);
        CHECK(most < 0.1);  // not a number is no less either
        const double area = static_cast<double>(state.size().x * state.size().y);
        const double volume = ripple_volume(state);
        CHECK(std::abs(volume - state.level * area) < 1e-5);
        const FloatingState& floating = world.get<FloatingState>(crate);
        const Vec3 position = world.get<Transform>(crate).position;
        CHECK(std::isfinite(glm::length(floating.velocity) + glm::length(floating.spin)));
        CHECK(std::abs(position.x) < 1.5f);
        CHECK(std::abs(position.z) < 1.0f);
        if (minute > 0) {
            CHECK(volume == test::near(static_cast<double>(displaced)).epsilon(0.15).scale(0));
            CHECK(floating.submerged == test::near(kDensity / 1000).epsilon(0.25).scale(0));
        }
    }
    CHECK(rained > 0.003);
    CHECK(world.get<Transform>(stone).position.y == test::near(-0.9).epsilon(0.01).scale(0));
}

}  // namespace limn::water_soak_test
