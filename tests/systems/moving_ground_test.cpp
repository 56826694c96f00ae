// Characters on ground that moves: a deck that sails, turns, heaves and rolls.

#include "ecs/base/gravity.h"
#include "ecs/base/rotation.h"
#include "ecs/components/attach.h"
#include "ecs/components/foot_plant.h"
#include "ecs/hierarchy.h"
#include "systems/attach_system.h"
#include "systems/characters/ground_ride.h"
#include "tests/near.h"
#include "tests/systems/hero_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace limn::moving_ground_test {

using namespace limn::test;

namespace {

constexpr float kFrame = 1.0f / 60;

/// How a deck moves.
struct Sea {
    float speed = 0.0f;  ///< [m/s]
    float turn = 0.0f;   ///< [rad/s]
    float heave = 0.0f;  ///< [m]
    float roll = 0.0f;   ///< [rad]
};

Transform deck_at(const Sea& sea, float time) {
    const Quat yaw = rotation_about({0, 1, 0}, sea.turn * time);
    return {
        .position =
            {sea.speed * time, 10 + sea.heave * std::sin(2 * time), 0.5f * sea.speed * time},
        .rotation = yaw * rotation_about({0, 0, 1}, sea.roll * std::sin(1.3f * time))};
}

/// A person on a deck of 80 m, in its middle, under way after a second.
template <typename Stage>
struct DeckStage : Stage {
    Sea sea;
    Entity deck{};
    float time = 0;

    explicit DeckStage(const Sea& on, bool plants = false)
        : Stage({make_box_mesh({-40, -1, -40}, {40, 0, 40})}), sea(on) {
        this->world.template query<const MeshInstance>().each(
            [&](Entity entity, const MeshInstance&) { deck = entity; });
        if (plants) {
            this->world.add(this->person, FootPlant{.softness = 0});
        }
        this->world.template get<Transform>(deck) = deck_at(sea, 0);
        this->step();
        this->world.template get<Transform>(this->person).position = {0, 10, 0};
        this->world.template get<MotorState>(this->person) = {};
        for (int i = 0; i < 30; ++i) {
            this->step();
        }
    }
    void sail(int count = 1) {
        for (int i = 0; i < count; ++i) {
            time += kFrame;
            this->world.template get<Transform>(deck) = deck_at(sea, time);
            this->step();
        }
    }
    /// Relative to the deck.
    [[nodiscard]] Vec3 on_deck(const Vec3& point) const {
        const Transform at = deck_at(sea, time);
        return glm::conjugate(at.rotation) * (point - at.position);
    }
    /// Walks in a direction of the deck.
    void go_on_deck(const Vec3& velocity) {
        this->go(deck_at({.turn = sea.turn}, time).rotation * velocity);
    }
};

const std::vector<Vec3> kStroll = {
    Vec3(0), Vec3(0, 0, 1.4f), Vec3(1, 0, 1), Vec3(1.4f, 0, 0), Vec3(0)};
const std::vector<Vec3> kRun = {
    Vec3(0), Vec3(0, 0, 1.4f), Vec3(1.4f, 0, 0), Vec3(0, 0, 4.2f), Vec3(0)};

struct Stroll {
    float slide = 0;  ///< longest way of a planted foot on the deck [m]
    float jerk = 0;   ///< largest second difference of joints, relative to the deck [m]
    int planted = 0;
};

/// Of a foot: whether it is on the ground, and points of which one stays.
struct FootLook {
    bool planted = false;
    std::array<Vec3, 2> points{};
};

FootLook look_at_foot(MatchedStage& stage, std::uint32_t side) {
    return {stage.is_planted(side), stage.sole(side)};
}

FootLook look_at_foot(PoseStage& stage, std::uint32_t side) {
    const Vec3 print = stage.walk().feet[side].place;
    return {flight_progress(stage.walk(), side) >= 1, {print, print}};
}

template <typename Stage>
Stroll stroll(DeckStage<Stage>& stage, const std::vector<Vec3>& tour) {
    std::array<std::array<Vec3, 2>, 2> before{};
    std::array<float, 2> way{};
    std::array<bool, 2> was{};
    std::array<std::array<Vec3, 3>, 6> shown{};
    Stroll found;
    int frame = 0;
    for (const Vec3& wanted : tour) {
        for (int i = 0; i < 120; ++i, ++frame) {
            stage.go_on_deck(wanted);
            stage.sail();
            for (std::uint32_t side = 0; side < 2; ++side) {
                const auto [planted, points] = look_at_foot(stage, side);
                std::array<Vec3, 2> now = points;
                std::array<float, 2> moved{};
                for (std::size_t k = 0; k < 2; ++k) {
                    now[k] = stage.on_deck(now[k]);
                    const Vec3 off = now[k] - before[side][k];
                    moved[k] = std::hypot(off.x, off.z);
                }
                way[side] = planted && was[side] ? way[side] + std::min(moved[0], moved[1]) : 0.0f;
                was[side] = planted;
                before[side] = now;
                found.planted += planted ? 1 : 0;
                found.slide = std::max(found.slide, way[side]);
            }
            const WalkBody& body = stage.body();
            const std::array<std::uint16_t, 6> joints = {body.hips,         body.head,
                                                         body.legs[0].shin, body.legs[1].shin,
                                                         body.legs[0].foot, body.legs[1].foot};
            for (std::size_t k = 0; k < joints.size(); ++k) {
                std::array<Vec3, 3>& last = shown[k];
                std::rotate(last.begin(), last.begin() + 2, last.end());
                last[0] = stage.on_deck(stage.joint(joints[k]));
                if (frame > 2) {
                    found.jerk =
                        std::max(found.jerk, glm::length(last[0] - 2.0f * last[1] + last[2]));
                }
            }
        }
    }
    return found;
}

constexpr Sea kFerry = {.speed = 3, .turn = 0.5f, .heave = 0.4f};

}  // namespace

TEST_CASE(
    "moving ground: planted feet of one who walks by motion matching stay where they are on a deck "
    "that sails, heaves and turns"
    * technique("char.blend")) {
    DeckStage<MatchedStage> still({});
    const Stroll usual = stroll(still, kRun);
    for (const bool plants : {false, true}) {
        CAPTURE(plants);
        DeckStage<MatchedStage> stage(kFerry, plants);
        const Stroll found = stroll(stage, kRun);
        CHECK(found.planted > 500);
        CHECK(found.slide < 0.002f);
        CHECK(found.jerk < usual.jerk + 0.003f);
        CHECK(std::abs(stage.on_deck(stage.feet()).y) < 1e-3f);
    }
}

TEST_CASE("moving ground: so do those of one who walks by prints" * technique("char.foot-flight")) {
    DeckStage<PoseStage> still({});
    const Stroll usual = stroll(still, kStroll);
    for (const bool plants : {false, true}) {
        CAPTURE(plants);
        DeckStage<PoseStage> stage(kFerry, plants);
        const Stroll found = stroll(stage, kStroll);
        CHECK(found.planted > 500);
        CHECK(found.slide < 0.002f);
        CHECK(found.jerk < 1.1f * usual.jerk);
    }
}

TEST_CASE("moving ground: soles hardly move on a deck that rolls as well") {
    DeckStage<MatchedStage> stage({.speed = 2, .turn = 0.2f, .heave = 0.3f, .roll = 0.1f}, true);
    const Stroll found = stroll(stage, kStroll);
    CHECK(found.planted > 500);
    CHECK(found.slide < 0.006f);
}

TEST_CASE("moving ground: one who jumps on a deck under way lands where it would on land") {
    for (const float speed : {0.0f, 1.4f}) {
        DeckStage<MatchedStage> stage({.speed = 6});
        stage.go_on_deck({0, 0, speed});
        stage.sail(180);
        const Vec3 begin = stage.on_deck(stage.feet());
        stage.jump();
        int frames = 0;
        bool flew = false;
        for (; frames < 120 && !(flew && stage.state().mode == MotorMode::Stand); ++frames) {
            stage.sail();
            flew = flew || stage.state().mode == MotorMode::Fall;
        }
        REQUIRE(flew);
        const Vec3 end = stage.on_deck(stage.feet());
        const float time = kFrame * static_cast<float>(frames);
        CHECK(std::abs(end.x - begin.x) < 0.05f);
        CHECK(std::abs(end.z - begin.z - speed * time) < 0.1f + 0.1f * speed);
    }
}

TEST_CASE("moving ground: one who jumps off it keeps its velocity until it has landed") {
    DeckStage<MotorStage> stage({.speed = 4});
    stage.world.get<Transform>(stage.person).position = {0, 10, 39.5f};
    stage.world.get<MotorState>(stage.person) = {};
    stage.step();
    stage.go({0, 0, 5});
    stage.sail(30);
    REQUIRE(stage.state().mode == MotorMode::Fall);
    const float begin = stage.feet().x;
    const float before = stage.feet().y;
    int frames = 0;
    for (; stage.state().mode == MotorMode::Fall && frames < 300; ++frames) {
        stage.sail();
    }
    CHECK(before > 5);
    CHECK(
        double(stage.feet().x - begin)
        == near(double(4 * kFrame * static_cast<float>(frames))).epsilon(0.02));
    stage.go(Vec3(0));
    stage.sail(60);
    CHECK(glm::length(stage.state().velocity) < 1e-3f);
    CHECK(stage.state().drift == Vec3(0));
}

TEST_CASE("moving ground: a child of a deck begins where the deck has it, and walks on it") {
    DeckStage<MotorStage> stage(kFerry);
    const Entity child = stage.world.create(
        Transform{.position = {3, 0, 2}}, CharacterMotor{}, MoveIntent{.velocity = {0, 0, 1}});
    REQUIRE(set_parent(stage.world, child, stage.deck));
    stage.sail(60);
    CHECK(stage.world.find<const Parent>(child) == nullptr);
    const Vec3 at = stage.on_deck(stage.world.get<const Transform>(child).position);
    CHECK(stage.world.get<const MotorState>(child).ground == stage.deck);
    CHECK(std::abs(at.y) < 1e-3f);
    CHECK(glm::distance(at, Vec3(3, 0, 2)) > 0.6f);
    CHECK(glm::distance(at, Vec3(3, 0, 2)) < 1.1f);
    // One that is attached later sits, and goes on when it is let go.
    REQUIRE(attach(stage.world, stage.deck, child, Transform{.position = {1, 0, 1}}));
    stage.sail(60);
    CHECK(stage.world.get<const Transform>(child).position == Vec3(1, 0, 1));
    REQUIRE(detach(stage.world, child));
    stage.sail();
    CHECK(
        glm::distance(
            stage.on_deck(stage.world.get<const Transform>(child).position), Vec3(1, 0, 1))
        < 0.01f);
    stage.sail(29);
    CHECK(
        glm::distance(
            stage.on_deck(stage.world.get<const Transform>(child).position), Vec3(1, 0, 1))
        > 0.3f);
}

TEST_CASE("moving ground: one that is attached from the start stays so until it is detached") {
    DeckStage<MotorStage> stage(kFerry);
    const Entity child = stage.world.create(
        Transform{}, CharacterMotor{}, MoveIntent{.velocity = {0, 0, 1}},
        Attach{.to = stage.deck, .at = {}, .by = {}});
    stage.sail(60);
    CHECK(parent_of(stage.world, child) == stage.deck);
    CHECK(stage.world.get<const Transform>(child).position == Vec3(0));
    stage.world.get<Attach>(child).to = {};
    stage.sail(60);
    CHECK(parent_of(stage.world, child).is_null());
    const Vec3 at = stage.on_deck(stage.world.get<const Transform>(child).position);
    CHECK(std::abs(at.y) < 1e-3f);
    CHECK(glm::length(at) > 0.6f);
    CHECK(glm::length(at) < 1.1f);
}

TEST_CASE(
    "moving ground: one who comes from one deck to another keeps its velocity until it brakes") {
    for (const float height : {9.5f, 10.0f}) {     // falls on it, or steps over
        for (const float speed : {-3.0f, 0.0f}) {  // of the other deck
            CAPTURE(height);
            CAPTURE(speed);
            DeckStage<MotorStage> stage({.speed = 4});
            MeshData mesh = make_box_mesh({-80, -1, 40}, {80, 0, 120});
            stage.world.resource<Assets>().meshes.push_back(std::move(mesh));
            const Entity other = stage.world.create(
                Transform{.position = {0, height, 0}}, MeshInstance{.mesh = {1}, .material = {}},
                Walkable{});
            stage.sea = {.speed = 4};
            stage.world.get<Transform>(stage.person).position = {0, 10, 38};
            stage.go({0, 0, 5});
            std::array<float, 3> x{};
            float change = 0;
            for (int i = 0; i < 120; ++i) {
                stage.world.get<Transform>(other).position = {
                    speed * stage.time, height, 0.5f * 4 * stage.time};
                stage.sail();
                std::rotate(x.begin(), x.begin() + 2, x.end());
                x[0] = stage.feet().x;
                const float second = std::abs(x[0] - 2 * x[1] + x[2]) / (kFrame * kFrame);
                change = std::max(change, i > 3 ? second : 0.0f);
            }
            CHECK(stage.state().ground == other);
            CHECK(change < 1.01f * CharacterMotor{}.acceleration + 0.2f);
            CHECK(change > 0.5f * CharacterMotor{}.acceleration);
            CHECK(double((x[0] - x[1]) / kFrame) == near(double(speed)).epsilon(1e-3));
        }
    }
}

TEST_CASE("moving ground: one that is attached and let go between two steps stays where it is") {
    DeckStage<MotorStage> stage(kFerry);
    stage.sail(60);
    REQUIRE(attach(stage.world, stage.deck, stage.person, Transform{.position = {5, 0, 5}}));
    REQUIRE(detach(stage.world, stage.person));
    stage.sail();
    CHECK(glm::distance(stage.on_deck(stage.feet()), Vec3(5, 0, 5)) < 0.01f);
    stage.sail(60);
    CHECK(glm::distance(stage.on_deck(stage.feet()), Vec3(5, 0, 5)) < 0.02f);
}

TEST_CASE(
    "moving ground: one that is attached forgets its velocity, and goes on at the carrier's") {
    MotorStage stage({}, {}, {});
    const Entity bird = stage.world.create(Transform{.position = {0, 20, 0}});
    float time = 0;
    const auto fly = [&](int count) {
        for (int i = 0; i < count; ++i) {
            time += kFrame;
            stage.world.get<Transform>(bird).position = {3 * time, 20 + time, 0};
            stage.step();
        }
    };
    stage.go({0, 0, 4});
    fly(60);
    CHECK(stage.state().velocity.z > 3.9f);
    REQUIRE(attach(stage.world, bird, stage.person, Transform{.position = {0, -2, 0}}));
    fly(30);
    CHECK(stage.state().held == 1);
    CHECK(stage.state().velocity == Vec3(0));
    stage.go(Vec3(0));
    REQUIRE(detach(stage.world, stage.person));
    const Vec3 begin = stage.feet();
    fly(30);
    const Vec3 way = stage.feet() - begin;
    const auto gravity = static_cast<float>(kGravity);
    CHECK(std::abs(way.x - 1.5f) < 0.01f);
    CHECK(std::abs(way.y - 0.5f + 0.125f * gravity) < 0.1f);
    CHECK(std::abs(way.z) < 1e-4f);
    CHECK(stage.state().mode == MotorMode::Fall);
}

TEST_CASE("moving ground: one who jumps against a wall of the deck is not thrown back") {
    DeckStage<MotorStage> stage({.speed = 4});
    MeshData wall = make_box_mesh({0.6f, 0, -2}, {1, 3, 2});
    stage.world.resource<Assets>().meshes.push_back(std::move(wall));
    const Entity side =
        stage.world.create(Transform{}, MeshInstance{.mesh = {1}, .material = {}}, Walkable{});
    REQUIRE(set_parent(stage.world, side, stage.deck));
    stage.go({1.4f, 0, 0});
    stage.sail(60);
    const float begin = stage.on_deck(stage.feet()).x;
    stage.world.get<MoveIntent>(stage.person).jump = true;
    stage.sail();
    REQUIRE(stage.state().mode == MotorMode::Fall);
    float back = 0;
    for (int i = 0; i < 60; ++i) {
        stage.sail();
        back = std::max(back, begin - stage.on_deck(stage.feet()).x);
    }
    CHECK(stage.state().mode == MotorMode::Stand);
    CHECK(back < 0.03f);
}

TEST_CASE("moving ground: a deck that rises adds its speed to a jump, once") {
    DeckStage<MotorStage> stage({.heave = 0.4f});
    stage.sail(180);
    const float begin = stage.feet().y;
    stage.world.get<MoveIntent>(stage.person).jump = true;
    float top = begin;
    const float before = deck_at(stage.sea, stage.time).position.y;
    stage.sail();
    REQUIRE(stage.state().mode == MotorMode::Fall);
    const float rise = (deck_at(stage.sea, stage.time).position.y - before) / kFrame;
    REQUIRE(rise > 0.7f);
    for (int i = 0; i < 60; ++i) {
        stage.sail();
        top = std::max(top, stage.feet().y);
    }
    const auto gravity = static_cast<float>(kGravity);
    const float speed = std::sqrt(2 * gravity * CharacterMotor{}.jump) + rise;
    CHECK(std::abs(top - begin - speed * speed / (2 * gravity)) < 0.003f);
}

TEST_CASE("moving ground: one whom a deck carries against a ball pushes it at that speed") {
    DeckStage<MotorStage> stage({.speed = 6});
    stage.sail(60);
    const Entity ball = stage.world.create(
        Transform{.position = stage.feet() + Vec3(0.5f, 1, 0)}, LooseBody{.mass = 0.001f});
    stage.sail();
    CHECK(stage.world.get<const LooseState>(ball).velocity.x > 5.5f);
}

TEST_CASE("moving ground: a motor that is removed takes its state along") {
    DeckStage<MotorStage> stage(kFerry);
    stage.world.remove<CharacterMotor>(stage.person);
    stage.sail(2);
    CHECK(stage.world.find<const MotorState>(stage.person) == nullptr);
}

}  // namespace limn::moving_ground_test
