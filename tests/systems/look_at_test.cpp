#include "systems/animation/ik/joint_tree.h"
#include "systems/animation/ik/look_at.h"
#include "tests/near.h"
#include "tests/systems/clip_fixture.h"
#include "tests/systems/ik_fixture.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn::look_at_test {

using namespace limn::test;

namespace {

/// Chest, neck, head and an eye, which look along +z.
const std::vector<LookJoint> kLookers = {
    {.joint = 1, .share = 0.3f, .max_yaw = 0.5f, .max_pitch = 0.4f},
    {.joint = 2, .share = 0.8f, .max_yaw = 0.7f, .max_pitch = 0.5f},
    {.joint = 3, .share = 1, .max_yaw = 0.5f, .max_pitch = 0.4f}};

Vec3 forward_of(const SkeletonData& skeleton, const LocalPose& pose, std::int32_t joint) {
    return find_place(skeleton, pose, joint).rotation * Vec3(0, 0, 1);
}

}  // namespace

TEST_CASE("look at: within the limits the last joint looks at its target, without roll") {
    const SkeletonData skeleton = make_chain(4);
    Random random(1, 0, 0, 0);
    for (int i = 0; i < 100; ++i) {
        LocalPose pose = skeleton.rest;
        const Vec3 target =
            Vec3(0, 3, 0)
            + random.uniform(4.0f, 9.0f)
                  * look_direction({random.uniform(-1.1f, 1.1f), random.uniform(-0.7f, 0.7f)});
        const float left = look_at(skeleton, kLookers, target, 1, pose);
        CHECK(left < 1e-3f);
        for (const LookJoint& look : kLookers) {
            const Vec3 side = find_place(skeleton, pose, look.joint).rotation * Vec3(1, 0, 0);
            CHECK(std::abs(side.y) < 0.02f);
        }
    }
}

TEST_CASE("look at: joints keep their limits, and each takes its share") {
    const SkeletonData skeleton = make_chain(4);
    LocalPose pose = skeleton.rest;
    look_at(skeleton, kLookers, {9, 3, -1}, 1, pose);  // behind
    const LookAngles neck = look_angles(forward_of(skeleton, pose, 1));
    const LookAngles head = look_angles(forward_of(skeleton, pose, 2));
    const LookAngles eye = look_angles(forward_of(skeleton, pose, 3));
    CHECK(neck.yaw == near(0.5));
    CHECK(head.yaw - neck.yaw == near(0.7));
    CHECK(eye.yaw - head.yaw == near(0.471).epsilon(0.1));

    pose = skeleton.rest;
    look_at(skeleton, kLookers, Vec3(0, 3, 0) + 50.0f * look_direction({0.4f, 0.2f}), 1, pose);
    const LookAngles share = look_angles(forward_of(skeleton, pose, 1));
    CHECK(share.yaw == near(0.12).epsilon(0.01));
    CHECK(share.pitch == near(0.06).epsilon(0.01));
}

TEST_CASE("look at: weight scales the turn; without one, or with a bad target, nothing moves") {
    const SkeletonData skeleton = make_chain(4);
    const Vec3 target = {2, 3, 5};
    const auto yaw_at = [&](float weight) {
        LocalPose pose = skeleton.rest;
        look_at(skeleton, std::span(kLookers).last(1), target, weight, pose);
        return look_angles(forward_of(skeleton, pose, 3)).yaw;
    };
    CHECK(yaw_at(0.5f) == near(0.5 * double(yaw_at(1))).epsilon(1e-3));
    CHECK(yaw_at(0) == 0);
    LocalPose pose = skeleton.rest;
    look_at(skeleton, kLookers, {NAN, 0, 0}, 1, pose);
    look_at(skeleton, kLookers, target, NAN, pose);
    look_at(skeleton, kLookers, {0, 3, 0}, 1, pose);  // at the eye
    CHECK(pose.rotations == skeleton.rest.rotations);
}

TEST_CASE("look at: a head that faces -z turns the short way, through 180 degrees of yaw") {
    SkeletonData skeleton = make_chain(4);
    skeleton.rest.rotations[0] = rotation_about({0, 1, 0}, 3.0f);
    LocalPose pose = skeleton.rest;
    const Vec3 target = Vec3(0, 3, 0) + 9.0f * look_direction({-3.0f, 0});
    CHECK(look_at(skeleton, std::span(kLookers).last(1), target, 1, pose) < 1e-3f);
    CHECK(axis_angle(pose.rotations[3]).angle == near(2 * (double(kPi) - 3)).epsilon(1e-3));
}

TEST_CASE("look at: angles and directions are inverse") {
    Random random(2, 0, 0, 0);
    for (int i = 0; i < 100; ++i) {
        const Vec3 direction = any_direction(random);
        CHECK(glm::distance(look_direction(look_angles(direction)), direction) < 1e-6f);
    }
    CHECK(look_angles({1, 0, 0}).yaw == near(double(kPi) / 2));
    CHECK(look_angles({0, 1, 0}).pitch == near(double(kPi) / 2));
}

}  // namespace limn::look_at_test
