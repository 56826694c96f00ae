#include "systems/animation/ik/elbow_circle.h"
#include "tests/near.h"
#include "tests/systems/ik_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>

namespace limn::elbow_circle_test {

using namespace limn::test;

TEST_CASE(
    "elbow: on its circle the links keep their lengths for every swivel, and the circle is "
    "perpendicular to the line from shoulder to wrist"
    * technique("char.elbow-circle")) {
    Random random(1, 0, 0, 0);
    for (int i = 0; i < 100; ++i) {
        const float upper = random.uniform(0.2f, 0.6f);
        const float lower = random.uniform(0.2f, 0.6f);
        const float distance =
            random.uniform(std::abs(upper - lower) + 0.01f, upper + lower - 0.001f);
        const Vec3 shoulder = any_direction(random);
        const Vec3 wrist = shoulder + distance * any_direction(random);
        const ElbowCircle circle =
            make_elbow_circle(shoulder, wrist, upper, lower, any_direction(random));
        for (int k = 0; k < 16; ++k) {
            const Vec3 elbow = elbow_at(circle, 0.4f * static_cast<float>(k));
            CHECK(glm::distance(elbow, shoulder) == near(double(upper)).epsilon(1e-5));
            CHECK(glm::distance(elbow, wrist) == near(double(lower)).epsilon(1e-5));
            CHECK(std::abs(glm::dot(elbow - circle.center, circle.normal)) < 1e-6f);
        }
    }
}

TEST_CASE(
    "elbow: center and radius of known arms; the pole is where the elbow points"
    * technique("char.elbow-circle")) {
    const ElbowCircle circle =
        make_elbow_circle({0, 0, 0}, {std::sqrt(2.0f), 0, 0}, 1, 1, {0.3f, -2, 0});
    CHECK(circle.center.x == near(0.707107));
    CHECK(circle.radius == near(0.707107));
    CHECK(glm::distance(elbow_at(circle, 0), Vec3(0.707107f, -0.707107f, 0)) < 1e-6f);
    CHECK(glm::distance(elbow_at(circle, kPi), Vec3(0.707107f, 0.707107f, 0)) < 1e-6f);
    CHECK(make_elbow_circle({0, 0, 0}, {2, 0, 0}, 1, 1, {0, 1, 0}).radius == 0);
    CHECK(make_elbow_circle({0, 0, 0}, {5, 0, 0}, 1, 1, {0, 1, 0}).radius == 0);
}

TEST_CASE(
    "elbow: a pole along the line and a wrist at the shoulder give some circle"
    * technique("char.elbow-circle")) {
    for (const Vec3& pole : {Vec3(1, 0, 0), Vec3(-3, 0, 0), Vec3(0, 0, 0)}) {
        const ElbowCircle circle = make_elbow_circle({0, 0, 0}, {1, 0, 0}, 1, 1, pole);
        CHECK(glm::length(circle.toward_pole) == near(1));
        CHECK(std::abs(circle.toward_pole.x) < 1e-6f);
    }
    const ElbowCircle folded = make_elbow_circle({1, 2, 3}, {1, 2, 3}, 0.4f, 0.4f, {0, 0, 1});
    CHECK(folded.radius == near(0.4));
    CHECK(glm::distance(elbow_at(folded, 1), Vec3(1, 2, 3)) == near(0.4));
}

TEST_CASE(
    "elbow: a limb reaches its target with the lengths it has, whatever pole and swivel"
    * technique("char.elbow-circle")) {
    Random random(2, 0, 0, 0);
    for (int i = 0; i < 200; ++i) {
        LimbPoints limb;
        limb.root = any_direction(random);
        limb.middle = limb.root + 0.45f * any_direction(random);
        limb.tip = limb.middle + 0.4f * any_direction(random);
        const Vec3 target = limb.root + any_offset(random, 0.06f, 0.84f);
        const LimbOptions options = {
            .pole = i % 2 == 0 ? Vec3(0) : any_direction(random),
            .swivel = random.uniform(-3.0f, 3.0f)};
        const LimbPoints solved = solve_limb(limb, target, options);
        CHECK(glm::distance(solved.tip, target) < 2e-6f);
        CHECK(glm::distance(solved.root, solved.middle) == near(0.45));
        CHECK(glm::distance(solved.middle, solved.tip) == near(0.4));

        const LimbTurn turn = find_limb_turn(limb, solved, any_direction(random));
        const Vec3 elbow = limb.root + turn.upper * (limb.middle - limb.root);
        CHECK(glm::distance(elbow, solved.middle) < 2e-6f);
        CHECK(glm::distance(elbow + turn.lower * (limb.tip - limb.middle), solved.tip) < 3e-6f);
        // The hinge turns with the upper link, and the lower link only about it.
        const Vec3 bend = glm::cross(limb.middle - limb.root, limb.tip - limb.middle);
        if (glm::length(bend) > 0.01f) {
            CHECK(
                glm::distance(
                    turn.upper * normalize_or(bend, {}), turn.lower * normalize_or(bend, {}))
                < 1e-3f);
        }
    }
}

TEST_CASE(
    "elbow: without a pole a limb at its target stays, and a straight one bends at its hinge") {
    const LimbPoints bent = {{0, 0, 0}, {0, -0.4f, 0.1f}, {0, -0.8f, 0}};
    const LimbPoints stays = solve_limb(bent, bent.tip, {});
    CHECK(glm::distance(stays.middle, bent.middle) < 1e-6f);

    const LimbPoints straight = {{0, 0, 0}, {0, -0.4f, 0}, {0, -0.8f, 0}};
    // About +x, a shin goes back and the knee forward.
    const LimbPoints kneels = solve_limb(straight, {0, -0.6f, 0}, {.hinge = {1, 0, 0}});
    CHECK(kneels.middle.z > 0.1f);
    const Vec3 normal = glm::cross(kneels.middle - kneels.root, kneels.tip - kneels.middle);
    CHECK(normal.x > 0);
}

TEST_CASE(
    "elbow: out of reach a limb is straight toward its target; softness keeps it bent; NaN and "
    "zero lengths change nothing") {
    const LimbPoints limb = {{0, 0, 0}, {0, -0.4f, 0.1f}, {0, -0.8f, 0}};
    const float reach = 2 * std::sqrt(0.17f);
    const LimbPoints far = solve_limb(limb, {0, 0, 9}, {});
    CHECK(glm::distance(far.tip, Vec3(0, 0, reach)) < 1e-5f);
    CHECK(glm::distance(far.middle, Vec3(0, 0, reach / 2)) < 1e-3f);
    const LimbPoints soft = solve_limb(limb, {0, 0, reach}, {.softness = 0.05f});
    CHECK(soft.tip.z < reach - 0.01f);
    CHECK(soft.tip.z > reach - 0.05f);
    const LimbPoints bad = solve_limb(limb, {NAN, 0, 0}, {});
    CHECK(bad.tip == limb.tip);
    const LimbPoints none = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
    CHECK(solve_limb(none, {2, 0, 0}, {}).tip == none.tip);
    // One link of length zero: the other one points.
    const LimbPoints one = {{0, 0, 0}, {0, 0, 0}, {0, 1, 0}};
    const LimbPoints points = solve_limb(one, {3, 0, 0}, {});
    CHECK(glm::distance(points.tip, Vec3(1, 0, 0)) < 1e-6f);
    const LimbTurn turn = find_limb_turn(one, points, {0, 0, 1});
    CHECK(glm::distance(turn.lower * Vec3(0, 1, 0), Vec3(1, 0, 0)) < 1e-6f);
    const LimbPoints at_root = solve_limb(limb, limb.root, {});
    CHECK(glm::distance(at_root.tip, limb.root) < 1e-5f);
}

TEST_CASE("elbow: the shortest rotation takes one direction to the other, also to its opposite") {
    Random random(3, 0, 0, 0);
    for (int i = 0; i < 100; ++i) {
        const Vec3 a = any_direction(random);
        const Vec3 b = i % 10 == 0 ? -a : any_direction(random);
        CHECK(glm::distance(rotation_between(2.0f * a, 3.0f * b) * a, b) < 3e-6f);
    }
    CHECK(rotation_between({0, 0, 0}, {1, 0, 0}) == Quat(1, 0, 0, 0));
}

}  // namespace limn::elbow_circle_test
