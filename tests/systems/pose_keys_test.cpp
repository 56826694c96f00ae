#include "ecs/components/all.h"
#include "ecs/components/animation.h"
#include "ecs/components/pose_keys.h"
#include "ecs/components/surface.h"
#include "ecs/snapshot.h"
#include "systems/animation/pose_keys_system.h"
#include "systems/animation/pose_system.h"
#include "systems/update_world.h"
#include "tests/systems/clip_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <limits>
#include <string>

namespace limn::pose_keys_test {

namespace {

Quat about_z(float degrees) {
    return glm::angleAxis(radians(degrees), Vec3(0, 0, 1));
}

PoseKeys wave(bool smooth = false) {
    const std::string joint = test::make_chain(4).joints[1];
    return {
        .keys =
            {{.time = 0},
             {.time = 1, .joints = {{.joint = joint, .turn = about_z(90)}}},
             {.time = 3, .joints = {{.joint = joint, .turn = about_z(-30), .shift = {0, 0, 1}}}}},
        .smooth = smooth};
}

struct KeyedStage {
    World world;
    Schedule schedule = make_world_schedule();
    Entity character;

    explicit KeyedStage(const PoseKeys& keys) {
        register_all_components();
        Assets assets;
        assets.skeletons.push_back(test::make_chain(4));
        world.insert_resource(std::move(assets));
        character = world.create(Transform{}, Skeleton{{0}}, ClipPlayer{}, keys);
        start_world(world);
    }
    void step(int count) {
        for (int i = 0; i < count; ++i) {
            step_world(world, schedule);
        }
    }
    [[nodiscard]] Quat rotation(std::size_t joint = 1) {
        const Affine& a = world.get<const Pose>(character).joints[joint];
        return glm::quat_cast(glm::transpose(Mat3(Vec3(a.row[0]), Vec3(a.row[1]), Vec3(a.row[2]))));
    }
};

float angle_between(const Quat& a, const Quat& b) {
    return 2 * std::acos(std::min(std::abs(glm::dot(a, b)), 1.0f));
}

std::string reason_against(const PoseKeys& keys) {
    const Result<ClipData> clip = make_pose_clip(test::make_chain(4), keys);
    return clip ? std::string("none") : clip.error().message;
}

}  // namespace

TEST_CASE(
    "pose keys: a character has the poses of its keys at their times, and between them their slerp"
    * technique("char.fk-keypose")) {
    KeyedStage stage(wave());
    CHECK(angle_between(stage.rotation(), about_z(0)) < 1e-3f);
    stage.step(30);
    CHECK(angle_between(stage.rotation(), about_z(45)) < 1e-3f);
    stage.step(30);
    CHECK(angle_between(stage.rotation(), about_z(90)) < 1e-3f);
    stage.step(60);
    CHECK(angle_between(stage.rotation(), about_z(30)) < 1e-3f);
}

TEST_CASE(
    "pose keys: without keys, or with all turns zero, it is at rest"
    * technique("anim.pose-keys")) {
    KeyedStage empty(PoseKeys{});
    const auto rest = empty.world.get<const Pose>(empty.character).joints;
    CHECK(angle_between(empty.rotation(), Quat(1, 0, 0, 0)) < 1e-6f);
    PoseKeys zero;
    zero.keys = {{.time = 0, .joints = {{.joint = test::make_chain(4).joints[2]}}}};
    KeyedStage still(zero);
    still.step(5);
    const auto joints = still.world.get<const Pose>(still.character).joints;
    REQUIRE(joints.size() == rest.size());
    for (std::size_t j = 0; j < rest.size(); ++j) {
        CHECK(to_mat4(joints[j]) == to_mat4(rest[j]));
    }
}

TEST_CASE(
    "pose keys: smooth ones pass through the keys, with equal speed on both sides"
    * technique("char.fk-keypose")) {
    const SkeletonData skeleton = test::make_chain(4);
    const Result<ClipData> clip = make_pose_clip(skeleton, wave(true));
    REQUIRE(clip.ok());
    CHECK(check_clip(*clip, 4, 0).ok());
    LocalPose pose;
    const auto turn_at = [&](float time) {
        sample_pose(skeleton, &*clip, time, pose, {});
        return glm::conjugate(skeleton.rest.rotations[1]) * pose.rotations[1];
    };
    CHECK(angle_between(turn_at(1), about_z(90)) < 1e-3f);
    CHECK(angle_between(turn_at(3), about_z(-30)) < 1e-3f);
    const auto speed = [&](float from, float to) {
        return angle_between(turn_at(from), turn_at(to)) / (to - from);
    };
    CHECK(std::abs(speed(0.98f, 0.99f) - speed(1.01f, 1.02f)) < 0.1f);
    CHECK(speed(0, 0.01f) < 0.05f);
}

TEST_CASE(
    "pose keys: an edit shows in the next step, and removed keys leave the rest pose"
    * technique("char.fk-keypose")) {
    KeyedStage stage(wave());
    stage.step(60);
    stage.world.get<PoseKeys>(stage.character).keys[1].joints[0].turn = about_z(40);
    stage.world.get<ClipPlayer>(stage.character) = {.clip = {}, .time = 1, .speed = 0};
    stage.step(1);
    CHECK(angle_between(stage.rotation(), about_z(40)) < 1e-3f);
    stage.world.remove<PoseKeys>(stage.character);
    stage.step(2);
    CHECK(angle_between(stage.rotation(), about_z(0)) < 1e-3f);
    CHECK_FALSE(stage.world.has<PoseKeysState>(stage.character));
}

TEST_CASE("pose keys: a loop starts over, and jumps without velocity") {
    KeyedStage stage(wave());
    stage.step(181);  // 3.02 s of 3
    CHECK(stage.world.get<const ClipPlayer>(stage.character).time < 0.1f);
    const Pose& pose = stage.world.get<const Pose>(stage.character);
    CHECK(to_mat4(pose.previous[1]) == to_mat4(pose.joints[1]));
    stage.step(1);
    CHECK(to_mat4(pose.previous[1]) != to_mat4(pose.joints[1]));
}

TEST_CASE("pose keys: one that stands still stays where it is, also after the last key") {
    KeyedStage stage(wave());
    stage.world.get<ClipPlayer>(stage.character) = {.clip = {}, .time = 5, .speed = 0};
    stage.step(3);
    CHECK(stage.world.get<const ClipPlayer>(stage.character).time == 5);
    CHECK(angle_between(stage.rotation(), about_z(-30)) < 1e-3f);
}

TEST_CASE("pose keys: a snapshot continues with the same poses") {
    KeyedStage stage(wave(true));
    stage.step(20);
    const Result<std::vector<std::byte>> saved = save_snapshot(stage.world);
    REQUIRE(saved.ok());
    stage.step(25);
    const Quat want = stage.rotation();
    REQUIRE(restore_snapshot(stage.world, *saved).ok());
    stage.step(25);
    CHECK(stage.rotation() == want);
}

TEST_CASE("pose keys: bad keys are refused with the index of the key, and leave the rest pose") {
    PoseKeys bad = wave();
    bad.keys[2].time = 1;
    CHECK(reason_against(bad).find("key 2: found time 1") != std::string::npos);
    bad = wave();
    bad.keys[1].joints[0].joint = "tail";
    CHECK(reason_against(bad).find("key 1: found no joint \"tail\"") != std::string::npos);
    bad = wave();
    bad.keys[2].joints[0].shift.y = std::numeric_limits<float>::quiet_NaN();
    CHECK(reason_against(bad).find("not finite") != std::string::npos);
    bad = wave();
    bad.keys[0].time = std::numeric_limits<float>::quiet_NaN();
    CHECK(reason_against(bad).find("key 0") != std::string::npos);
    KeyedStage stage(bad);
    stage.step(30);
    CHECK(angle_between(stage.rotation(), about_z(0)) < 1e-3f);
    CHECK(reason_against(wave()) == "none");
}

}  // namespace limn::pose_keys_test
