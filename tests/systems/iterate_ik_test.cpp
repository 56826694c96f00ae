#include "systems/animation/ik/iterate_ik.h"
#include "systems/animation/ik/joint_limits.h"
#include "systems/animation/ik/pseudo_inverse.h"
#include "tests/near.h"
#include "tests/systems/ik_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <vector>

namespace limn::iterate_ik_test {

using namespace limn::test;

namespace {

/// The arm of figure A9.1.5: -90 <= t1 <= 90, 0 <= t2 <= 140, -10 <= t3 <= 10 degrees.
JointTree make_limited_arm() {
    JointTree tree = make_planar_chain({1, 0.8f, 0.4f});
    const float low[] = {-90, 0, -10};
    const float high[] = {90, 140, 10};
    for (std::size_t i = 0; i < 3; ++i) {
        tree.axes[i].min = radians(low[i]);
        tree.axes[i].max = radians(high[i]);
        tree.axes[i].middle = 0.5f * (tree.axes[i].min + tree.axes[i].max);
        tree.axes[i].stiffness = 0.5f;
    }
    return tree;
}

/// Residual after `k` full steps of an arm of two links, relative to the first one.
double residual(float weight, int k) {
    JointTree tree = make_planar_chain({1, 1});
    for (JointAxis& axis : tree.axes) {
        axis.weight = weight;
    }
    JointState state = zero_state(tree);
    state.values = {0.4f, 1.2f};
    const Effector tip = planar_tip(tree, 1);
    const Vec3 start = tip_of(tree, state, tip);
    const Vec3 goal = start + Vec3(0.006f, 0.008f, 0);
    const IkOptions full = {
        .iterations = k, .step = 10, .tracking = 0, .tolerance = 0, .damping = 0};
    const IkResult result = iterate_ik(tree, tip, {goal, {}}, full, state);
    CHECK(result.iterations == k);
    return double(result.distance) / double(glm::distance(start, goal));
}

}  // namespace

TEST_CASE(
    "IK iteration: random goals that a chain can reach are reached within the limit"
    * technique("char.ik-iterate")) {
    Random random(1, 0, 0, 0);
    const JointTree tree = make_free_chain(3);
    const Effector tip = {2, {0, 1, 0}};
    for (int i = 0; i < 200; ++i) {
        const Vec3 goal = any_offset(random, 0.3f, 2.7f);
        JointState state = random_state(random, tree);
        const IkResult result = iterate_ik(tree, tip, {goal, {}}, {}, state);
        CHECK(result.is_reached);
        CHECK(result.iterations < 64);
        CHECK(glm::distance(tip_of(tree, state, tip), goal) <= 1e-3f);
    }
}

TEST_CASE(
    "IK iteration: the distance to the goal never increases, and a goal that is reached takes no "
    "iteration"
    * technique("char.ik-iterate")) {
    Random random(2, 0, 0, 0);
    for (int i = 0; i < 40; ++i) {
        const RandomChain chain = make_random_chain(random, 4 + i % 5);
        JointState state = random_state(random, chain.tree);
        const Vec3 goal = any_offset(random, 0.2f, 5.0f);
        float distance = glm::distance(tip_of(chain.tree, state, chain.tip), goal);
        for (int k = 0; k < 40; ++k) {
            const IkResult result =
                iterate_ik(chain.tree, chain.tip, {goal, {}}, {.iterations = 1}, state);
            CHECK(result.distance <= distance);
            distance = result.distance;
        }
        const Vec3 here = tip_of(chain.tree, state, chain.tip);
        const JointState before = state;
        CHECK(iterate_ik(chain.tree, chain.tip, {here, {}}, {}, state).iterations == 0);
        CHECK(state.values == before.values);
    }
}

TEST_CASE(
    "IK iteration: the tracking error of a step is of second order"
    * technique("char.ik-iterate")) {
    Random random(3, 0, 0, 0);
    const RandomChain chain = make_random_chain(random, 6);
    const JointState state = random_state(random, chain.tree);
    IkMatrix jacobian;
    find_jacobian(chain.tree, find_frames(chain.tree, state), chain.tip, 0, jacobian);
    IkMatrix inverse;
    find_pseudo_inverse(jacobian, 0, inverse);
    const Vec3 direction = any_direction(random);
    const auto tracking_error = [&](float size) {
        const Vec3 move = size * direction;
        std::vector<float> step(6);
        multiply(inverse, std::vector<float>{move.x, move.y, move.z}, step);
        JointState after = state;
        advance(chain.tree, step, after);
        const Vec3 moved =
            tip_of(chain.tree, after, chain.tip) - tip_of(chain.tree, state, chain.tip);
        return glm::distance(moved, move);
    };
    CHECK(tracking_error(0.2f) / tracking_error(0.1f) == near(4).epsilon(0.3));
    CHECK(tracking_error(0.1f) / tracking_error(0.05f) == near(4).epsilon(0.15));
}

TEST_CASE(
    "IK iteration: a goal out of reach ends with a stretched chain that no longer moves"
    * technique("char.ik-iterate")) {
    Random random(4, 0, 0, 0);
    const JointTree tree = make_free_chain(4, 0.5f);
    const Effector tip = {3, {0, 0.5f, 0}};
    for (int i = 0; i < 30; ++i) {
        const Vec3 direction = any_direction(random);
        JointState state = random_state(random, tree);
        iterate_ik(tree, tip, {4.0f * direction, {}}, {.iterations = 200}, state);
        const Vec3 end = tip_of(tree, state, tip);
        CHECK(glm::distance(end, 2.0f * direction) < 2e-2f);
        Vec3 last = end;
        for (int k = 0; k < 20; ++k) {
            iterate_ik(tree, tip, {4.0f * direction, {}}, {.iterations = 1}, state);
            const Vec3 now = tip_of(tree, state, tip);
            CHECK(glm::distance(now, last) < 1e-3f);
            last = now;
        }
    }
}

TEST_CASE(
    "IK iteration: straight chains, coincident and infinite goals, bones of length zero and chains "
    "without axes stay finite"
    * technique("char.ik-iterate")) {
    const JointTree tree = make_free_chain(3);
    const Effector tip = {2, {0, 1, 0}};
    for (const Vec3& goal :
         {Vec3(0, 2, 0), Vec3(0, 0, 0), Vec3(0, -1, 0), Vec3(0, 1, 0), Vec3(1e15f, 0, 0)}) {
        JointState state = zero_state(tree);
        const IkResult result = iterate_ik(tree, tip, {goal, {}}, {}, state);
        CHECK(std::isfinite(result.distance));
        CHECK(is_finite(tip_of(tree, state, tip)));
    }
    JointState state = zero_state(tree);
    for (const float bad : {NAN, INFINITY}) {
        const IkResult result = iterate_ik(tree, tip, {{bad, 0, 0}, {}}, {}, state);
        CHECK_FALSE(result.is_reached);
        CHECK(result.iterations == 0);
        CHECK(state.turns[0] == Quat(1, 0, 0, 0));
    }
    const JointTree points = make_free_chain(3, 0);
    state = zero_state(points);
    CHECK_FALSE(iterate_ik(points, {2, {}}, {{1, 0, 0}, {}}, {}, state).is_reached);
    JointTree rigid;
    add_joint(rigid, -1, {0, 1, 0});
    state = zero_state(rigid);
    CHECK_FALSE(iterate_ik(rigid, {0, {}}, {{1, 0, 0}, {}}, {}, state).is_reached);
}

TEST_CASE("IK iteration: position and orientation of a hand are both reached by seven axes") {
    Random random(5, 0, 0, 0);
    int reached = 0;
    for (int i = 0; i < 40; ++i) {
        const RandomChain chain = make_random_chain(random, 7);
        const JointState goal_state = random_state(random, chain.tree, 1);
        const JointFrames frames = find_frames(chain.tree, goal_state);
        const IkGoal goal = {
            effector_position(frames, chain.tip), frames.rotations[chain.tip.joint]};
        JointState state = random_state(random, chain.tree, 0.3f);
        const IkResult result = iterate_ik(chain.tree, chain.tip, goal, {.iterations = 300}, state);
        reached += result.is_reached ? 1 : 0;
        if (result.is_reached) {
            const JointFrames found = find_frames(chain.tree, state);
            const Quat& rotation = found.rotations[chain.tip.joint];
            CHECK(std::abs(glm::dot(rotation, *goal.rotation)) > 0.999f);
            CHECK(result.distance <= 1e-3f);
        }
    }
    CHECK(reached >= 34);  // local minima exist
}

TEST_CASE(
    "IK limits: the comfort step is 0 in the middle, points to it, and ignores axes without "
    "stiffness"
    * technique("char.ik-joint-limits")) {
    JointTree tree = make_limited_arm();
    JointState state = zero_state(tree);
    std::vector<float> step(3);
    for (std::size_t i = 0; i < 3; ++i) {
        state.values[i] = tree.axes[i].middle;
    }
    find_comfort_step(tree, state, 1, step);
    CHECK(step == std::vector<float>{0, 0, 0});
    state.values = {1, 0.2f, 0.1f};
    tree.axes[2].stiffness = 0;
    tree.axes[0].stiffness = 1;
    find_comfort_step(tree, state, 1, step);
    CHECK(step[0] == near(-2));  // -2 (theta - middle)
    CHECK(step[1] == near(double(tree.axes[1].middle - 0.2f)));
    CHECK(step[2] == 0);
}

TEST_CASE(
    "IK limits: along a path a limited arm stays in its ranges and reaches its goals, which "
    "without limits it reaches outside them"
    * technique("char.ik-joint-limits")) {
    const JointTree tree = make_limited_arm();
    const Effector tip = planar_tip(tree, 0.4f);
    JointState limited = zero_state(tree);
    limited.values = {0, 1, 0};
    JointState loose = limited;
    bool violates = false;
    for (int i = 0; i <= 40; ++i) {
        const float u = static_cast<float>(i) / 40;
        const Vec3 goal = {1.1f - 0.9f * u, 1.2f - 0.3f * u, 0};
        const IkOptions with = {.iterations = 200, .comfort = 0.1f};
        const IkOptions without = {.iterations = 200, .limits = false};
        const IkResult result = iterate_ik(tree, tip, {goal, {}}, with, limited);
        CHECK(result.is_reached);
        CHECK(is_within_limits(tree, limited));
        CHECK(iterate_ik(tree, tip, {goal, {}}, without, loose).is_reached);
        violates |= !is_within_limits(tree, loose);
    }
    CHECK(violates);
}

TEST_CASE(
    "IK limits: comfort brings stiff joints closer to their middle at the same goal"
    * technique("char.ik-joint-limits")) {
    JointTree tree = make_planar_chain({1, 1, 1, 1, 1});
    for (JointAxis& axis : tree.axes) {
        axis.middle = 0.3f;
        axis.stiffness = 1;
    }
    const Effector tip = planar_tip(tree, 1);
    const auto discomfort = [&](float comfort) {
        JointState state = zero_state(tree);
        state.values = {1.5f, -1, 1, -1, 1};
        const IkOptions options = {.iterations = 300, .step = 0.01f, .comfort = comfort};
        const IkResult result = iterate_ik(tree, tip, {{0, 3, 0}, {}}, options, state);
        CHECK(result.is_reached);
        float sum = 0;
        for (const float value : state.values) {
            sum += square(value - 0.3f);
        }
        return sum;
    };
    CHECK(discomfort(0.2f) < 0.6f * discomfort(0));
}

TEST_CASE(
    "IK limits: crossed limits hold as if sorted, and equal ones fix a joint"
    * technique("char.ik-joint-limits")) {
    JointTree tree = make_planar_chain({1, 1, 1});
    tree.axes[0].min = 0.5f;
    tree.axes[0].max = -0.5f;
    tree.axes[1].min = tree.axes[1].max = 0.25f;
    JointState state = zero_state(tree);
    iterate_ik(tree, planar_tip(tree, 1), {{-1, 1, 0}, {}}, {}, state);
    CHECK(std::abs(state.values[0]) <= 0.5f);
    CHECK(state.values[1] == 0.25f);
    CHECK(is_within_limits(tree, state));
}

TEST_CASE(
    "IK weights: after k full steps (1 - w)^k of the distance is left"
    * technique("char.ik-weights")) {
    CHECK(residual(0.5f, 5) == near(0.03125).epsilon(0.02));
    CHECK(residual(0.25f, 5) == near(0.2373).epsilon(0.02));
    CHECK(residual(0.5f, 2) == near(0.25).epsilon(0.02));
    CHECK(residual(1, 3) < 1e-4);
    CHECK(residual(0, 5) == 1);
}

TEST_CASE(
    "IK weights: a joint of weight 0 does not turn, and others do its work"
    * technique("char.ik-weights")) {
    JointTree tree = make_planar_chain({1, 1, 1});
    tree.axes[1].weight = 0;
    JointState state = zero_state(tree);
    state.values = {0.1f, 0.7f, 0.4f};
    const IkResult result =
        iterate_ik(tree, planar_tip(tree, 1), {{1, 1.5f, 0}, {}}, {.iterations = 200}, state);
    CHECK(state.values[1] == 0.7f);
    CHECK(result.is_reached);
}

}  // namespace limn::iterate_ik_test
