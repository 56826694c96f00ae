#include "systems/animation/ik/ccd.h"
#include "systems/animation/ik/fabrik.h"
#include "systems/animation/ik/joint_limits.h"
#include "tests/near.h"
#include "tests/systems/ik_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <vector>

namespace limn::ccd_test {

using namespace limn::test;

TEST_CASE("CCD: no pass moves the effector away from its goal" * technique("char.ik-ccd")) {
    Random random(1, 0, 0, 0);
    for (int i = 0; i < 60; ++i) {
        const RandomChain chain = make_random_chain(random, 3 + i % 6, i % 4 == 0);
        JointState state = random_state(random, chain.tree);
        const Vec3 goal = any_offset(random, 0.2f, 4.0f);
        float distance = glm::distance(tip_of(chain.tree, state, chain.tip), goal);
        for (int k = 0; k < 20; ++k) {
            const IkResult result = solve_ccd(chain.tree, chain.tip, goal, {.passes = 1}, state);
            CHECK(result.distance <= distance * (1 + 1e-6f));
            CHECK(
                glm::distance(tip_of(chain.tree, state, chain.tip), goal)
                == near(double(result.distance)).scale(1));
            distance = result.distance;
        }
    }
}

TEST_CASE(
    "CCD: one link is aligned to a goal on its circle in one step" * technique("char.ik-ccd")) {
    const JointTree tree = make_planar_chain({2});
    JointState state = zero_state(tree);
    const Vec3 goal = {2 * std::cos(2.5f), 2 * std::sin(2.5f), 0};
    const IkResult result = solve_ccd(tree, planar_tip(tree, 2), goal, {}, state);
    CHECK(result.iterations == 1);
    CHECK(state.values[0] == near(2.5));
    CHECK(result.distance < 1e-6f);
    JointTree free = make_free_chain(1);
    state = zero_state(free);
    CHECK(solve_ccd(free, {0, {0, 2, 0}}, goal, {}, state).iterations == 1);
    CHECK(glm::distance(tip_of(free, state, {0, {0, 2, 0}}), goal) < 1e-5f);
}

TEST_CASE("CCD: five links reach goals within 32 passes" * technique("char.ik-ccd")) {
    Random random(2, 0, 0, 0);
    const JointTree tree = make_free_chain(5);
    const Effector tip = {4, {0, 1, 0}};
    for (int i = 0; i < 100; ++i) {
        // Half of the reach; it takes more passes the straighter the chain must become.
        JointState state = random_state(random, tree, 1);
        const Vec3 goal = any_offset(random, 0.5f, 2.5f);
        const IkResult result = solve_ccd(tree, tip, goal, {}, state);
        CHECK(result.is_reached);
        CHECK(result.distance <= 1e-3f);
        const Vec3 far = any_offset(random, 2.5f, 4.5f);
        CHECK(solve_ccd(tree, tip, far, {.passes = 300}, state).is_reached);
    }
}

TEST_CASE("CCD: a goal in line with a straight chain is reached" * technique("char.ik-ccd")) {
    for (const float at : {1.5f, 3.0f, -2.0f}) {
        const JointTree free = make_free_chain(5);
        JointState state = zero_state(free);
        CHECK(solve_ccd(free, {4, {0, 1, 0}}, {0, at, 0}, {.passes = 60}, state).is_reached);
        const JointTree planar = make_planar_chain({1, 1, 1, 1});
        state = zero_state(planar);
        CHECK(
            solve_ccd(planar, planar_tip(planar, 1), {at, 0, 0}, {.passes = 60}, state).is_reached);
    }
}

TEST_CASE(
    "CCD: turns are limited per joint and pass, and stay within the limits of the joints"
    * technique("char.ik-ccd")) {
    JointTree tree = make_planar_chain({1, 1, 1});
    JointState state = zero_state(tree);
    const std::vector<float> before = state.values;
    solve_ccd(tree, planar_tip(tree, 1), {-1, 1, 0}, {.passes = 1, .max_angle = 0.2f}, state);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(std::abs(state.values[i] - before[i]) <= 0.2f + 1e-6f);
    }
    for (JointAxis& axis : tree.axes) {
        axis.min = -0.6f;
        axis.max = 0.8f;
    }
    Random random(3, 0, 0, 0);
    for (int i = 0; i < 50; ++i) {
        state = random_state(random, tree, 0.6f);
        solve_ccd(tree, planar_tip(tree, 1), 3.0f * any_direction(random), {}, state);
        CHECK(is_within_limits(tree, state));
    }
}

TEST_CASE(
    "FABRIK: chains reach their goals in few iterations, bones keep their lengths"
    * technique("char.ik-ccd")) {
    Random random(4, 0, 0, 0);
    const JointTree tree = make_free_chain(7, 0.5f);
    const Effector tip = {6, {0, 0.5f, 0}};
    for (int i = 0; i < 100; ++i) {
        JointState state = random_state(random, tree);
        const Vec3 goal = any_offset(random, 0.3f, 3.0f);
        const IkResult result = solve_fabrik(tree, tip, goal, {}, state);
        CHECK(result.is_reached);
        const JointFrames frames = find_frames(tree, state);
        for (std::size_t joint = 1; joint < tree.size(); ++joint) {
            CHECK(glm::distance(frames.positions[joint - 1], frames.positions[joint]) == near(0.5));
        }
    }
}

TEST_CASE(
    "FABRIK: out of reach a chain is straight toward its goal; limits hold"
    * technique("char.ik-ccd")) {
    Random random(5, 0, 0, 0);
    const JointTree tree = make_free_chain(4);
    for (int i = 0; i < 20; ++i) {
        const Vec3 direction = any_direction(random);
        JointState state = random_state(random, tree);
        solve_fabrik(tree, {3, {0, 1, 0}}, 9.0f * direction, {.iterations = 60}, state);
        CHECK(glm::distance(tip_of(tree, state, {3, {0, 1, 0}}), 4.0f * direction) < 0.05f);
    }
    JointTree limited = make_planar_chain({1, 1, 1, 1});
    for (JointAxis& axis : limited.axes) {
        axis.min = -0.7f;
        axis.max = 0.7f;
    }
    int reached = 0;
    for (int i = 0; i < 50; ++i) {
        const JointState wanted = random_state(random, limited, 0.65f);
        const Vec3 goal = tip_of(limited, wanted, planar_tip(limited, 1));
        JointState state = zero_state(limited);
        const IkResult result = solve_fabrik(
            limited, planar_tip(limited, 1), goal, {.iterations = 60, .tolerance = 0.02f}, state);
        reached += result.is_reached ? 1 : 0;
        CHECK(is_within_limits(limited, state));
    }
    CHECK(reached >= 35);
}

TEST_CASE(
    "CCD and FABRIK: NaN goals, goals at the base and bones of length zero are finite"
    * technique("char.ik-ccd")) {
    for (const float length : {1.0f, 0.0f}) {
        const JointTree tree = make_free_chain(3, length);
        const Effector tip = {2, {0, length, 0}};
        for (const Vec3& goal : {Vec3(0), Vec3(NAN, 0, 0), Vec3(0, length, 0), Vec3(0, -1, 0)}) {
            JointState state = zero_state(tree);
            const IkResult ccd = solve_ccd(tree, tip, goal, {}, state);
            CHECK(is_finite(tip_of(tree, state, tip)));
            state = zero_state(tree);
            const IkResult fabrik = solve_fabrik(tree, tip, goal, {}, state);
            CHECK(is_finite(tip_of(tree, state, tip)));
            if (std::isnan(goal.x)) {
                CHECK(ccd.iterations + fabrik.iterations == 0);
                CHECK(state.turns[0] == Quat(1, 0, 0, 0));
            }
        }
    }
}

}  // namespace limn::ccd_test
