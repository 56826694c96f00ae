// Characters that walk, climb, jump, swim and ride: closed forms and what walls must not let
// through.

#include "ecs/base/jobs.h"
#include "ecs/base/rotation.h"
#include "ecs/snapshot.h"
#include "systems/characters/motor_system.h"
#include "tests/near.h"
#include "tests/systems/motor_fixture.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace limn::motor_test {

using namespace limn::test;

namespace {

constexpr double kDt = 1.0 / 60;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Ten steps of `rise` by 0.3 m along +z, from z = 1 on.
MeshData make_flight(float rise) {
    MeshData mesh;
    for (int i = 0; i < 10; ++i) {
        const float z = 1 + 0.3f * static_cast<float>(i);
        add_box(mesh, {-1, -1, z}, {1, rise * static_cast<float>(i + 1), 8});
    }
    return mesh;
}

/// A ramp of this angle along +z from z = 1 on.
MeshData make_ramp(float angle) {
    MeshData mesh;
    mesh.positions = {
        {-3, 0, 1}, {3, 0, 1}, {3, 20 * std::tan(angle), 21}, {-3, 20 * std::tan(angle), 21}};
    mesh.indices = {0, 3, 2, 0, 2, 1};
    return mesh;
}

}  // namespace

TEST_CASE("motor: walks at the wanted speed on level ground, and stops") {
    MotorStage stage;
    stage.step(2);
    stage.go({0, 0, 1.4f});
    stage.step(30);
    const Vec3 from = stage.feet();
    stage.step(60);
    CHECK(double(stage.feet().z - from.z) == near(1.4).epsilon(1e-4));
    CHECK(double(stage.feet().y) == near(0).scale(1).epsilon(1e-5));
    CHECK(stage.state().mode == MotorMode::Stand);
    stage.go(Vec3(0));
    stage.step(30);
    CHECK(stage.state().velocity == Vec3(0));
}

TEST_CASE("motor: turns to where it goes at most as fast as it may, by the shorter way") {
    MotorStage stage({}, {}, {.turn = 3});
    stage.go({-1, 0, 0.2f});
    stage.step(6);
    const Vec3 ahead = stage.world.get<const Transform>(stage.person).rotation * Vec3(0, 0, 1);
    CHECK(double(std::atan2(ahead.x, ahead.z)) == near(-6 * 3 * kDt).epsilon(1e-3));
    stage.world.get<MoveIntent>(stage.person).facing = {0, 0, -1};
    stage.step(90);
    const Vec3 back = stage.world.get<const Transform>(stage.person).rotation * Vec3(0, 0, 1);
    CHECK(double(back.z) == near(-1).epsilon(1e-4));
}

TEST_CASE("motor: slides along a wall with the speed along it, and never enters it") {
    MotorStage stage({make_box_mesh({-50, 0, 2}, {50, 3, 2.2f})});
    stage.go({1, 0, 1});
    double nearest = 10;
    for (int i = 0; i < 240; ++i) {
        stage.step();
        nearest = std::min(nearest, 2 - double(stage.feet().z));
    }
    CHECK(nearest >= 0.28 - 2e-4);
    CHECK(nearest <= 0.28 + 1e-2);
    const Vec3 from = stage.feet();
    stage.step(60);
    CHECK(double(stage.feet().x - from.x) == near(1).epsilon(0.01));
}

TEST_CASE("motor: climbs stairs of its step height without stopping, and no higher ones") {
    MotorStage stage({make_flight(0.17f)});
    stage.go({0, 0, 1.4f});
    float last = 0;
    float fastest = 0;
    for (int i = 0; i < 240; ++i) {
        stage.step();
        CHECK(stage.feet().y >= last - 1e-4f);
        fastest = std::max(fastest, stage.feet().y - last);
        last = stage.feet().y;
    }
    CHECK(double(last) == near(1.7).epsilon(1e-3));
    CHECK(fastest < 0.05f);  // eased: no jump of a whole step
    CHECK(stage.feet().z > 4.5f);
    MotorStage wall({make_flight(0.5f)});
    wall.go({0, 0, 1.4f});
    wall.step(240);
    CHECK(wall.feet().y == 0);
    CHECK(wall.feet().z < 1);
    // And down again.
    MotorStage down({make_flight(0.17f)}, {.position = {0, 1.7f, 5}});
    down.go({0, 0, -1.4f});
    int airborne = 0;
    for (int i = 0; i < 300; ++i) {
        down.step();
        airborne += i > 2 && down.state().mode != MotorMode::Stand ? 1 : 0;
    }
    CHECK(double(down.feet().y) == near(0).scale(1).epsilon(1e-4));
    CHECK(airborne == 0);
}

TEST_CASE("motor: walks up slopes that it may stand on, and slides down steeper ones") {
    MotorStage gentle({make_ramp(radians(40))});
    gentle.go({0, 0, 1.4f});
    gentle.step(300);
    CHECK(gentle.feet().z > 5);
    CHECK(
        double(gentle.feet().y)
        == near(double(gentle.feet().z - 1) * std::tan(double(radians(40)))).epsilon(0.01));
    gentle.go(Vec3(0));
    gentle.step(20);
    const Vec3 rest = gentle.feet();
    gentle.step(120);
    CHECK(double(glm::distance(gentle.feet(), rest)) < 1e-3);
    MotorStage steep({make_ramp(radians(60))}, {.position = {0, 5, 3}});
    steep.step(180);
    CHECK(steep.feet().y < 0.2f);
    steep.go({0, 0, 1.4f});
    steep.step(180);
    CHECK(steep.feet().y < 0.5f);
}

TEST_CASE("motor: falls as bodies do, and jumps as high as it says, once") {
    MotorStage fall({}, {.position = {0, 20, 0}});
    fall.step(61);
    // Speeds before positions: y = -g dt^2 n (n + 1) / 2.
    CHECK(20 - double(fall.feet().y) == near(9.81 * kDt * kDt * 61 * 62 / 2).epsilon(1e-4));
    MotorStage stage({}, {}, {.jump = 1.2f});
    stage.step(3);
    stage.world.get<MoveIntent>(stage.person).jump = true;
    double top = 0;
    int flights = 0;
    bool flew = false;
    for (int i = 0; i < 180; ++i) {
        stage.step();
        top = std::max(top, double(stage.feet().y));
        const bool flies = stage.state().mode == MotorMode::Fall;
        flights += flies && !flew ? 1 : 0;
        flew = flies;
    }
    CHECK(top == near(1.2).epsilon(1e-3));
    CHECK(flights == 1);
    CHECK(stage.feet().y == 0);
}

TEST_CASE("motor: may still jump right after an edge, and not long after it") {
    for (const int late : {3, 12}) {
        MotorStage stage({make_box_mesh({-1, 0, -3}, {1, 5, 1})}, {.position = {0, 5, 0}});
        stage.go({0, 0, 3});
        do {
            stage.step();
        } while (stage.state().mode != MotorMode::Fall || stage.feet().z < 1);
        stage.step(late);
        stage.world.get<MoveIntent>(stage.person).jump = true;
        stage.step();
        CHECK((stage.state().velocity.y > 1) == (late == 3));
    }
}

TEST_CASE("motor: a ceiling ends a jump") {
    MotorStage stage({make_box_mesh({-5, 2, -5}, {5, 3, 5})}, {}, {.jump = 2});
    stage.step(3);
    stage.world.get<MoveIntent>(stage.person).jump = true;
    double top = 0;
    for (int i = 0; i < 90; ++i) {
        stage.step();
        top = std::max(top, double(stage.feet().y));
    }
    CHECK(top == near(0.25).epsilon(0.02));
}

TEST_CASE("motor: ground that moves and turns carries it along") {
    MotorStage stage({make_box_mesh({-3, 0.5f, -3}, {3, 1, 3})}, {.position = {1, 1, 0.5f}});
    Entity deck{};
    stage.world.query<const MeshInstance>().each(
        [&](Entity entity, const MeshInstance&) { deck = entity; });
    stage.step(5);
    const auto on_deck = [&] {
        const Transform at = stage.world.get<const Transform>(deck);
        return glm::inverse(at.rotation) * (stage.feet() - at.position);
    };
    const Vec3 before = on_deck();
    for (int i = 0; i < 120; ++i) {
        auto& at = stage.world.get<Transform>(deck);
        at.position = {
            0.02f * static_cast<float>(i), 0.3f * std::sin(0.05f * static_cast<float>(i)), 0};
        at.rotation = rotation_about({0, 1, 0}, 0.01f * static_cast<float>(i));
        stage.step();
        CHECK(double(glm::distance(on_deck(), before)) < 2e-3);
    }
    const Vec3 ahead = stage.world.get<const Transform>(stage.person).rotation * Vec3(0, 0, 1);
    CHECK(double(std::atan2(ahead.x, ahead.z)) == near(1.19).epsilon(2e-3));
    CHECK(stage.state().velocity == Vec3(0));
}

TEST_CASE("motor: wades slowly, swims in deep water, dives and comes up again") {
    MotorStage stage({make_box_mesh({-30, -6, -30}, {30, -5, 30})}, {.position = {0, -4, 0}});
    stage.world.query<const Walkable, Without<MeshInstance>>().each(
        [&](Entity entity, const Walkable&) {
            stage.world.get<Transform>(entity).position.y = -5;
        });
    const Entity water = stage.world.create(Transform{}, Water{.size = {60, 60}, .depth = 6});
    stage.step(240);
    CHECK(stage.state().mode == MotorMode::Swim);
    CHECK(double(stage.feet().y) == near(-0.84 * 1.75).epsilon(0.02));
    stage.go({3, 0, 0});
    stage.step(60);
    const Vec3 from = stage.feet();
    stage.step(60);
    CHECK(double(stage.feet().x - from.x) == near(1.1).epsilon(0.02));
    stage.go({0, -2, 0});
    stage.step(120);
    CHECK(stage.feet().y < -2.5f);
    CHECK(stage.feet().y >= -5);
    stage.go(Vec3(0));
    stage.step(360);
    CHECK(double(stage.feet().y) == near(-0.84 * 1.75).epsilon(0.02));
    // Knee-deep.
    stage.world.get<Transform>(water).position.y = -5 + 0.7f;
    stage.world.get<Transform>(stage.person).position = {0, -5, 0};
    stage.go({1.4f, 0, 0});
    stage.step(60);
    CHECK(stage.state().mode == MotorMode::Stand);
    const Vec3 wading = stage.feet();
    stage.step(60);
    CHECK(stage.feet().x - wading.x < 1.1f);
    CHECK(stage.feet().x - wading.x > 0.5f);
}

TEST_CASE("motor: one that starts inside a wall comes out") {
    MotorStage stage(
        {make_box_mesh({-0.4f, 0, -0.4f}, {0.4f, 3, 0.4f})}, {.position = {0.1f, 0, 0}});
    stage.step(30);
    CHECK(is_finite(stage.feet()));
    const Vec3 out = glm::abs(stage.feet());
    CHECK(std::max(out.x, out.z) >= 0.4f + 0.28f - 1e-3f);
}

TEST_CASE("motor: steps of 0 and of 1 s, thin walls at high speed, values that are not finite") {
    MotorStage stage({make_box_mesh({-9, 0, 3}, {9, 4, 3.02f})}, {}, {.acceleration = 1000});
    stage.step(2);
    stage.world.get<MoveIntent>(stage.person).velocity = {0, 0, 40};
    stage.world.resource<FrameTime>().step = 0;
    const Vec3 before = stage.feet();
    stage.step(3);
    CHECK(stage.feet() == before);
    stage.world.resource<FrameTime>().step = 1;
    stage.step(3);
    CHECK(stage.feet().z < 3 - 0.27f);
    CHECK(stage.feet().z > 2);
    stage.world.resource<FrameTime>().step = 1.0f / 60;
    stage.world.get<MoveIntent>(stage.person) = {.velocity = Vec3(kNan), .facing = Vec3(kNan)};
    stage.step(3);
    CHECK(is_finite(stage.feet()));
    const Vec3 safe = stage.feet();
    stage.world.get<CharacterMotor>(stage.person).height = kNan;
    stage.go({0, 0, -1});
    stage.step(3);
    CHECK(stage.feet() == safe);
}

TEST_CASE("motor: the same bits on 1, 2, 3 and 7 threads, and after a snapshot in mid-jump") {
    const int before = thread_count();
    std::vector<Vec3> ends;
    for (const int threads : {1, 2, 3, 7}) {
        set_thread_count(threads);
        MotorStage stage({make_flight(0.17f)});
        stage.go({0.1f, 0, 2});
        stage.step(40);
        stage.world.get<MoveIntent>(stage.person).jump = true;
        stage.step(10);
        CHECK(stage.state().mode == MotorMode::Fall);
        const Result<std::vector<std::byte>> saved = save_snapshot(stage.world);
        REQUIRE(saved.ok());
        stage.step(60);
        ends.push_back(stage.feet());
        MotorStage again({make_flight(0.17f)});
        REQUIRE(restore_snapshot(again.world, *saved).ok());
        again.step(60);
        CHECK(again.feet() == stage.feet());
    }
    set_thread_count(before);
    for (const Vec3& end : ends) {
        CHECK(end == ends[0]);
    }
}

}  // namespace limn::motor_test
