#include "ecs/base/jobs.h"
#include "ecs/components/all.h"
#include "ecs/components/animation.h"
#include "ecs/components/camera.h"
#include "ecs/components/mesh_levels.h"
#include "ecs/components/rendering.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/snapshot.h"
#include "systems/animation/crowd_pose_system.h"
#include "systems/animation/pose_levels.h"
#include "systems/animation/pose_system.h"
#include "systems/update_world.h"
#include "tests/systems/crowd_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace limn::pose_levels_test {

using namespace limn::test;

namespace {

constexpr std::size_t kJoints = 30;
constexpr std::uint16_t kNeeds[] = {8, 17, kJoints};  ///< of the meshes, from coarse to fine

/// Triangles that need as many joints of a skin that lists them in their order.
MeshData make_cloth(std::uint16_t joints) {
    MeshData mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.normals.assign(3, Vec3(0, 0, 1));
    mesh.indices = {0, 1, 2};
    const auto last = static_cast<std::uint16_t>(joints - 1);
    mesh.skin = {{0, 1, 2, 3}, {last, 0, last}, {1, 1, 1}};
    return mesh;
}

Assets make_assets() {
    Assets assets;
    assets.skeletons.push_back(make_tree(kJoints, 9));
    for (std::uint64_t i = 0; i < 2; ++i) {
        ClipData clip = make_motion(assets.skeletons[0], i);
        for (Vec3& translation : clip.sheets[0].translations) {
            translation.z = 0;  // stays, so that the loop closes
        }
        assets.clips.push_back(clip);
    }
    SkinData skin;
    for (std::uint16_t j = 0; j < kJoints; ++j) {
        skin.joints.push_back(j);
    }
    skin.joint_from_mesh.resize(kJoints);
    assets.skins.push_back(skin);
    for (const std::uint16_t needs : kNeeds) {
        assets.meshes.push_back(make_cloth(needs));
    }
    return assets;
}

/// Characters in front of a camera that has 1000 pixels a meter at 1 m: levels change at 50 and 25
/// m.
struct Stage {
    World world;
    Schedule schedule = make_world_schedule();

    Stage() {
        world.insert_resource(make_assets());
        world.insert_resource(Rendering{.level_rows = 2000});
        world.create(Transform{}, Camera{.fov_y = radians(90.0f)});
    }
    void step(int count = 1) {
        for (int i = 0; i < count; ++i) {
            step_world(world, schedule);
        }
    }
    Entity add(float distance, float time, std::uint32_t clip = 0, float full_rate_within = 15) {
        const Entity character = world.create(
            Transform{.position = {0, 0, -distance}}, Skeleton{{0}},
            ClipPlayer{.clip = {clip}, .time = time},
            CrowdPose{.full_rate_within = full_rate_within},
            MeshInstance{.mesh = {2}, .material = {}});
        world.add(
            character, MeshLevels{.meshes = {{0}, {1}, {2}}, .span = 1, .pixels_per_quad = 10});
        world.add(character, Deformed{.character = character, .skin = {0}});
        return character;
    }
    const Pose& pose(Entity entity) { return world.get<const Pose>(entity); }
    std::uint32_t mesh(Entity entity) { return world.get<const MeshInstance>(entity).mesh.index; }
};

bool starts_with(const std::vector<Affine>& all, const std::vector<Affine>& first) {
    bool same = first.size() <= all.size();
    for (std::size_t j = 0; same && j < first.size(); ++j) {
        same = same_bits(all[j], first[j]);
    }
    return same;
}

std::vector<std::uint64_t> level_hashes(int threads) {
    set_thread_count(threads);
    Stage stage;
    for (int i = 0; i < 300; ++i) {
        stage.add(2.0f + static_cast<float>(i % 60), 0.01f * static_cast<float>(i), i % 2);
    }
    start_world(stage.world);
    stage.schedule.set_always_parallel(threads > 1);
    std::vector<std::uint64_t> all;
    for (int i = 0; i < 8; ++i) {
        stage.step();
        all.push_back(state_hash(stage.world));
    }
    return all;
}

}  // namespace

TEST_CASE(
    "pose levels: the first joints of a crowd have the bits that they have among all"
    * technique("engine.lod-mesh")) {
    TestCrowd crowd(67, 21);
    pose_crowd(crowd.rig, crowd.characters);
    const std::vector<std::vector<Affine>> all = crowd.joints;
    const Affine untouched = {{Vec4(9), Vec4(9), Vec4(9)}};
    for (const std::size_t count : {1, 3, 7, 16, 17, 22, 40, 66, 67, 200}) {
        CAPTURE(count);
        const CrowdRig rig = make_crowd_rig(crowd.skeleton, count);
        const std::size_t kept = std::min<std::size_t>(count, 67);
        REQUIRE(rig.joints() == kept);
        for (const bool scalar : {false, true}) {
            for (std::vector<Affine>& joints : crowd.joints) {
                joints.assign(67, untouched);
            }
            (scalar ? pose_crowd_scalar : pose_crowd)(rig, crowd.characters, {});
            for (std::size_t i = 0; i < all.size(); ++i) {
                for (std::size_t j = 0; j < 67; ++j) {
                    REQUIRE(same_bits(crowd.joints[i][j], j < kept ? all[i][j] : untouched));
                }
            }
        }
    }
}

TEST_CASE("pose levels: joints that a pose lacked are at rest relative to their parents") {
    const SkeletonData skeleton = make_tree(20, 3);
    std::vector<Affine> rest(20);
    compute_joint_matrices(skeleton, skeleton.rest, rest);
    Pose pose = {.joints = rest, .previous = rest};
    pose.joints[0] = affine_from({1, 2, 3}, rotation_about({0, 1, 0}, 0.7f), Vec3(1));
    const Pose before = pose;
    resize_pose(skeleton, 6, pose);
    CHECK(pose.joints.size() == 6);
    CHECK(starts_with(before.joints, pose.joints));
    resize_pose(skeleton, 100, pose);
    REQUIRE(pose.joints.size() == 20);
    CHECK(starts_with(pose.joints, {before.joints.begin(), before.joints.begin() + 6}));
    CHECK(starts_with(pose.previous, rest));
    for (std::size_t j = 6; j < 20; ++j) {
        const Affine& parent = pose.joints[static_cast<std::size_t>(skeleton.parents[j])];
        const Affine local = affine_from(
            skeleton.rest.translations[j], skeleton.rest.rotations[j], skeleton.rest.scales[j]);
        CHECK(same_bits(pose.joints[j], parent * local));
    }
}

TEST_CASE(
    "pose levels: a character has the joints that its mesh needs, where they are among all"
    * technique("engine.lod-mesh")) {
    Stage stage;
    std::vector<std::pair<Entity, Entity>> pairs;  // with levels of detail, and without
    for (int i = 0; i < 60; ++i) {
        const float distance = 2.0f + 2.0f * static_cast<float>(i);
        const float time = 0.02f * static_cast<float>(i);
        const Entity whole = stage.add(distance, time, 0, 1000);
        stage.world.remove<MeshLevels>(whole);
        pairs.emplace_back(stage.add(distance, time, 0, 1000), whole);
    }
    start_world(stage.world);
    stage.step(8);
    std::size_t posed = 0;
    int levels[3] = {};
    for (int i = 0; i < 8; ++i) {
        stage.step();
        for (const auto& [few, all] : pairs) {
            const Pose& pose = stage.pose(few);
            ++levels[stage.mesh(few)];
            posed += pose.joints.size();
            REQUIRE(pose.joints.size() == kNeeds[stage.mesh(few)]);
            REQUIRE(stage.pose(all).joints.size() == kJoints);
            REQUIRE(starts_with(stage.pose(all).joints, pose.joints));
            REQUIRE(starts_with(stage.pose(all).previous, pose.previous));
        }
    }
    CHECK(levels[0] > 0);
    CHECK(levels[1] > 0);
    CHECK(levels[2] > 0);
    CHECK(posed < 60 * 8 * kJoints / 2);
}

TEST_CASE("pose levels: whoever comes nearer never lacks a joint, and its velocity goes on") {
    Stage stage;
    const Entity whole = stage.add(2, 0);
    stage.world.remove<MeshLevels>(whole);
    const Entity walker = stage.add(130, 0);
    start_world(stage.world);
    std::size_t last = kJoints;
    int changes = 0;
    for (int i = 0; i < 260; ++i) {
        stage.world.get<Transform>(walker).position.z += i < 130 ? 1.0f : -1.0f;
        const std::vector<Affine> before = stage.pose(walker).joints;
        stage.step();
        const Pose& pose = stage.pose(walker);
        REQUIRE(pose.joints.size() >= kNeeds[stage.mesh(walker)]);
        REQUIRE(pose.previous.size() == pose.joints.size());
        // Known joints go on from where they were; no velocity is lost or made up.
        const std::size_t known = std::min(before.size(), pose.joints.size());
        REQUIRE(
            starts_with(pose.previous, {before.begin(), before.begin() + std::ptrdiff_t(known)}));
        changes += pose.joints.size() != last ? 1 : 0;
        last = pose.joints.size();
    }
    CHECK(changes >= 4);
}

TEST_CASE("pose levels: a skin in another order needs what stands before the last joint in use") {
    SkinData skin;
    skin.joints = {4, 29, 7, 2};
    CHECK(needed_joints({{0, 1}, {0}, {1}}, skin) == 5);
    CHECK(needed_joints({{0, 1}, {2}, {1}}, skin) == 30);
    CHECK(needed_joints({{0, 1}, {9}, {1}}, skin) == 30);  // beyond the skin
    CHECK(needed_joints({}, skin) == 0);
}

TEST_CASE("pose levels: what is attached to a joint keeps it") {
    Stage stage;
    const Entity far = stage.add(200, 0);
    const Entity hat =
        stage.world.create(Transform{}, JointAttachment{.character = far, .joint = 25});
    start_world(stage.world);
    stage.step(9);
    CHECK(stage.pose(far).joints.size() == 26);
    stage.world.destroy(hat);
    stage.step(9);
    CHECK(stage.pose(far).joints.size() == kNeeds[0]);
}

TEST_CASE("pose levels: the same bits on any number of threads, and from a snapshot") {
    register_all_components();
    const int before = thread_count();
    const std::vector<std::uint64_t> one = level_hashes(1);
    for (const int threads : {2, 3, 7}) {
        CHECK(level_hashes(threads) == one);
    }
    set_thread_count(before);
    Stage stage;
    for (int i = 0; i < 50; ++i) {
        stage.add(2.0f + 2.0f * static_cast<float>(i), 0.01f * static_cast<float>(i));
    }
    start_world(stage.world);
    stage.step(5);
    const Result<std::vector<std::byte>> saved = save_snapshot(stage.world);
    REQUIRE(saved.ok());
    Stage restored;
    REQUIRE(restore_snapshot(restored.world, *saved).ok());
    for (int i = 0; i < 8; ++i) {
        stage.step();
        restored.step();
        CHECK(state_hash(restored.world) == state_hash(stage.world));
    }
}

}  // namespace limn::pose_levels_test
