#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "ecs/components/animation.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/snapshot.h"
#include "systems/animation/twist_pose.h"
#include "systems/update_world.h"
#include "tests/near.h"
#include "tests/systems/ik_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace limn::twist_joint_test {

using namespace test;

namespace {

/// An arm along `bone` whose joints rest turned: a twist joint at the shoulder, two in the forearm.
SkeletonData make_twisting_arm(const Quat& rest = {1, 0, 0, 0}) {
    SkeletonData skeleton;
    const auto add = [&](const char* name, std::int32_t parent, const Vec3& at) {
        skeleton.joints.emplace_back(name);
        skeleton.parents.push_back(parent);
        skeleton.rest.translations.push_back(at);
        skeleton.rest.rotations.push_back(rest);
        skeleton.rest.scales.push_back(Vec3(1));
    };
    add("Hips", -1, {0, 1, 0});
    add("LeftUpperArm", 0, {0.2f, 0.4f, 0});
    add("LeftUpperArmTwist", 1, {0, 0, 0});
    add("LeftForearm", 1, {0.2f, -0.2f, 0});
    add("LeftForearmTwist1", 3, {0.05f, -0.05f, 0});
    add("lowerarm_twist_02_l", 3, {0.15f, -0.15f, 0});
    add("LeftHand", 3, {0.2f, -0.2f, 0});
    return skeleton;
}
constexpr std::uint16_t kUpperArm = 1;
constexpr std::uint16_t kUpperTwist = 2;
constexpr std::uint16_t kHand = 6;
const Vec3 kBone = glm::normalize(Vec3(1, -1, 0));

void apply_all(const SkeletonData& skeleton, LocalPose& pose) {
    apply_twist_joints(skeleton, find_twist_links(skeleton, {}), 1, pose);
}

std::vector<std::uint64_t> hashes_of_arms(int threads) {
    set_thread_count(threads);
    World world;
    Schedule schedule = make_world_schedule();
    Assets assets;
    assets.skeletons.push_back(make_twisting_arm());
    ClipData clip;
    clip.name = "wring";
    clip.duration = 1;
    ClipSheet sheet;
    sheet.times = {0, 1};
    sheet.rotating = {kHand};
    sheet.rotations = {rotation_about(kBone, -1.5f), rotation_about(kBone, 1.5f)};
    clip.sheets.push_back(sheet);
    assets.clips.push_back(clip);
    world.insert_resource(std::move(assets));
    for (int i = 0; i < 100; ++i) {
        world.create(
            Transform{}, Skeleton{{0}},
            ClipPlayer{.clip = {0}, .time = 0.01f * static_cast<float>(i)}, TwistJoints{});
    }
    std::vector<std::uint64_t> result;
    for (int i = 0; i < 5; ++i) {
        step_world(world, schedule);
        result.push_back(state_hash(world));
    }
    set_thread_count(0);
    return result;
}

}  // namespace

TEST_CASE(
    "twist joints: a rotation's twist is what its swing leaves, in either order"
    * technique("char.skin-defects")) {
    Random random(11, 0, 0, 0);
    for (int i = 0; i < 200; ++i) {
        const Vec3 axis = any_direction(random);
        const Vec3 side = glm::normalize(glm::cross(axis, any_direction(random)));
        const float angle = random.uniform(-3.0f, 3.0f);
        const float lean = random.uniform(-2.5f, 2.5f);
        const Quat twist = rotation_about(axis, angle);
        const Quat swing = rotation_about(side, lean);
        CHECK(std::abs(twist_angle(swing * twist, axis) - angle) < 1e-4f);
        CHECK(std::abs(twist_angle(-(twist * swing), axis) - angle) < 1e-4f);
    }
    CHECK(twist_angle(rotation_about({1, 0, 0}, kPi), {0, 1, 0}) == near(0.0).epsilon(1e-3));
}

TEST_CASE(
    "twist joints: those of a forearm take the hand's twist by their places, whatever it bends"
    * technique("char.skin-defects")) {
    Random random(12, 0, 0, 0);
    for (int i = 0; i < 50; ++i) {
        const Quat rest = any_turn(random, i == 0 ? 0.0f : 1.0f);
        const SkeletonData skeleton = make_twisting_arm(rest);
        const float angle = random.uniform(-2.5f, 2.5f);
        const float lean = random.uniform(-1.0f, 1.0f);
        const Vec3 side = glm::normalize(glm::cross(kBone, any_direction(random)));
        LocalPose pose = skeleton.rest;
        pose.rotations[kHand] = rotation_about(kBone, angle) * rotation_about(side, lean) * rest;
        apply_all(skeleton, pose);
        CHECK(std::abs(glm::dot(pose.rotations[kUpperTwist], rest)) > 1 - 1e-6f);
        const std::array<float, 2> shares = {0.25f, 0.75f};
        for (std::size_t k = 0; k < 2; ++k) {
            const Quat wanted = rotation_about(kBone, shares[k] * angle) * rest;
            CHECK(std::abs(glm::dot(pose.rotations[4 + k], wanted)) > 1 - 1e-6f);
        }
    }
}

TEST_CASE(
    "twist joints: one at the shoulder swings with the arm and twists half as much"
    * technique("char.skin-defects")) {
    Random random(13, 0, 0, 0);
    for (int i = 0; i < 50; ++i) {
        const SkeletonData skeleton = make_twisting_arm();
        const Vec3 side = glm::normalize(glm::cross(kBone, any_direction(random)));
        const float lean = random.uniform(-1.5f, 1.5f);
        const Quat swing = rotation_about(side, lean);
        LocalPose pose = skeleton.rest;
        const float angle = random.uniform(-2.0f, 2.0f);
        pose.rotations[kUpperArm] = swing * rotation_about(kBone, angle);
        apply_all(skeleton, pose);
        const Quat skin = pose.rotations[kUpperArm] * pose.rotations[kUpperTwist];
        const Quat wanted = swing * rotation_about(kBone, 0.5f * angle);
        CHECK(std::abs(glm::dot(skin, wanted)) > 1 - 1e-6f);
    }
}

TEST_CASE("twist joints: by names of the level, by weight; unknown and odd ones do nothing") {
    const SkeletonData skeleton = make_twisting_arm();
    const std::vector<TwistJoint> asked = {
        {"LeftForearmTwist1", "LeftHand", 1}, {"LeftUpperArmTwist", "LeftUpperArm", -0.5f},
        {"no such joint", "LeftHand", 1},     {"LeftForearmTwist1", "no such joint", 1},
        {"LeftForearmTwist1", "Hips", 1},     {"Hips", "LeftHand", 1},
        {"LeftHand", "LeftHand", 1}};
    const std::vector<TwistLink> links = find_twist_links(skeleton, asked);
    REQUIRE(links.size() == 2);
    LocalPose pose = skeleton.rest;
    pose.rotations[kHand] = rotation_about(kBone, 1);
    pose.rotations[kUpperArm] = rotation_about(kBone, 0.8f);
    for (const float weight : {0.0f, NAN}) {
        LocalPose same = pose;
        apply_twist_joints(skeleton, links, weight, same);
        CHECK(same.rotations == pose.rotations);
    }
    apply_twist_joints(skeleton, links, 0.5f, pose);
    CHECK(twist_angle(pose.rotations[4], kBone) == near(0.5));
    CHECK(twist_angle(pose.rotations[kUpperTwist], kBone) == near(-0.2));
    CHECK(find_twist_links(SkeletonData{}, {}).empty());
}

TEST_CASE("twist joints: in a world, on and off, with the same bits on any number of threads") {
    const std::vector<std::uint64_t> one = hashes_of_arms(1);
    CHECK(hashes_of_arms(2) == one);
    CHECK(hashes_of_arms(3) == one);
    CHECK(hashes_of_arms(7) == one);
    World world;
    Schedule schedule = make_world_schedule();
    Assets assets;
    assets.skeletons.push_back(make_twisting_arm());
    ClipData clip;
    ClipSheet sheet;
    sheet.times = {0};
    sheet.rotating = {kHand};
    sheet.rotations = {rotation_about(kBone, 1.5f)};
    clip.sheets.push_back(sheet);
    assets.clips.push_back(clip);
    world.insert_resource(std::move(assets));
    const Entity bare = world.create(Transform{}, Skeleton{{0}}, ClipPlayer{.clip = {0}});
    const Entity driven =
        world.create(Transform{}, Skeleton{{0}}, ClipPlayer{.clip = {0}}, TwistJoints{});
    const auto side_of = [&](Entity entity) {
        return transform_vector(world.get<const Pose>(entity).joints[4], Vec3(0, 0, 1));
    };
    step_world(world, schedule);
    CHECK(glm::distance(side_of(bare), Vec3(0, 0, 1)) < 1e-6f);
    CHECK(glm::distance(side_of(driven), rotation_about(kBone, 0.375f) * Vec3(0, 0, 1)) < 1e-5f);
    world.get<TwistJoints>(driven).joints = {{"LeftForearmTwist1", "LeftHand", 1}};
    step_world(world, schedule);
    CHECK(glm::distance(side_of(driven), rotation_about(kBone, 1.5f) * Vec3(0, 0, 1)) < 1e-5f);
}

}  // namespace limn::twist_joint_test
