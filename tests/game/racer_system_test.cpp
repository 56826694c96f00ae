#include "content/game/game.h"
#include "content/game/racer_system.h"
#include "ecs/components/camera.h"
#include "ecs/components/motion_blur.h"
#include "ecs/world.h"
#include "systems/update_world.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>

namespace limn::racer_system_test {

namespace {

/// A circle of radius 100, driven counter-clockwise: it bends to the left.
PathData circle() {
    constexpr float k = 100 * 0.5522847f;
    PathShape shape;
    shape.closed = true;
    shape.knots = {
        {{100, 0, 0}, {0, 0, k}, {0, 0, -k}, 0},
        {{0, 0, -100}, {k, 0, 0}, {-k, 0, 0}, 0},
        {{-100, 0, 0}, {0, 0, -k}, {0, 0, k}, 0},
        {{0, 0, 100}, {-k, 0, 0}, {k, 0, 0}, 0}};
    return *make_path(shape);
}
PathData straight() {
    PathShape shape;
    shape.knots.resize(2);
    shape.knots[1].position = {0, 0, 10000};
    return *make_path(shape);
}

constexpr float kStep = 1.0f / 60;

struct TestRacer : RacerState {
    Racer settings;

    void run(const PathData& track, const Driving& driving, float seconds) {
        for (int i = 0; i < static_cast<int>(seconds * 60); ++i) {
            step_racer(settings, track, driving, kStep, *this);
        }
    }
};

struct Race {
    Race() {
        world.insert_resource(Assets{}).paths = {circle(), straight()};
        schedule = make_world_schedule(add_game_systems);
    }
    Entity add(const Racer& racer) { return world.create(Transform{}, racer); }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) {
            step_world(world, schedule);
        }
    }
    World world;
    Schedule schedule;
};

}  // namespace

TEST_CASE("racer: full throttle ends at the top speed, a boost at its own, brakes at rest") {
    const PathData track = straight();
    TestRacer racer;
    racer.run(track, {.throttle = 1}, 1);
    CHECK(racer.speed > 15);  // 20 m/s^2 at first
    CHECK(racer.speed < 20);
    racer.run(track, {.throttle = 1}, 20);
    CHECK(racer.speed == test::near(racer.settings.top_speed).epsilon(0.01));
    racer.run(track, {.throttle = 1, .boost = true}, 3);
    CHECK(racer.speed > 0.97f * racer.settings.boost_speed);
    CHECK(racer.speed < racer.settings.boost_speed);
    racer.run(track, {.throttle = -1}, 3);
    CHECK(racer.speed == 0);
    const double stood = racer.distance;
    racer.run(track, {.throttle = -1}, 1);
    CHECK(racer.distance == stood);
}

TEST_CASE("racer: boosts last four seconds, and come back in twelve") {
    const PathData track = straight();
    TestRacer racer;
    racer.run(track, {.boost = true}, 3.9f);
    CHECK(racer.boosting);
    racer.run(track, {.boost = true}, 0.2f);
    CHECK(racer.energy < 0.01f);
    racer.run(track, {}, 6);
    CHECK(racer.energy == test::near(0.5).epsilon(0.03));
    racer.run(track, {}, 7);
    CHECK(racer.energy == 1);
}

TEST_CASE("racer: it turns and leans to the side it is steered to, and straightens itself") {
    const PathData track = straight();
    for (const float side : {-1.0f, 1.0f}) {
        TestRacer racer{{.speed = 30}, {.half_width = 100}};
        racer.run(track, {.throttle = 0.5f, .steer = side}, 0.5f);
        CHECK(racer.heading * side > 0.3f);
        CHECK(racer.lateral * side > 1);
        CHECK(racer.lean * side > 0.1f);
        racer.run(track, {.throttle = 0.5f}, 3);
        CHECK(std::abs(racer.heading) < 0.01f);
        CHECK(std::abs(racer.lean) < 0.02f);
    }
}

TEST_CASE("racer: bends carry it outward, the inner lane is shorter, and walls hold") {
    const PathData track = circle();
    TestRacer racer{{.speed = 50}, {}};
    racer.run(track, {.throttle = 0.7f}, 1);
    CHECK(racer.lateral > 0.5f);  // the bend is to the left
    racer.run(track, {.throttle = 1}, 10);
    CHECK(racer.lateral == racer.settings.half_width);
    CHECK(racer.speed < 0.9f * racer.settings.top_speed);
    RacerState inside{.lateral = -5, .speed = 20};
    RacerState outside{.lateral = 5, .speed = 20};
    step_racer({.half_width = 6}, track, {}, kStep, inside);
    step_racer({.half_width = 6}, track, {}, kStep, outside);
    CHECK(inside.distance / outside.distance == test::near(1.05 / 0.95).epsilon(0.01));
}

TEST_CASE_FIXTURE(Race, "racer: on autopilot it keeps its lane, lap after lap, within its grip") {
    const Entity entity = add({.track = {0}, .lane = -2});
    start_world(world, add_game_systems);
    run(600);
    for (int i = 0; i < 600; ++i) {
        run(1);
        const RacerState& racer = world.get<RacerState>(entity);
        REQUIRE(std::abs(racer.lateral + 2) < 1.0f);
        // sqrt(40 * 100) = 63 m/s is more than it can.
        REQUIRE(racer.speed > 50);
        REQUIRE(racer.speed < 60.1f);
    }
    const RacerState& racer = world.get<RacerState>(entity);
    const Vec3 at = world.get<Transform>(entity).position;
    CHECK(glm::length(Vec2(at.x, at.z)) == test::near(100 + racer.lateral).epsilon(0.002));
    CHECK(at.y == test::near(Racer{}.height).epsilon(0.1));
}

TEST_CASE_FIXTURE(Race, "racer: faster racers overtake slower ones") {
    const Entity slow = add({.track = {1}, .distance = 60, .top_speed = 20, .lane = 0.5f});
    const Entity fast = add({.track = {1}, .top_speed = 40, .lane = 0.5f});
    start_world(world, add_game_systems);
    float nearest = 1e9f;
    for (int i = 0; i < 600; ++i) {
        run(1);
        nearest = std::min(
            nearest, glm::distance(
                         world.get<Transform>(slow).position, world.get<Transform>(fast).position));
    }
    CHECK(world.get<RacerState>(fast).distance > world.get<RacerState>(slow).distance + 50);
    CHECK(nearest > 1.8f);
    CHECK(std::abs(world.get<RacerState>(fast).lateral - 0.5f) < 0.3f);  // and back to its lane
}

TEST_CASE_FIXTURE(Race, "racer: a player's racer is on autopilot until somebody steers") {
    const Entity mine = add({.track = {1}, .player = true});
    const Entity other = add({.track = {1}, .lane = 4});
    start_world(world, add_game_systems);
    run(60);
    CHECK(world.get<RacerState>(mine).speed > 10);
    CHECK(!world.get<RacerState>(mine).player_active);
    set_action(world.resource<Input>(), "brake");
    run(120);
    CHECK(world.get<RacerState>(mine).player_active);
    CHECK(world.get<RacerState>(mine).speed == 0);
    CHECK(world.get<RacerState>(other).speed > 20);
    world.resource<Input>() = {};
    run(60);
    CHECK(world.get<RacerState>(mine).speed == 0);  // it does not take over again
}

TEST_CASE_FIXTURE(Race, "racer: the field of view and the shutter widen with speed") {
    const Entity racer = add({.track = {1}, .speed = 90});
    const Entity camera = world.create(Camera{}, SpeedView{.racer = racer});
    start_world(world, add_game_systems);
    world.run(update_speed_views);
    CHECK(world.get<Camera>(camera).fov_y == test::near(radians(72.0f)));
    CHECK(world.find_resource<MotionBlur>() == nullptr);
    world.insert_resource(MotionBlur{});
    world.get<RacerState>(racer).speed = 0;
    world.run(update_speed_views);
    CHECK(world.get<Camera>(camera).fov_y == test::near(radians(50.0f)));
    CHECK(world.resource<MotionBlur>().shutter == test::near(120));
    world.get<SpeedView>(camera).racer = Entity{};
    world.run(update_speed_views);
    CHECK(world.resource<MotionBlur>().shutter == test::near(120));
}

TEST_CASE_FIXTURE(Race, "racer: without its track it stays put") {
    const Entity entity = add({.track = {9}, .speed = 5});
    start_world(world, add_game_systems);
    run(3);
    CHECK(world.get<RacerState>(entity).distance == 0);
    CHECK(world.get<Transform>(entity).position == Vec3(0));
}

}  // namespace limn::racer_system_test
