#include "systems/animation/ik/hybrid_ik.h"
#include "systems/animation/ik/joint_limits.h"
#include "tests/near.h"
#include "tests/systems/ik_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn::hybrid_ik_test {

using namespace limn::test;

namespace {

/// Hips that slide, a spine of three joints, two arms and two legs.
struct Body {
    JointTree tree;
    std::vector<BodyLimb> limbs;
};

BodyLimb add_limb(JointTree& tree, std::uint16_t parent, const Vec3& root, const Vec3& link) {
    BodyLimb limb;
    limb.root = add_joint(tree, parent, root);
    add_free_axes(tree);
    limb.middle = add_joint(tree, limb.root, link + Vec3(0, 0, 0.02f));
    add_free_axes(tree);
    limb.tip = add_joint(tree, limb.middle, link - Vec3(0, 0, 0.02f));
    return limb;
}

Body make_body() {
    Body body;
    JointTree& tree = body.tree;
    add_joint(tree, -1, {0, 0.95f, 0});
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
        add_slide(tree, axis);
    }
    std::uint16_t chest = 0;
    for (int i = 0; i < 3; ++i) {
        chest = add_joint(tree, chest, {0, 0.15f, 0});
        add_free_axes(tree);
        for (std::size_t axis = tree.axes.size() - 3; axis < tree.axes.size(); ++axis) {
            tree.axes[axis].stiffness = 0.5f;
        }
    }
    for (const float side : {1.0f, -1.0f}) {
        body.limbs.push_back(add_limb(tree, chest, {0.18f * side, 0.1f, 0}, {0.28f * side, 0, 0}));
    }
    for (const float side : {1.0f, -1.0f}) {
        body.limbs.push_back(add_limb(tree, 0, {0.1f * side, -0.05f, 0}, {0, -0.43f, 0}));
    }
    const JointFrames frames = find_frames(tree, zero_state(tree));
    for (BodyLimb& limb : body.limbs) {
        limb.goal = frames.positions[limb.tip];
    }
    return body;
}

}  // namespace

TEST_CASE(
    "hybrid IK: limbs meet all goals in their reach to float precision"
    * technique("char.ik-hybrid")) {
    Random random(1, 0, 0, 0);
    Body body = make_body();
    const JointFrames rest = find_frames(body.tree, zero_state(body.tree));
    for (int i = 0; i < 100; ++i) {
        for (BodyLimb& limb : body.limbs) {
            limb.goal = rest.positions[limb.root] + any_offset(random, 0.06f, 0.53f);
        }
        JointState state = zero_state(body.tree);
        CHECK(solve_hybrid(body.tree, body.limbs, {}, state) < 2e-6f);
        const JointFrames frames = find_frames(body.tree, state);
        for (const BodyLimb& limb : body.limbs) {
            CHECK(glm::distance(frames.positions[limb.tip], limb.goal) < 2e-6f);
        }
        CHECK(frames.positions[0] == rest.positions[0]);  // the spine had nothing to do
    }
}

TEST_CASE(
    "hybrid IK: hips and spine bring goals beyond the arms into their reach"
    * technique("char.ik-hybrid")) {
    Body body = make_body();
    const JointFrames rest = find_frames(body.tree, zero_state(body.tree));
    body.limbs[1].goal = {-0.25f, 1.2f, 0.3f};  // the other hand bent, the knees too
    body.limbs[2].goal.y += 0.04f;
    body.limbs[3].goal.y += 0.04f;
    for (const Vec3& away : {Vec3(0.2f, 0, 0.3f), Vec3(0, -0.5f, 0.4f), Vec3(0.15f, 0.1f, 0)}) {
        body.limbs[0].goal = rest.positions[body.limbs[0].tip] + away;
        JointState state = zero_state(body.tree);
        CHECK(solve_hybrid(body.tree, body.limbs, {}, state) < 1e-5f);
        const JointFrames frames = find_frames(body.tree, state);
        CHECK(glm::distance(frames.positions[3], rest.positions[3]) > 0.02f);
        for (std::size_t i = 2; i < 4; ++i) {  // feet stay
            const BodyLimb& leg = body.limbs[i];
            CHECK(glm::distance(frames.positions[leg.tip], leg.goal) < 1e-5f);
        }
    }
}

TEST_CASE(
    "hybrid IK: the swivel keeps a shoulder within its limits where one does"
    * technique("char.ik-hybrid")) {
    Random random(2, 0, 0, 0);
    JointTree tree;
    add_joint(tree, -1, {0, 0, 0});
    add_hinge(tree, {0, 1, 0}, -1, 1);
    add_hinge(tree, {0, 0, 1}, -0.8f, 0.8f);
    add_hinge(tree, {1, 0, 0}, -0.5f, 0.5f);
    add_joint(tree, 0, {0.3f, 0, 0});
    add_hinge(tree, {0, 1, 0}, 0, 2.5f);
    add_joint(tree, 1, {0.3f, 0, 0});
    int kept = 0;
    for (int i = 0; i < 60; ++i) {
        JointState wanted = zero_state(tree);
        wanted.values = {
            random.uniform(-0.95f, 0.95f), random.uniform(-0.75f, 0.75f),
            random.uniform(-0.45f, 0.45f), random.uniform(0.4f, 2.2f)};
        BodyLimb limb = {.root = 0, .middle = 1, .tip = 2};
        limb.goal = tip_of(tree, wanted, {2, {}});
        limb.options.pole = i % 2 == 0 ? Vec3(0) : Vec3(0, 1, 0);  // a quarter turn off
        JointState state = zero_state(tree);
        state.values[3] = 0.3f;
        JointFrames frames;
        find_frames(tree, state, frames);
        reach_with_limb(tree, limb, true, frames, state);
        CHECK(glm::distance(tip_of(tree, state, {2, {}}), limb.goal) < 3e-6f);
        CHECK(state.values[3] == near(double(wanted.values[3])).epsilon(1e-3));
        kept += is_within_limits(tree, state, 0.01f) ? 1 : 0;
    }
    CHECK(kept == 60);
}

TEST_CASE(
    "hybrid IK: the cost is linear in the number of limbs: each is solved once, on its own"
    * technique("char.ik-hybrid")) {
    Body body = make_body();
    Random random(3, 0, 0, 0);
    const JointFrames rest = find_frames(body.tree, zero_state(body.tree));
    for (BodyLimb& limb : body.limbs) {
        limb.goal = rest.positions[limb.root] + any_offset(random, 0.1f, 0.5f);
    }
    JointState together = zero_state(body.tree);
    solve_hybrid(body.tree, body.limbs, {}, together);
    JointState in_turn = zero_state(body.tree);
    for (const BodyLimb& limb : body.limbs) {
        solve_hybrid(body.tree, std::vector<BodyLimb>{limb}, {}, in_turn);
    }
    for (std::size_t i = 0; i < together.turns.size(); ++i) {
        CHECK(together.turns[i] == in_turn.turns[i]);
    }
}

TEST_CASE(
    "hybrid IK: a NaN goal leaves its limb, and a goal far away stretches it, softly"
    * technique("char.ik-hybrid")) {
    Body body = make_body();
    body.limbs[0].goal = Vec3(NAN, 0, 0);
    JointState state = zero_state(body.tree);
    CHECK(solve_hybrid(body.tree, body.limbs, {}, state) < 1e-5f);
    CHECK(state.turns[body.limbs[0].root] == Quat(1, 0, 0, 0));

    // Without slides the spine alone cannot get there.
    JointTree fixed = body.tree;
    fixed.axes.erase(fixed.axes.begin(), fixed.axes.begin() + 3);
    body.limbs[0].goal = {4, 1, 0};
    body.limbs[0].options.softness = 0.03f;
    state = zero_state(fixed);
    CHECK(solve_hybrid(fixed, std::vector<BodyLimb>{body.limbs[0]}, {}, state) > 2);
    const JointFrames frames = find_frames(fixed, state);
    const Vec3 arm = frames.positions[body.limbs[0].tip] - frames.positions[body.limbs[0].root];
    CHECK(glm::length(arm) < 0.562f);
    CHECK(glm::length(arm) > 0.53f);
    CHECK(arm.x > 0.5f);
}

}  // namespace limn::hybrid_ik_test
