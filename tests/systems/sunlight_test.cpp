#include "ecs/base/air.h"
#include "ecs/world.h"
#include "systems/light/sunlight_system.h"
#include "systems/update_world.h"
#include "tests/near.h"

#include <doctest/doctest.h>

namespace limn::sunlight_test {
namespace {

using test::near;

/// The light of a sun at this elevation when the world starts, as irradiance.
Vec3 light_at(World& world, float degrees_up) {
    const Entity sun = world.create(
        Transform{.rotation = glm::angleAxis(radians(-degrees_up), Vec3(1, 0, 0))},
        DirectionalLight{}, Sunlight{.color = {1, 0.9f, 0.8f}, .illuminance = 6});
    start_world(world);
    const auto& light = world.get<DirectionalLight>(sun);
    return light.color * light.illuminance;
}

}  // namespace

TEST_CASE("sunlight: on the ground is what the air lets through") {
    for (const float elevation : {90.0f, 40.0f, 6.0f, 1.0f}) {
        CAPTURE(elevation);
        World world;
        world.insert_resource(Environment{.sky = SkyKind::Atmosphere, .haze = 4});
        const Vec3 got = light_at(world, elevation);
        const glm::dvec3 want = glm::dvec3(6, 5.4, 4.8)
                                * air_transmittance(kGroundRadius, std::sin(radians(elevation)), 4);
        for (int c = 0; c < 3; ++c) {
            CHECK(got[c] == near(want[c]).epsilon(1e-4));
        }
    }
}

TEST_CASE("sunlight: none from below the horizon, all of it without an atmosphere") {
    World night;
    night.insert_resource(Environment{.sky = SkyKind::Atmosphere});
    CHECK(light_at(night, -2) == Vec3(0));
    World gradient;
    gradient.insert_resource(Environment{});
    CHECK(light_at(gradient, 30).y == near(5.4));
    World empty;
    CHECK(light_at(empty, 30).z == near(4.8));
}

TEST_CASE("sunlight: follows a sun that turns, and a step of the level's air") {
    World world;
    world.insert_resource(Environment{.sky = SkyKind::Atmosphere});
    const Entity sun = world.create(
        Transform{.rotation = glm::angleAxis(radians(-50), Vec3(1, 0, 0))}, DirectionalLight{},
        Sunlight{});
    start_world(world);
    Schedule schedule = make_world_schedule();
    const auto ratio = [&] {
        const Vec3 color = world.get<DirectionalLight>(sun).color;
        return color.z / color.x;
    };
    const float noon = ratio();
    world.get<Transform>(sun).rotation = glm::angleAxis(radians(-5), Vec3(1, 0, 0));
    step_world(world, schedule);
    const float evening = ratio();
    CHECK(evening < 0.4f * noon);
    world.resource<Environment>().haze = 30;
    step_world(world, schedule);
    CHECK(world.get<DirectionalLight>(sun).illuminance < 2);
    world.get<Transform>(sun).scale = Vec3(0);  // no direction: from above
    step_world(world, schedule);
    CHECK(world.get<DirectionalLight>(sun).illuminance > 2);
}

}  // namespace limn::sunlight_test
