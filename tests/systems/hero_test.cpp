// A hero that the player moves, what it carries, and a camera that does not pass through walls.

#include "ecs/base/rng.h"
#include "ecs/base/rotation.h"
#include "systems/characters/hero_system.h"
#include "systems/characters/loose_body_system.h"
#include "systems/orbit_camera_system.h"
#include "tests/near.h"
#include "tests/systems/motor_fixture.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace limn::hero_test {

using namespace limn::test;

namespace {

struct HeroStage : MotorStage {
    explicit HeroStage(std::vector<MeshData> meshes = {}) : MotorStage(std::move(meshes)) {
        world.add(person, Hero{});
        step(2);
    }
    void press(std::string_view action) {
        set_action(world.resource<Input>(), action);
        step();
        set_action(world.resource<Input>(), action, 0);
        step();
    }
    Entity add_ball(const Vec3& at, const LooseBody& body = {}) {
        return world.create(Transform{.position = at}, body);
    }
    [[nodiscard]] Vec3 ahead() {
        return world.get<const Transform>(person).rotation * Vec3(0, 0, 1);
    }
    [[nodiscard]] Vec3 at(Entity entity) { return world.get<const Transform>(entity).position; }
};

/// A closed room about the origin, 4 m wide, with a pillar.
MeshData make_room() {
    MeshData mesh;
    add_box(mesh, {-2.5f, 0, -2.5f}, {2.5f, 3, -2});
    add_box(mesh, {-2.5f, 0, 2}, {2.5f, 3, 2.5f});
    add_box(mesh, {-2.5f, 0, -2.5f}, {-2, 3, 2.5f});
    add_box(mesh, {2, 0, -2.5f}, {2.5f, 3, 2.5f});
    add_box(mesh, {-2.5f, 3, -2.5f}, {2.5f, 3.2f, 2.5f});
    add_box(mesh, {0.8f, 0, 0.8f}, {1.1f, 3, 1.1f});
    return mesh;
}

}  // namespace

TEST_CASE("hero: walks and runs in the directions of the camera") {
    HeroStage stage;
    const Entity camera = stage.world.create(
        Transform{.position = {5, 2, 0}, .rotation = rotation_about({0, 1, 0}, kPi / 2)}, Camera{});
    stage.world.get<Hero>(stage.person).camera = camera;
    stage.step();
    auto& input = stage.world.resource<Input>();
    set_action(input, "hero_forward");  // the camera looks along -x
    stage.step(60);
    CHECK(double(stage.state().velocity.x) == near(-1.4).epsilon(1e-3));
    set_action(input, "hero_run");
    stage.step(60);
    CHECK(double(stage.state().velocity.x) == near(-4.2).epsilon(1e-3));
    set_action(input, "hero_forward", 0);
    set_action(input, "hero_right");
    stage.step(120);
    CHECK(double(stage.state().velocity.z) == near(-4.2).epsilon(1e-3));
    set_action(input, "hero_right", 0.25f);  // a stick, pressed a little
    set_action(input, "hero_run", 0);
    stage.step(120);
    CHECK(double(stage.state().velocity.z) == near(-0.35).epsilon(1e-3));
}

TEST_CASE("hero: jumps once a press") {
    HeroStage stage;
    set_action(stage.world.resource<Input>(), "hero_jump");
    int takeoffs = 0;
    MotorMode last = MotorMode::Stand;
    for (int i = 0; i < 180; ++i) {
        stage.step();
        takeoffs += last == MotorMode::Stand && stage.state().mode == MotorMode::Fall ? 1 : 0;
        last = stage.state().mode;
    }
    CHECK(takeoffs == 1);
}

TEST_CASE("hero: picks up the nearest body ahead that is not too heavy, and throws it") {
    HeroStage stage;
    const Entity behind = stage.add_ball({0, 0.2f, -0.6f});
    const Entity heavy = stage.add_ball({0, 0.2f, 0.7f}, {.mass = 60});
    const Entity ball = stage.add_ball({0.1f, 0.2f, 1.2f});
    stage.press("hero_carry");
    CHECK(stage.world.get<const Hero>(stage.person).carried == ball);
    stage.step(60);
    CHECK(stage.at(ball).y == near(0.6 * 1.75).epsilon(1e-3));
    CHECK(stage.at(behind).y == near(0.2).epsilon(1e-2));
    CHECK(stage.at(heavy).y == near(0.2).epsilon(1e-2));
    stage.press("hero_carry");
    CHECK(stage.world.get<const Hero>(stage.person).carried.is_null());
    const Vec3 speed = stage.world.get<const LooseState>(ball).velocity;
    CHECK(double(glm::length(speed)) == near(7).epsilon(0.05));
    CHECK(speed.z > 5);
    stage.step(240);
    CHECK(stage.at(ball).z > 3);
    CHECK(double(stage.at(ball).y) == near(0.2).epsilon(1e-2));
}

TEST_CASE("hero: turns, and throws where the camera looks") {
    HeroStage stage;
    const auto look = [&](float pitch) {
        return rotation_about({0, 1, 0}, kPi / 2) * rotation_about({1, 0, 0}, pitch);
    };
    const Entity camera =
        stage.world.create(Transform{.position = {5, 2, 0}, .rotation = look(0)}, Camera{});
    stage.world.get<Hero>(stage.person).camera = camera;
    std::array<float, 2> rises = {};
    for (std::size_t i = 0; i < 2; ++i) {
        const Entity ball = stage.add_ball(stage.feet() + stage.ahead() * 0.8f + Vec3(0, 0.2f, 0));
        stage.world.get<Transform>(camera).rotation = look(i == 0 ? -0.2f : 0.3f);
        stage.step();
        stage.press("hero_carry");
        stage.step(60);
        REQUIRE(stage.world.get<const Hero>(stage.person).carried == ball);
        const float off = std::acos(std::clamp(-stage.ahead().x, -1.0f, 1.0f));
        set_action(stage.world.resource<Input>(), "hero_carry");
        int steps = 0;
        for (; steps < 90 && !stage.world.get<const Hero>(stage.person).carried.is_null();
             ++steps) {
            stage.step();
        }
        set_action(stage.world.resource<Input>(), "hero_carry", 0);
        const Vec3 speed = stage.world.get<const LooseState>(ball).velocity;
        CHECK(double(glm::length(speed)) == near(7).epsilon(0.05));
        CHECK(speed.x < 0);  // the camera looks along -x
        CHECK(std::abs(speed.z) < 0.02f * std::abs(speed.x));
        CHECK(static_cast<float>(steps) > 60 * (off - 0.5f) / CharacterMotor{}.turn);
        rises[i] = std::atan2(speed.y, -speed.x);
        stage.world.destroy(ball);
        stage.step(30);
    }
    CHECK(double(rises[1] - rises[0]) == near(0.5).epsilon(0.05));  // as the view
}

TEST_CASE("hero: turns to what is behind, and picks it up") {
    HeroStage stage;
    const Entity ball = stage.add_ball({0.2f, 0.2f, -0.8f});
    stage.press("hero_carry");
    CHECK(stage.world.get<const Hero>(stage.person).carried.is_null());
    stage.step(60);
    CHECK(stage.world.get<const Hero>(stage.person).carried == ball);
    CHECK(stage.ahead().z < -0.9f);
    // Nothing in reach: it stays as it is.
    stage.press("hero_carry");
    stage.step(120);
    const Vec3 before = stage.ahead();
    REQUIRE(glm::distance(stage.at(ball), stage.feet()) > 2);
    stage.press("hero_carry");
    stage.step(60);
    CHECK(stage.world.get<const Hero>(stage.person).carried.is_null());
    CHECK(glm::distance(stage.ahead(), before) < 1e-4f);
}

TEST_CASE("hero: is back where it stood when it has fallen off the world") {
    HeroStage stage({make_box_mesh({-2, 4, -2}, {2, 5, 2})});
    std::vector<Entity> planes;
    stage.world.query<const Walkable, Without<MeshInstance>>().each(
        [&](Entity entity, const Walkable&) { planes.push_back(entity); });
    for (const Entity plane : planes) {
        stage.world.destroy(plane);
    }
    stage.world.get<Transform>(stage.person).position = {0, 5, 0};
    stage.step(30);
    REQUIRE(stage.state().mode == MotorMode::Stand);
    set_action(stage.world.resource<Input>(), "hero_forward");
    float lowest = 5;
    for (int i = 0; i < 400; ++i) {
        stage.step();
        lowest = std::min(lowest, stage.feet().y);
        if (lowest < 0 && stage.feet().y > 4) {
            set_action(stage.world.resource<Input>(), "hero_forward", 0);
        }
    }
    CHECK(lowest < -10);
    CHECK(stage.state().mode == MotorMode::Stand);
    CHECK(double(stage.feet().y) == near(5).epsilon(1e-3));
    CHECK(std::abs(stage.feet().z) < 1.8f);
    // Not one that shall not.
    stage.world.get<Hero>(stage.person).lost = 0;
    set_action(stage.world.resource<Input>(), "hero_forward");
    stage.step(600);
    CHECK(stage.feet().y < -50);
}

TEST_CASE("hero: what it picks up waits for the hands, then rises without a jump") {
    HeroStage stage;
    const Entity ball = stage.add_ball({0, 0.2f, 0.8f});
    stage.press("hero_carry");
    stage.step(6);
    CHECK(stage.at(ball).y < 0.25f);
    float largest = 0;
    for (int i = 0; i < 60; ++i) {
        const Vec3 before = stage.at(ball);
        stage.step();
        largest = std::max(largest, glm::distance(stage.at(ball), before));
    }
    CHECK(stage.at(ball).y > 1.0f);
    CHECK(largest < 0.09f);
}

TEST_CASE("hero: what it carries falls when it is gone") {
    HeroStage stage;
    const Entity ball = stage.add_ball({0, 0.2f, 0.8f});
    stage.press("hero_carry");
    stage.step(60);
    REQUIRE(stage.at(ball).y > 0.9f);
    stage.world.destroy(stage.person);
    stage.step(90);
    CHECK(double(stage.at(ball).y) == near(0.2).epsilon(1e-2));
    CHECK(stage.world.get<const LooseState>(ball).carrier.is_null());
}

TEST_CASE("loose body: bounces to the square of its restitution, and rests") {
    HeroStage stage;
    const Entity ball = stage.add_ball({5, 1.2f, 0}, {.bounce = 0.7f});
    bool hit = false;
    double top = 0;
    for (int i = 0; i < 70; ++i) {
        stage.step();
        hit = hit || stage.world.get<const LooseState>(ball).velocity.y > 1;
        top = hit ? std::max(top, double(stage.at(ball).y) - 0.2) : 0;
    }
    CHECK(top == near(0.49).epsilon(0.06));  // of 1 m; a step is up to 0.07 m long there
    stage.step(600);
    CHECK(double(stage.at(ball).y) == near(0.2).epsilon(1e-3));
    CHECK(double(glm::length(stage.world.get<const LooseState>(ball).velocity)) < 0.2);
}

TEST_CASE("loose body: a crate that slides stops after v^2 / (2 mu g)") {
    HeroStage stage;
    const Entity crate = stage.add_ball({3, 0.2f, 0}, {.friction = 0.5f, .rolls = false});
    stage.step(2);
    stage.world.get<LooseState>(crate).velocity = {3, 0, 0};
    const float from = stage.at(crate).x;
    stage.step(180);
    CHECK(double(stage.at(crate).x - from) == near(9 / (2 * 0.5 * 9.81)).epsilon(0.04));
}

TEST_CASE("loose body: rolls without slipping") {
    HeroStage stage;
    const Entity ball = stage.add_ball({3, 0.2f, 0});
    stage.step(2);
    stage.world.get<LooseState>(ball).velocity = {1, 0, 0};
    const float from = stage.at(ball).x;
    stage.step(30);
    const float way = stage.at(ball).x - from;
    const Quat turned = stage.world.get<const Transform>(ball).rotation;
    const AxisAngle turn = axis_angle(turned);
    CHECK(double(turn.angle) == near(double(way) / 0.2).epsilon(0.01));
    CHECK(double(turn.axis.z) == near(-1).epsilon(1e-3));
}

TEST_CASE("loose body: does not pass through a thin wall at 60 m/s, and floats") {
    HeroStage stage({make_box_mesh({5, 0, -5}, {5.02f, 5, 5})});
    const Entity ball = stage.add_ball({1, 1, 0});
    stage.step();
    stage.world.get<LooseState>(ball).velocity = {60, 0, 0};
    stage.step(60);
    CHECK(stage.at(ball).x < 4.81f);
    stage.world.create(Transform{.position = {0, 2, 0}}, Water{.size = {60, 60}, .depth = 6});
    stage.step(600);
    CHECK(double(stage.at(ball).y) == near(2).epsilon(0.02));  // half as dense: half above
}

TEST_CASE("loose body: characters push it ahead, and bodies push each other apart") {
    HeroStage stage;
    const Entity ball = stage.add_ball({0, 0.2f, 1.2f});
    const Entity other = stage.add_ball({0, 0.2f, 1.4f});
    stage.step(30);
    CHECK(glm::distance(stage.at(ball), stage.at(other)) >= 0.4f - 1e-3f);
    set_action(stage.world.resource<Input>(), "hero_forward");
    for (int i = 0; i < 120; ++i) {
        stage.step();
        const Vec3 apart = stage.at(ball) - stage.feet();
        CHECK(std::hypot(apart.x, apart.z) >= 0.28f + 0.2f - 0.08f);  // it is lower than the widest
    }
    CHECK(stage.at(ball).z > 2.5f);
}

TEST_CASE("follow camera: in a room it never leaves the room, and keeps its clearance") {
    const MeshData mesh = make_room();
    const MeshBvh bvh = build_mesh_bvh(mesh.positions, mesh.indices);
    PlacedGround room;
    room.mesh = &bvh;
    const Vec3 head = {0.3f, 1.6f, -0.2f};
    Random random(78, 0, 0, 0);
    int shortened = 0;
    for (int i = 0; i < 500; ++i) {
        const Vec3 wanted =
            head
            + 4.0f * Vec3{random.uniform(-1, 1), random.uniform(0, 0.5f), random.uniform(-1, 1)};
        const Vec3 found = clear_view({&room, 1}, head, wanted, 0.2f);
        CHECK(std::abs(found.x) < 2 - 0.1f);
        CHECK(std::abs(found.z) < 2 - 0.1f);
        CHECK(found.y < 3 - 0.1f);
        const Vec3 way = wanted - head;
        CHECK(glm::length(glm::cross(found - head, way)) <= 1e-3f * glm::length(way));
        shortened += glm::distance(found, wanted) > 1e-3f ? 1 : 0;
    }
    CHECK(shortened > 200);
    const Vec3 near_by = head + Vec3(0, 0.1f, 0.5f);
    CHECK(glm::distance(clear_view({&room, 1}, head, near_by, 0.2f), near_by) < 1e-5f);
    CHECK(clear_view({&room, 1}, head, head, 0.2f) == head);
}

}  // namespace limn::hero_test
