#include "content/bake/motion/pose_editing.h"
#include "content/load/gltf/gltf_load.h"
#include "content/load/gltf/gltf_write.h"
#include "content/load/motion/motion_scene.h"
#include "ecs/base/rng.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace limn::pose_editing_test {

namespace {

/// Hips with two arms of two joints, mirror images of one another, each turned at rest.
SkeletonData make_rig() {
    SkeletonData rig;
    rig.name = "rig";
    rig.joints = {"hips", "arm.L", "hand.L", "arm.R", "hand.R"};
    rig.parents = {-1, 0, 1, 0, 3};
    const Quat left = glm::angleAxis(0.4f, glm::normalize(Vec3(1, 2, 3)));
    const Quat right(left.w, left.x, -left.y, -left.z);
    rig.rest.rotations = {Quat(1, 0, 0, 0), left, left, right, right};
    rig.rest.translations = {
        Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(0.5f, 0.1f, 0), Vec3(-1, 0, 0), Vec3(-0.5f, 0.1f, 0)};
    rig.rest.scales.assign(5, Vec3(1));
    return rig;
}

LocalPose random_pose(const SkeletonData& rig, std::uint64_t seed) {
    Random random(seed, 0, 0, 0);
    LocalPose pose = rig.rest;
    for (std::uint16_t j = 0; j < pose.size(); ++j) {
        const float x = random.uniform(-1, 1);
        const float y = random.uniform(-1, 1);
        const float z = random.uniform(-1, 1);
        turn_joint(rig, j, glm::angleAxis(x + 2 * y, glm::normalize(Vec3(x, y, z + 2))), pose);
        pose.translations[j] += 0.1f * Vec3(y, z, x);
    }
    return pose;
}

float distance(const LocalPose& a, const LocalPose& b) {
    float most = a.size() == b.size() ? 0.0f : 1e9f;
    for (std::size_t j = 0; j < a.size() && j < b.size(); ++j) {
        most = std::max(most, glm::distance(a.translations[j], b.translations[j]));
        most = std::max(most, 1 - std::abs(glm::dot(a.rotations[j], b.rotations[j])));
    }
    return most;
}

std::vector<float> times_of(const PoseKeys& keys) {
    std::vector<float> times;
    for (const PoseKey& key : keys.keys) {
        times.push_back(key.time);
    }
    return times;
}

}  // namespace

TEST_CASE(
    "pose editing: at a key that was set, the pose is the one that was set"
    * technique("char.fk-keypose")) {
    const SkeletonData rig = make_rig();
    for (const bool smooth : {false, true}) {
        PoseKeys keys;
        keys.smooth = smooth;
        for (const float time : {2.0f, 0.5f, 1.25f}) {
            set_pose_key(keys, rig, time, random_pose(rig, static_cast<std::uint64_t>(100 * time)));
        }
        for (const float time : {0.5f, 1.25f, 2.0f}) {
            const LocalPose want = random_pose(rig, static_cast<std::uint64_t>(100 * time));
            CHECK(distance(sample_pose_keys(rig, keys, time), want) <= 1e-6f);
        }
        CHECK(distance(sample_pose_keys(rig, keys, 0.9f), random_pose(rig, 50)) > 1e-3f);
    }
}

TEST_CASE(
    "pose editing: keys stay in order, one at the same time replaces"
    * technique("anim.pose-keys, char.fk-keypose")) {
    const SkeletonData rig = make_rig();
    PoseKeys keys;
    for (const float time : {3.0f, 1.0f, 2.0f, 1.0f, 0.0f, 3.0f, 2.0f}) {
        set_pose_key(keys, rig, time, random_pose(rig, 7));
        const std::vector<float> times = times_of(keys);
        CHECK(std::is_sorted(times.begin(), times.end()));
    }
    CHECK(times_of(keys) == std::vector<float>{0, 1, 2, 3});
    CHECK(make_pose_clip(rig, keys)->sheets[0].times.size() == 4);
    const LocalPose other = random_pose(rig, 8);
    set_pose_key(keys, rig, 2, other);
    CHECK(keys.keys.size() == 4);
    CHECK(distance(sample_pose_keys(rig, keys, 2), other) <= 1e-6f);
}

TEST_CASE(
    "pose editing: without its only key a character is at rest" * technique("char.fk-keypose")) {
    const SkeletonData rig = make_rig();
    PoseKeys keys;
    set_pose_key(keys, rig, 1, random_pose(rig, 3));
    CHECK_FALSE(remove_pose_key(keys, 0.5f));
    CHECK(remove_pose_key(keys, 1));
    CHECK(distance(sample_pose_keys(rig, keys, 1), rig.rest) == 0);
}

TEST_CASE(
    "pose editing: a mirror exchanges the sides, and twice is the same pose"
    * technique("char.fk-keypose")) {
    const SkeletonData rig = make_rig();
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const LocalPose pose = random_pose(rig, seed);
        const LocalPose mirrored = mirror_pose(rig, pose);
        CHECK(distance(mirror_pose(rig, mirrored), pose) <= 1e-5f);
        CHECK(distance(mirrored, pose) > 1e-3f);
        // Where the joints are: mirrored at x = 0.
        const auto at = [&](const LocalPose& shown, std::size_t joint) {
            Mat4 sum(1.0f);
            for (auto j = static_cast<std::int32_t>(joint); j >= 0;
                 j = rig.parents[static_cast<std::size_t>(j)]) {
                const auto i = static_cast<std::size_t>(j);
                sum =
                    to_mat4(affine_from(shown.translations[i], shown.rotations[i], Vec3(1))) * sum;
            }
            return Vec3(sum[3]);
        };
        for (const auto& [left, right] : {std::pair(2, 4), std::pair(4, 2), std::pair(1, 3)}) {
            const Vec3 p = at(pose, static_cast<std::size_t>(left));
            const Vec3 q = at(mirrored, static_cast<std::size_t>(right));
            CHECK(glm::distance(Vec3(-p.x, p.y, p.z), q) <= 1e-5f);
        }
    }
    CHECK(distance(mirror_pose(rig, rig.rest), rig.rest) <= 1e-6f);
}

TEST_CASE("pose editing: names of the other side") {
    SkeletonData rig;
    rig.joints = {"root",  "LeftArm", "RightArm",     "mixamorig:LeftLeg", "mixamorig:RightLeg",
                  "leg_l", "leg_r",   "J_Bip_L_Foot", "J_Bip_R_Foot",      "tail.L",
                  "lower"};
    const std::vector<std::uint16_t> others = mirrored_joints(rig);
    CHECK(others == std::vector<std::uint16_t>{0, 2, 1, 4, 3, 6, 5, 8, 7, 9, 10});
}

TEST_CASE("pose editing: angles snap to multiples of the step") {
    CHECK(snap_angle(radians(47.0f), radians(15.0f)) == test::near(radians(45.0f)));
    CHECK(snap_angle(radians(-53.0f), radians(15.0f)) == test::near(radians(-60.0f)));
    CHECK(snap_angle(1.234f, 0) == 1.234f);
}

TEST_CASE("pose editing: as glTF the poses come back" * technique("char.fk-keypose")) {
    const SkeletonData rig = make_rig();
    PoseKeys keys;
    set_pose_key(keys, rig, 0, rig.rest);
    set_pose_key(keys, rig, 1, random_pose(rig, 5));
    const Result<ClipData> clip = make_pose_clip(rig, keys);
    REQUIRE(clip.ok());
    const GltfScene scene = make_motion_scene("rig", {rig, *clip});
    const Result<std::vector<std::byte>> bytes = write_glb(scene);
    REQUIRE_MESSAGE(bytes.ok(), (bytes ? "" : bytes.error().message));
    const Result<GltfScene> read = parse_gltf(*bytes, "rig.glb", "");
    REQUIRE(read.ok());
    REQUIRE(read->clips.size() == 1);
    CHECK(read->clips[0].duration == 1);
    for (const float time : {0.0f, 0.5f, 1.0f}) {
        const LocalPose want = sample_motion(rig, *clip, time);
        const LocalPose got = sample_motion(read->skeleton, read->clips[0], time);
        for (std::size_t j = 0; j < rig.joints.size(); ++j) {
            const auto at = std::ranges::find(read->skeleton.joints, rig.joints[j]);
            REQUIRE(at != read->skeleton.joints.end());
            const auto i = static_cast<std::size_t>(at - read->skeleton.joints.begin());
            CHECK(std::abs(glm::dot(got.rotations[i], want.rotations[j])) == test::near(1.0f));
            CHECK(glm::distance(got.translations[i], want.translations[j]) <= 1e-6f);
        }
    }
}

}  // namespace limn::pose_editing_test
