#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/components/water_wake.h"
#include "ecs/world.h"
#include "systems/update_world.h"
#include "systems/water/water_wake_system.h"
#include "systems/water/water_wave_table.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn::water_wake_test {

namespace {

constexpr float kStep = 1.0f / 60;

/// Open water, and a boat that moves along +x.
struct Sea {
    explicit Sea(const WakeEmitter& wake, const WaterWaves& waves = {}) {
        schedule = make_world_schedule();
        water = world.create(Transform{.position = {0, 1, 0}}, Water{}, waves);
        boat = world.create(Transform{.position = {-10, 1, 0}}, wake);
        start_world(world);
    }
    void sail(float speed, int steps) {
        for (int i = 0; i < steps; ++i) {
            world.get<Transform>(boat).position.x += speed * kStep;
            step_world(world, schedule);
        }
    }
    [[nodiscard]] std::size_t rings() const { return world.get<WaterWaves>(water).packets.size(); }
    [[nodiscard]] float height(const Vec2& at) const {
        return evaluate_waves(world.get<WaveTable>(water), at).offset.y;
    }
    [[nodiscard]] float x() const { return world.get<Transform>(boat).position.x; }

    World world;
    Schedule schedule;
    Entity water;
    Entity boat;
};

constexpr WakeEmitter kWake = {.spacing = 0.5f, .decay = 100};

}  // namespace

TEST_CASE(
    "water wake: an emitter at rest or teleporting leaves no waves" * technique("water.wake")) {
    Sea sea(kWake);
    sea.sail(0, 120);
    CHECK(sea.rings() == 0);
    sea.world.get<Transform>(sea.boat).position.x += 500;
    sea.sail(0, 10);
    CHECK(sea.rings() == 0);
    CHECK(sea.height({-9, 0}) == 0);
}

TEST_CASE(
    "water wake: rings are equally spaced along the track, at any speed"
    * technique("water.wake")) {
    for (const float speed : {1.0f, 6.0f, 45.0f}) {
        Sea sea(kWake);
        sea.sail(speed, static_cast<int>(20.2f / speed / kStep) + 1);
        CAPTURE(speed);
        CHECK(static_cast<int>(sea.rings()) >= 39);
        CHECK(static_cast<int>(sea.rings()) <= 41);
        const std::vector<WavePacket>& rings = sea.world.get<WaterWaves>(sea.water).packets;
        for (std::size_t i = 1; i < rings.size(); ++i) {
            CHECK(glm::distance(rings[i].center, rings[i - 1].center) == test::near(0.5));
            // The older by the time that the boat took.
            const float later = rings[i - 1].age - rings[i].age;
            CHECK(std::abs(later * speed - 0.5f) < 0.02f);
        }
    }
}

TEST_CASE("water wake: rings fade and end") {
    Sea sea({.spacing = 0.5f, .decay = 0.5f});
    sea.sail(4, 60);
    CHECK(sea.rings() > 4);
    sea.sail(0, 100);
    CHECK(sea.rings() == 0);
}

TEST_CASE(
    "water wake: behind an emitter faster than its waves they stay within the wedge"
    * technique("water.wake")) {
    CHECK(kKelvinAngle == test::near(std::asin(1.0 / 3)).epsilon(1e-6).scale(0));
    CHECK(degrees(kKelvinAngle) == test::near(19.4712).epsilon(1e-5).scale(0));
    struct Case {
        float length;
        float angle;
    };
    const float speed = 6;
    const float slow = std::sqrt(9.81f * 2.0f / (2 * kPi));  // of waves of 2 m
    for (const Case& wake : {Case{0, kKelvinAngle}, Case{2, std::asin(slow / speed)}}) {
        WakeEmitter emitter = kWake;
        emitter.length = wake.length;
        Sea sea(emitter);
        sea.sail(speed, 240);
        float most = 0;
        float widest = 0;
        for (float back = 0; back < 26; back += 0.25f) {
            for (float side = 0; side < 14; side += 0.1f) {
                // The boat is at the tip; the last ring began up to a spacing before it.
                const float height = std::abs(sea.height({sea.x() - back, side}));
                const float edge = std::tan(wake.angle) * back + 0.02f;
                if (side > edge) {
                    CHECK(height < 1e-6f);
                } else if (height > 1e-3f) {
                    widest = std::max(widest, std::atan2(side, back));
                }
                most = std::max(most, height);
            }
        }
        CHECK(most > 0.02f);
        CHECK(widest > 0.85f * wake.angle);  // and they fill it
    }
}

TEST_CASE("water wake: it adds to existing waves" * technique("water.wake")) {
    const WaterWaves waves = {.waves = {{.amplitude = 0.3f, .length = 11}}};
    Sea calm(kWake);
    Sea rough(kWake, waves);
    Sea alone({.spacing = 1e3f}, waves);
    for (Sea* sea : {&calm, &rough, &alone}) {
        sea->sail(5, 180);
    }
    CHECK(alone.rings() == 0);
    for (float x = -10; x < 8; x += 0.7f) {
        const Vec2 at = {x, 0.4f};
        CHECK(rough.height(at) == test::near(calm.height(at) + alone.height(at)));
    }
}

TEST_CASE("water wake: on land and high in the air there is none" * technique("water.wake")) {
    Sea sea(kWake);
    sea.world.get<Transform>(sea.boat).position.y = 9;
    sea.sail(5, 60);
    CHECK(sea.rings() == 0);
    Sea pond(kWake);
    pond.world.get<Water>(pond.water).size = {4, 4};
    pond.sail(5, 60);  // from -10 to -5
    CHECK(pond.rings() == 0);
    Sea odd({.spacing = 0, .amplitude = 1});
    odd.sail(5, 60);
    CHECK(odd.rings() == 0);
}

}  // namespace limn::water_wake_test
