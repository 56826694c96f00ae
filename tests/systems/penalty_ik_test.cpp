#include "systems/animation/ik/joint_limits.h"
#include "systems/animation/ik/penalty_ik.h"
#include "tests/near.h"
#include "tests/systems/ik_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <vector>

namespace limn::penalty_ik_test {

using namespace limn::test;

TEST_CASE(
    "penalty IK: E never increases, and is what is left of the goals"
    * technique("char.ik-penalty")) {
    Random random(1, 0, 0, 0);
    for (int i = 0; i < 30; ++i) {
        const RandomChain chain = make_random_chain(random, 5 + i % 5);
        JointTree tree = chain.tree;
        for (JointAxis& axis : tree.axes) {
            axis.stiffness = random.uniform(0.0f, 1.0f);
        }
        JointState state = random_state(random, tree);
        const std::vector<PenaltyGoal> goals = {
            {chain.tip, 2.0f * any_direction(random), 1}, {{2, {}}, any_direction(random), 0.5f}};
        float energy = penalty_of(tree, state, goals, 0.01f);
        for (int k = 0; k < 20; ++k) {
            const PenaltyResult result =
                minimize_penalty(tree, goals, {.iterations = 1, .stiffness = 0.01f}, state);
            CHECK(result.before == near(double(energy)).scale(1e-6));
            CHECK(result.after <= result.before);
            energy = penalty_of(tree, state, goals, 0.01f);
            CHECK(energy == near(double(result.after)).scale(1e-6));
        }
        // By definition.
        double expected = 0;
        for (const PenaltyGoal& goal : goals) {
            const Vec3 left = tip_of(tree, state, goal.effector) - goal.position;
            expected += double(goal.weight) * double(glm::dot(left, left));
        }
        for (std::size_t axis = 0; axis < tree.axes.size(); ++axis) {
            expected +=
                0.01 * double(tree.axes[axis].stiffness) * double(square(state.values[axis]));
        }
        CHECK(double(energy) == near(expected).scale(1e-6));
    }
}

TEST_CASE(
    "penalty IK: reachable goals of several effectors of a tree are all met"
    * technique("char.ik-penalty")) {
    Random random(2, 0, 0, 0);
    JointTree tree = make_free_chain(4, 0.3f);  // a spine with two arms
    for (const std::int32_t side : {-1, 1}) {
        const auto shoulder = add_joint(tree, 3, Vec3(0.2f * static_cast<float>(side), 0.2f, 0));
        add_free_axes(tree);
        const auto elbow = add_joint(tree, shoulder, Vec3(0.4f * static_cast<float>(side), 0, 0));
        add_free_axes(tree);
        add_joint(tree, elbow, Vec3(0.4f * static_cast<float>(side), 0, 0));
    }
    for (int i = 0; i < 20; ++i) {
        const JointFrames wanted = find_frames(tree, random_state(random, tree, 0.8f));
        const std::vector<PenaltyGoal> goals = {
            {{6, {}}, wanted.positions[6], 1}, {{9, {}}, wanted.positions[9], 1}};
        JointState state = zero_state(tree);
        const PenaltyResult result = minimize_penalty(
            tree, goals, {.iterations = 100, .stiffness = 0, .tolerance = 0}, state);
        CHECK(std::sqrt(result.after) < 2e-3f);
    }
}

TEST_CASE(
    "penalty IK: two goals that contradict share the error by their weights"
    * technique("char.ik-penalty")) {
    const JointTree tree = make_free_chain(8, 0.5f);
    const Effector tip = {7, {0, 0.5f, 0}};
    const Vec3 left = {-1, 2, 0};
    const Vec3 right = {1, 2, 0.5f};
    const auto distances = [&](float weight) {
        JointState state = zero_state(tree);
        minimize_penalty(
            tree, std::vector<PenaltyGoal>{{tip, left, 1}, {tip, right, weight}},
            {.iterations = 100, .tolerance = 0}, state);
        const Vec3 end = tip_of(tree, state, tip);
        return Vec2(glm::distance(end, left), glm::distance(end, right));
    };
    const Vec2 equal = distances(1);
    CHECK(equal.x == near(double(equal.y)).epsilon(1e-3));
    CHECK(equal.x == near(0.5 * double(glm::distance(left, right))).epsilon(1e-3));
    const Vec2 heavier = distances(10);
    CHECK(heavier.y < 0.2f * equal.y);
    CHECK(heavier.x / heavier.y == near(10).epsilon(1e-2));
}

TEST_CASE(
    "penalty IK: limits hold, stiff joints stay near their middle, and bad goals are left out"
    * technique("char.ik-penalty")) {
    JointTree tree = make_planar_chain({1, 1, 1});
    for (JointAxis& axis : tree.axes) {
        axis.min = -0.5f;
        axis.max = 0.5f;
    }
    JointState state = zero_state(tree);
    const Effector tip = planar_tip(tree, 1);
    minimize_penalty(
        tree, std::vector<PenaltyGoal>{{tip, {-2, 1, 0}, 1}}, {.iterations = 50}, state);
    CHECK(is_within_limits(tree, state));
    CHECK(state.values[0] > 0.4f);

    const auto bend = [&](float stiffness) {
        JointTree stiff = make_planar_chain({1, 1, 1});
        stiff.axes[1].stiffness = 1;
        JointState at = zero_state(stiff);
        at.values = {0.1f, 0.1f, 0.1f};
        minimize_penalty(
            stiff, std::vector<PenaltyGoal>{{tip, {0, 1.5f, 0}, 1}},
            {.iterations = 60, .stiffness = stiffness}, at);
        return std::abs(at.values[1]);
    };
    CHECK(bend(3) < 0.5f * bend(0));

    state = zero_state(tree);
    const std::vector<PenaltyGoal> bad = {
        {tip, {NAN, 0, 0}, 1}, {tip, {1, 1, 0}, 0}, {tip, {1, 1, 0}, NAN}};
    const PenaltyResult result = minimize_penalty(tree, bad, {}, state);
    CHECK(result.after == 0);
    CHECK(state.values == std::vector<float>{0, 0, 0});
    minimize_penalty(tree, {}, {}, state);
    CHECK(state.values == std::vector<float>{0, 0, 0});
}

}  // namespace limn::penalty_ik_test
