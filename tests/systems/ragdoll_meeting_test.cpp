// Ragdolls that meet each other, and that float.

#include "ecs/components/water.h"
#include "systems/animation/ragdoll/ragdoll_pairs.h"
#include "systems/animation/ragdoll/ragdoll_solver.h"
#include "tests/near.h"
#include "tests/systems/ragdoll_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace limn::ragdoll_meeting_test {

using namespace limn::test;
using ragdoll_test::Stage;

namespace {

std::vector<RigidCapsule> bodies_of(Stage& stage, Entity entity) {
    const RagdollRig rig = make_ragdoll_rig(stage.skeleton);
    const auto& state = stage.world.get<const RagdollState>(entity);
    std::vector<RigidCapsule> bodies;
    for (std::size_t i = 0; i < rig.bones.size(); ++i) {
        const RagdollBone& bone = rig.bones[i];
        RigidCapsule body = make_capsule(
            RigidVec(bone.from), RigidVec(bone.to), static_cast<double>(bone.radius), 1,
            RigidVec(0), RigidQuat(state.rotations[i]));
        body.position = RigidVec(state.positions[i]);
        body.velocity = RigidVec(state.velocities[i]);
        bodies.push_back(body);
    }
    return bodies;
}

/// How deep capsules of two ragdolls are in each other [m]; negative: apart.
double find_overlap(Stage& stage, Entity a, Entity b) {
    double overlap = -1e9;
    for (const RigidCapsule& p : bodies_of(stage, a)) {
        for (const RigidCapsule& q : bodies_of(stage, b)) {
            const ClosestPair pair = closest_points(p.placed(), q.placed());
            overlap = std::max(overlap, p.radius + q.radius - glm::distance(pair.on_a, pair.on_b));
        }
    }
    return overlap;
}

/// Deepest overlap while one person falls onto another who lies there, and after.
struct Pile {
    double worst = -1e9;
    double last = 0;
};
Pile drop_onto_another(bool meets) {
    Stage stage({.active = true, .collapse = 0, .meets = meets});
    stage.add_floor();
    stage.step(150);
    const Entity second = stage.world.create(
        Transform{.position = stage.joint(0) + Vec3(0.05f, 0.6f, 0.03f)}, Skeleton{{0}},
        Ragdoll{.active = true, .collapse = 0, .meets = meets});
    stage.step(2);
    Pile pile;
    for (int i = 0; i < 240; ++i) {
        stage.step();
        pile.last = find_overlap(stage, stage.person, second);
        pile.worst = std::max(pile.worst, pile.last);
    }
    return pile;
}

RigidVec momentum_of(Stage& stage, Entity entity) {
    const RagdollRig rig = make_ragdoll_rig(stage.skeleton);
    const auto& state = stage.world.get<const RagdollState>(entity);
    RigidVec sum(0);
    for (std::size_t i = 0; i < rig.bones.size(); ++i) {
        sum += static_cast<double>(rig.bones[i].share) * RigidVec(state.velocities[i]);
    }
    return sum;
}

RigidCapsule make_ball(double x, double speed, double mass) {
    RigidCapsule ball =
        make_capsule(RigidVec(0), RigidVec(0), 0.1, mass, RigidVec(x, 0, 0), RigidQuat(1, 0, 0, 0));
    ball.velocity = {speed, 0, 0};
    return ball;
}

}  // namespace

TEST_CASE(
    "ragdolls meet: the plane between two balls moves as an inelastic impact does"
    * technique("char.dynamics")) {
    const std::vector<RigidCapsule> light = {make_ball(-0.11, 3, 1)};
    const std::vector<RigidCapsule> heavy = {make_ball(0.11, -1, 3)};
    std::vector<PartingPlane> planes;
    find_parting_planes(light, heavy, 0.1, planes);
    find_parting_planes(heavy, light, 0.1, planes);
    REQUIRE(planes.size() == 2);
    const double common = (1 * 3.0 + 3 * -1.0) / 4;
    // They meet after 0.02 m / 4 m/s, at -0.01 + 3 * 0.005.
    for (const PartingPlane& plane : planes) {
        CHECK(plane.velocity.x == near(common));
        CHECK(plane.point.x + 0.005 * plane.velocity.x == near(0.005));
    }
    CHECK(planes[0].normal.x == near(-1));
    CHECK(planes[1].normal.x == near(1));
    planes.clear();
    find_parting_planes(light, heavy, 0.001, planes);  // too far for so short a step
    CHECK(planes.empty());
}

TEST_CASE("ragdolls meet: neighbors are those whose boxes overlap, as every pair tells") {
    std::vector<RagdollBodies> crowd;
    for (int i = 0; i < 40; ++i) {
        const RigidVec place(0.3 * (i * 17 % 40), 0.4 * (i % 3), 0.05 * (i * 11 % 40));
        RigidCapsule body =
            make_capsule(RigidVec(0), RigidVec(0, 1, 0), 0.3, 1, place, RigidQuat(1, 0, 0, 0));
        crowd.push_back(bound_ragdoll({body}, 0.01));
    }
    crowd.push_back({});  // sleeps
    const auto found = find_ragdoll_neighbors(crowd);
    std::size_t pairs = 0;
    for (std::size_t i = 0; i < crowd.size(); ++i) {
        std::vector<std::size_t> expected;
        for (std::size_t k = 0; k < crowd.size(); ++k) {
            const Bounds& a = crowd[i].box;
            const Bounds& b = crowd[k].box;
            const bool overlaps = i != k && !crowd[i].bodies.empty() && !crowd[k].bodies.empty()
                                  && a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y
                                  && b.min.y <= a.max.y && a.min.z <= b.max.z && b.min.z <= a.max.z;
            if (overlaps) {
                expected.push_back(k);
            }
        }
        CHECK(found[i] == expected);
        pairs += expected.size();
    }
    CHECK(pairs > 20);
}

TEST_CASE("ragdolls meet: one that falls onto another lies on it" * technique("char.dynamics")) {
    const Pile pile = drop_onto_another(true);
    CHECK(pile.worst < 0.06);
    CHECK(pile.last < 0.015);
    CHECK(drop_onto_another(false).worst > 0.1);
}

TEST_CASE("ragdolls meet: what one loses the other receives, whatever their masses") {
    for (const float mass : {75.0f, 25.0f, 300.0f}) {
        CAPTURE(mass);
        Stage stage({.active = true, .gravity = 0, .collapse = 0});
        const Entity second = stage.world.create(
            Transform{.position = {0.06f, 0, 0.6f}, .rotation = Quat(0, 0, 1, 0)}, Skeleton{{0}},
            Ragdoll{.active = true, .mass = mass, .gravity = 0, .collapse = 0});
        stage.step(2);
        stage.ragdoll().push = {0.2f, 0, 1.5f};
        stage.world.get<Ragdoll>(second).push = {0, 0.1f, -1.5f};
        stage.step();
        const double m = static_cast<double>(mass);
        const auto sum = [&] {
            return 75.0 * momentum_of(stage, stage.person) + m * momentum_of(stage, second);
        };
        const RigidVec before = sum();
        const double own = momentum_of(stage, stage.person).z;
        CHECK(std::abs(before.z - 1.5 * (75 - m)) < 0.01 * (75 + m));
        for (int i = 0; i < 40; ++i) {
            stage.step();
            CHECK(glm::length(sum() - before) < 2e-5 * 1.5 * (75 + m));
        }
        CHECK(momentum_of(stage, stage.person).z < own - 0.5);  // they have met
        CHECK(find_overlap(stage, stage.person, second) < 0.01);
    }
}

TEST_CASE("ragdolls meet: those that nothing else touches together receive nothing") {
    const auto outcome = [](double mass, const RigidVec& received, bool is_free = true) {
        return RagdollOutcome{
            .meets = true, .is_free = is_free, .mass = mass, .received = received};
    };
    // A chain of three, one alone, and a pair of which one lies on the floor.
    std::vector<RagdollOutcome> outcomes = {outcome(10, {1, 0, 0}),  outcome(30, {-3, 0, 1}),
                                            outcome(60, {0, 4, 0}),  {},
                                            outcome(50, {0, -5, 0}), outcome(50, {0, 9, 0}, false)};
    outcomes[3].received = {7, 7, 7};
    const std::vector<std::vector<std::size_t>> neighbors = {{1}, {0, 2, 3}, {1}, {1}, {5}, {4}};
    const std::vector<RigidVec> changes = balance_momentum(outcomes, neighbors);
    RigidVec sum(0);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(changes[i] == changes[0]);
        sum += outcomes[i].received + outcomes[i].mass * changes[i];
    }
    CHECK(glm::length(sum) < 1e-12);
    for (std::size_t i = 3; i < 6; ++i) {
        CHECK(changes[i] == RigidVec(0));
    }
}

TEST_CASE(
    "ragdolls float: at the surface, or sink, as their density says" * technique("char.dynamics")) {
    for (const float buoyancy : {1.05f, 2.0f, 0.8f, 0.0f}) {
        CAPTURE(buoyancy);
        Stage stage({.active = true, .collapse = 0, .buoyancy = buoyancy});
        stage.add_floor(-3);
        stage.world.create(Transform{.position = {0, 0.5f, 0}}, Water{.depth = 4});
        stage.step(60 * 25);
        const float hips = stage.joint(0).y;
        const float lowest = stage.lowest();
        if (buoyancy > 1) {
            CHECK(hips > -0.4f);
            CHECK(hips < 0.6f);
            CHECK(stage.fastest() < 0.1f);  // drag
            // Archimedes: as much is under water as floats, so little is above with 1.05.
            const float highest = -1 * [&] {
                float high = INFINITY;
                for (const RigidCapsule& body : bodies_of(stage, stage.person)) {
                    high = std::min(high, -static_cast<float>(body.position.y + body.radius));
                }
                return high;
            }();
            CHECK(highest - 0.5f < (buoyancy < 1.5f ? 0.15f : 0.4f));
        } else {
            CHECK(lowest < -2.9f);
        }
    }
}

TEST_CASE("ragdolls float: under water all slows down, and follows a current of none") {
    Stage stage(
        {.active = true,
         .damping = 0,
         .gravity = 0,
         .collapse = 0,
         .buoyancy = 1,
         .water_drag = 2});
    stage.world.create(Transform{.position = {0, 50, 0}}, Water{});
    stage.step(2);
    stage.ragdoll().push = {0, 0, 1};
    stage.step();
    const double before = momentum_of(stage, stage.person).z;
    stage.step(30);  // 0.5 s
    CHECK(momentum_of(stage, stage.person).z / before == near(std::exp(-1.0)).epsilon(0.02));
}

}  // namespace limn::ragdoll_meeting_test
