#include "systems/animation/ik/two_link.h"
#include "tests/near.h"
#include "tests/systems/ik_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn::two_link_test {

using namespace limn::test;

TEST_CASE("two link: angles of known targets" * technique("char.ik-two-link")) {
    const auto is_at = [](const Vec2& target, float l1, float l2, double first, double second) {
        const TwoLinkAngles angles = solve_two_link(target, l1, l2);
        CHECK(degrees(angles.first) == near(first).scale(1));
        CHECK(degrees(angles.second) == near(second).scale(1));
        CHECK(glm::distance(two_link_tip(angles, l1, l2), target) < 1e-6f);
    };
    is_at({1, 1}, 1, 1, 0, 90);
    is_at({1, 0}, 1, 1, -60, 120);
    is_at({0.5f, 1.2f}, 1, 0.8f, 29.42211, 88.20922);
}

TEST_CASE(
    "two link: targets in all quadrants are reached, by both solutions, as near as brute force"
    * technique("char.ik-two-link")) {
    Random random(1, 0, 0, 0);
    for (int i = 0; i < 60; ++i) {
        const float l1 = random.uniform(0.2f, 1.5f);
        const float l2 = random.uniform(0.2f, 1.5f);
        const Vec2 target = {random.uniform(-3.0f, 3.0f), random.uniform(-3.0f, 3.0f)};
        const double least =
            oracle::two_link_distance(double(target.x), double(target.y), double(l1), double(l2));
        for (const bool bends_back : {false, true}) {
            const TwoLinkAngles angles = solve_two_link(target, l1, l2, bends_back);
            CHECK((bends_back ? angles.second <= 0 : angles.second >= 0));
            const float distance = glm::distance(two_link_tip(angles, l1, l2), target);
            CHECK(std::abs(double(distance) - least) < 2e-3 * double(l1 + l2));
            const float reach = glm::length(target);
            if (reach < 0.999f * (l1 + l2) && reach > 1.001f * std::abs(l1 - l2)) {
                CHECK(distance < 2e-6f);
            }
        }
    }
}

TEST_CASE(
    "two link: a target at or beyond the reach is pointed at, straight"
    * technique("char.ik-two-link")) {
    for (const float far : {1.8f, 1.9f, 100.0f}) {
        const Vec2 target = far * Vec2(std::cos(2.0f), std::sin(2.0f));
        const TwoLinkAngles angles = solve_two_link(target, 1, 0.8f);
        CHECK(std::abs(angles.second) < 1e-3f);
        CHECK(angles.first == near(2.0).epsilon(1e-3));
    }
    CHECK(solve_two_link({3, 4}, 1, 1).second == 0);
    CHECK(solve_two_link({3, 4}, 1, 1).first == near(std::atan2(4.0, 3.0)));
    // Too near: folded, the tip on the far side of the shoulder.
    const TwoLinkAngles folded = solve_two_link({0.1f, 0}, 1, 0.5f);
    CHECK(folded.second == near(double(kPi)));
    CHECK(std::abs(folded.first) < 1e-6f);
}

TEST_CASE(
    "two link: a target at the base keeps the first angle; links of length zero and NaN targets "
    "give finite angles"
    * technique("char.ik-two-link")) {
    const TwoLinkAngles at_base = solve_two_link({0, 0}, 1, 1, false, 0.7f);
    CHECK(at_base.first == 0.7f);
    CHECK(at_base.second == near(double(kPi)));
    for (const Vec2& target : {Vec2(1, 0), Vec2(0, 0), Vec2(0.3f, -2)}) {
        for (const Vec2& lengths : {Vec2(0, 1), Vec2(1, 0), Vec2(0, 0)}) {
            const TwoLinkAngles angles = solve_two_link(target, lengths.x, lengths.y, false, 0.3f);
            CHECK(std::isfinite(angles.first));
            CHECK(std::isfinite(angles.second));
        }
    }
    CHECK(solve_two_link({0, 2}, 1, 0).first == near(double(kPi) / 2));
    CHECK(solve_two_link({NAN, 0}, 1, 1, false, 0.4f).first == 0.4f);
    CHECK(solve_two_link({INFINITY, 0}, 1, 1, false, 0.4f).second == 0);
}

TEST_CASE(
    "two link: the Jacobian has the printed values and the determinant l1 l2 sin(theta2)"
    * technique("char.ik-jacobian")) {
    const auto columns = two_link_jacobian({0, radians(90)}, 1, 1);
    CHECK(glm::distance(columns[0], Vec2(-1, 1)) < 1e-6f);
    CHECK(glm::distance(columns[1], Vec2(-1, 0)) < 1e-6f);
    const auto determinant = [](float first, float second, float l1, float l2) {
        const auto j = two_link_jacobian({first, second}, l1, l2);
        return j[0].x * j[1].y - j[1].x * j[0].y;
    };
    CHECK(determinant(0.3f, radians(60), 1, 0.8f) == near(0.692820));
    CHECK(std::abs(determinant(0.3f, 0, 1, 0.8f)) < 1e-6f);
    CHECK(std::abs(determinant(0.3f, kPi, 1, 0.8f)) < 1e-6f);
    Random random(2, 0, 0, 0);
    for (int i = 0; i < 50; ++i) {
        const float first = random.uniform(-3.0f, 3.0f);
        const float second = random.uniform(-3.0f, 3.0f);
        const std::vector<oracle::IkJoint> joints = {{}, {.offset = {1.2, 0, 0}}};
        const auto j = two_link_jacobian({first, second}, 1.2f, 0.7f);
        for (std::size_t column = 0; column < 2; ++column) {
            const oracle::Vec3d expected =
                oracle::ik_column(joints, {double(first), double(second)}, {0.7, 0, 0}, column);
            CHECK(double(j[column].x) == near(expected[0]).scale(1));
            CHECK(double(j[column].y) == near(expected[1]).scale(1));
        }
    }
}

TEST_CASE("two link: the soft reach is below the reach, increasing, with a continuous slope") {
    constexpr float kReach = 0.9f;
    constexpr float kSoft = 0.1f;
    float before = 0;
    float slope_before = 1;
    for (int i = 1; i < 3000; ++i) {
        const float distance = 1e-3f * static_cast<float>(i);
        const float soft = soft_reach(distance, kReach, kSoft);
        CHECK(soft <= kReach);
        CHECK(soft >= before);
        CHECK(soft <= distance);
        const float slope = (soft - before) / 1e-3f;
        CHECK(std::abs(slope - slope_before) < 0.02f);
        slope_before = slope;
        before = soft;
    }
    CHECK(soft_reach(0.5f, kReach, kSoft) == 0.5f);
    CHECK(soft_reach(2, kReach, 0) == kReach);
    CHECK(soft_reach(0.7f, kReach, 0) == 0.7f);
}

}  // namespace limn::two_link_test
