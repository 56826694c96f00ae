#include "systems/animation/clip_sampling.h"
#include "systems/animation/ik/joint_tree.h"
#include "tests/near.h"
#include "tests/systems/clip_fixture.h"
#include "tests/systems/ik_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <vector>

namespace limn::joint_tree_test {

using namespace limn::test;

namespace {

float apart(const Quat& a, const Quat& b) {
    return std::min(glm::length(a - b), glm::length(a + b));
}

/// A skeleton whose second joint is a hinge, whose third has two axes, whose fourth has three.
SkeletonData make_arm() {
    SkeletonData skeleton = make_chain(5);
    Random random(3, 0, 0, 0);
    for (Quat& rest : skeleton.rest.rotations) {
        rest = any_turn(random, 1.0f);
    }
    skeleton.freedoms = {
        {.joint = 1, .axis = {0, 0, 1}, .min = -1, .max = 2, .middle = 0.5f, .stiffness = 0.3f},
        {.joint = 2, .axis = {1, 0, 0}},
        {.joint = 2, .axis = {0, 1, 0}},
        {.joint = 3, .axis = {1, 0, 0}},
        {.joint = 3, .axis = {0, 0, 1}},
        {.joint = 3, .axis = {0, 1, 0}},
    };
    return skeleton;
}

}  // namespace

TEST_CASE(
    "joint tree: forward kinematics of random chains agree with matrices in double precision"
    * technique("char.fk-function")) {
    Random random(1, 0, 0, 0);
    for (int i = 0; i < 200; ++i) {
        const RandomChain chain = make_random_chain(random, 2 + i % 9, i % 2 == 0);
        const JointState state = random_state(random, chain.tree);
        const oracle::Vec3d expected = oracle::ik_tip(chain.joints, to_double(state), chain.end);
        const Vec3 found = tip_of(chain.tree, state, chain.tip);
        CHECK(oracle::size_of(oracle::minus(to_double(found), expected)) < 5e-6);
    }
}

TEST_CASE(
    "joint tree: f(0) is the rest tip, and f has a period of 2 pi in each hinge"
    * technique("char.fk-function")) {
    Random random(2, 0, 0, 0);
    const RandomChain chain = make_random_chain(random, 6);
    Vec3 rest = chain.tip.offset;
    for (const Vec3& offset : chain.tree.offsets) {
        rest += offset;
    }
    CHECK(glm::distance(tip_of(chain.tree, zero_state(chain.tree), chain.tip), rest) < 1e-6f);

    const JointState state = random_state(random, chain.tree);
    const Vec3 tip = tip_of(chain.tree, state, chain.tip);
    for (std::size_t i = 0; i < chain.tree.axes.size(); ++i) {
        JointState turned = state;
        turned.values[i] += 2 * kPi;
        CHECK(glm::distance(tip_of(chain.tree, turned, chain.tip), tip) < 5e-6f);
        turned.values[i] -= kPi;
        CHECK(glm::distance(tip_of(chain.tree, turned, chain.tip), tip) > 1e-2f);
    }
}

TEST_CASE(
    "joint tree: a shoulder, an elbow and a wrist have 7 degrees of freedom, one more than the "
    "hand"
    * technique("char.fk-function")) {
    JointTree arm;
    add_joint(arm, -1, {0, 0, 0});
    add_free_axes(arm);
    add_joint(arm, 0, {0.3f, 0, 0});
    add_hinge(arm, {0, 1, 0}, 0, 2.5f);
    add_joint(arm, 1, {0.3f, 0, 0});
    add_free_axes(arm);
    CHECK(arm.axes.size() == 7);
    CHECK(arm.axes.size() - 6 == 1);
    CHECK(chain_length(arm, {2, {0.1f, 0, 0}}) == near(0.7));
}

TEST_CASE(
    "joint tree: a pose that was read is written back, whatever the axes of its joints"
    * technique("char.fk-function")) {
    const SkeletonData skeleton = make_arm();
    REQUIRE(check_skeleton(skeleton));
    Random random(4, 0, 0, 0);
    for (int i = 0; i < 100; ++i) {
        LocalPose pose = skeleton.rest;
        for (Quat& rotation : pose.rotations) {
            rotation = any_turn(random, 3.0f);
        }
        const std::vector<std::uint16_t> joints = list_chain(skeleton, 4, 3);
        REQUIRE(joints == std::vector<std::uint16_t>{1, 2, 3, 4});
        JointTree tree = make_joint_tree(skeleton, joints);
        JointState state;
        read_pose(skeleton, pose, joints, tree, state);
        LocalPose back = pose;
        write_pose(tree, state, joints, back);
        for (std::size_t joint = 0; joint < pose.size(); ++joint) {
            CHECK(apart(back.rotations[joint], pose.rotations[joint]) < 2e-6f);
        }
        // Frames are those of the joint matrices.
        std::vector<Affine> matrices(pose.size());
        compute_joint_matrices(skeleton, pose, matrices);
        const JointFrames frames = find_frames(tree, state);
        for (std::size_t joint = 0; joint < joints.size(); ++joint) {
            const Vec3 position = transform_point(matrices[joints[joint]], Vec3(0));
            CHECK(glm::distance(frames.positions[joint], position) < 5e-6f);
        }
    }
}

TEST_CASE(
    "joint tree: angles about one, two and three axes are found again"
    * technique("char.fk-function")) {
    const SkeletonData skeleton = make_arm();
    const std::vector<std::uint16_t> joints = {1, 2, 3};
    const JointTree tree = make_joint_tree(skeleton, joints);
    Random random(5, 0, 0, 0);
    for (int i = 0; i < 100; ++i) {
        const JointState state = random_state(random, tree);  // below a quarter turn
        JointState found = zero_state(tree);
        for (std::uint16_t joint = 0; joint < 3; ++joint) {
            set_local_rotation(tree, local_rotation(tree, state, joint), joint, found);
            CHECK(apart(found.turns[joint], Quat(1, 0, 0, 0)) < 1e-5f);
        }
        for (std::size_t axis = 0; axis < tree.axes.size(); ++axis) {
            CHECK(std::abs(found.values[axis] - state.values[axis]) < 1e-4f);
        }
    }
}

TEST_CASE("joint tree: scale of joints above a chain stretches its bones") {
    SkeletonData skeleton = make_chain(4);
    skeleton.rest.scales[0] = Vec3(2);
    skeleton.rest.scales[2] = Vec3(0.5f);
    const std::vector<std::uint16_t> joints = {1, 2, 3};
    JointTree tree = make_joint_tree(skeleton, joints);
    JointState state;
    read_pose(skeleton, skeleton.rest, joints, tree, state);
    CHECK(tree.offsets[0] == Vec3(0, 2, 0));
    CHECK(tree.offsets[1] == Vec3(0, 2, 0));
    CHECK(tree.offsets[2] == Vec3(0, 1, 0));
    CHECK(glm::distance(tip_of(tree, state, {2, {}}), Vec3(0, 5, 0)) < 1e-6f);
}

TEST_CASE("joint tree: limits in descending order are sorted, NaN is no limit") {
    const JointAxis swapped = {.min = 2, .max = -1};
    CHECK(axis_limits(swapped).low == -1);
    CHECK(axis_limits(swapped).high == 2);
    const JointAxis bad = {.min = NAN, .max = 1};
    CHECK(axis_limits(bad).low == -INFINITY);
    CHECK(axis_limits(bad).high == INFINITY);
}

}  // namespace limn::joint_tree_test
