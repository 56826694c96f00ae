#include "ecs/base/jobs.h"
#include "ecs/components/all.h"
#include "ecs/snapshot.h"
#include "systems/animation/crowd_pose_system.h"
#include "systems/animation/pose_system.h"
#include "systems/update_world.h"
#include "tests/systems/clip_fixture.h"
#include "tests/systems/crowd_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

namespace limn::crowd_pose_test {

using namespace limn::test;

namespace {

/// A skeleton of 30 joints with two clips that are close to each other where they loop.
Assets make_assets() {
    Assets assets;
    assets.skeletons.push_back(make_tree(30, 9));
    for (std::uint64_t i = 0; i < 2; ++i) {
        ClipData clip = make_motion(assets.skeletons[0], i);
        for (Vec3& translation : clip.sheets[0].translations) {
            translation.z = 0;  // stays, so that the loop closes
        }
        assets.clips.push_back(clip);
    }
    ClipData stepping = make_turn({0, 0.5f, 1}, {0, 90, 0}, 1);
    stepping.sheets[0].interpolation = Interpolation::Step;
    assets.clips.push_back(stepping);
    assets.skeletons.push_back(make_chain(5));
    assets.clips.push_back(make_turn({0, 1}, {0, 40}, 2));
    return assets;
}

struct Stage {
    World world;
    Schedule schedule = make_world_schedule();

    Stage() { world.insert_resource(make_assets()); }
    void step(int count = 1) {
        for (int i = 0; i < count; ++i) {
            step_world(world, schedule);
        }
    }
    const Pose& pose(Entity entity) { return world.get<const Pose>(entity); }
    Entity add(std::uint32_t clip, float time, const Vec3& position = Vec3(0)) {
        return world.create(
            Transform{.position = position}, Skeleton{{clip == 3 ? 1u : 0u}},
            ClipPlayer{.clip = {clip}, .time = time}, CrowdPose{});
    }
    Entity add_exact(std::uint32_t clip, float time) {
        return world.create(
            Transform{}, Skeleton{{clip == 3 ? 1u : 0u}}, ClipPlayer{.clip = {clip}, .time = time});
    }
    void add_camera(const Vec3& position) {
        world.create(Transform{.position = position}, Camera{});
    }
};

bool equal(const std::vector<Affine>& a, const std::vector<Affine>& b) {
    bool same = a.size() == b.size();
    for (std::size_t i = 0; same && i < a.size(); ++i) {
        same = same_bits(a[i], b[i]);
    }
    return same;
}

/// A crowd around a camera that some are near and others far from, of two skeletons and all clips.
std::vector<std::uint64_t> crowd_hashes(int threads, int steps) {
    set_thread_count(threads);
    Stage stage;
    stage.add_camera({0, 0, 0});
    for (int i = 0; i < 300; ++i) {
        const float distance = 0.3f * static_cast<float>(i);
        stage.add(
            static_cast<std::uint32_t>(i % 4), 0.01f * static_cast<float>(i), {distance, 0, 0});
    }
    start_world(stage.world);
    stage.schedule.set_always_parallel(threads > 1);
    std::vector<std::uint64_t> all;
    for (int i = 0; i < steps; ++i) {
        stage.step();
        all.push_back(state_hash(stage.world));
    }
    return all;
}

}  // namespace

TEST_CASE("crowd pose: compressed poses are within the error of their clips") {
    Stage stage;
    std::vector<std::pair<Entity, Entity>> pairs;
    for (int i = 0; i < 40; ++i) {
        const float time = 0.05f * static_cast<float>(i);
        const auto clip = static_cast<std::uint32_t>(i % 2);
        pairs.emplace_back(stage.add(clip, time), stage.add_exact(clip, time));
    }
    start_world(stage.world);
    const CrowdClipLimits limits = scale_limits(stage.world.resource<Assets>().skeletons[0]);
    float worst = 0;
    for (int i = 0; i < 20; ++i) {
        stage.step();
        for (const auto& [crowd, exact] : pairs) {
            worst = std::max(
                worst,
                shell_error(stage.pose(crowd).joints, stage.pose(exact).joints, limits.shell));
        }
    }
    CHECK(worst > 0);  // they are not the same path
    CHECK(worst <= limits.tolerance);
}

TEST_CASE("crowd pose: the clip itself, and one that cannot be compressed, have the bits of any "
          "character") {
    Stage stage;
    const Entity plain = stage.add(1, 0.3f);
    stage.world.get<CrowdPose>(plain).compressed = false;
    const Entity stepping = stage.add(2, 0.3f);
    const Entity exact[] = {stage.add_exact(1, 0.3f), stage.add_exact(2, 0.3f)};
    start_world(stage.world);
    for (int i = 0; i < 50; ++i) {
        stage.step();
        REQUIRE(equal(stage.pose(plain).joints, stage.pose(exact[0]).joints));
        REQUIRE(equal(stage.pose(stepping).joints, stage.pose(exact[1]).joints));
        REQUIRE(equal(stage.pose(stepping).previous, stage.pose(exact[1]).previous));
    }
    CHECK(stage.world.resource<CrowdLibrary>().find({0}, {2})->clip == nullptr);
    CHECK(stage.world.resource<CrowdLibrary>().find({0}, {1}) == nullptr);
}

TEST_CASE("crowd pose: previous joints are those of the last step, whether posed or held") {
    Stage stage;
    stage.add_camera({0, 0, 0});
    std::vector<Entity> all;
    for (int i = 0; i < 40; ++i) {
        all.push_back(
            stage.add(0, 0.02f * static_cast<float>(i), {2.0f * static_cast<float>(i), 0, 0}));
    }
    start_world(stage.world);
    for (int i = 0; i < 12; ++i) {
        std::vector<std::vector<Affine>> before;
        for (const Entity entity : all) {
            before.push_back(stage.pose(entity).joints);
        }
        stage.step();
        for (std::size_t c = 0; c < all.size(); ++c) {
            REQUIRE(equal(stage.pose(all[c]).previous, before[c]));
        }
    }
}

TEST_CASE("crowd pose: the farther from the camera, the fewer poses, and each step has its share") {
    Stage stage;
    stage.add_camera({0, 0, 0});
    const float distances[] = {5, 25, 100};
    std::vector<Entity> groups[3];
    for (int group = 0; group < 3; ++group) {
        for (int i = 0; i < 64; ++i) {
            groups[group].push_back(stage.add(0, 0.01f, {distances[group], 0, 0}));
        }
    }
    start_world(stage.world);
    stage.step(2);
    const int expected[] = {8 * 64, 4 * 64, 2 * 64};
    int changes[3] = {};
    for (int i = 0; i < 8; ++i) {
        stage.step();
        for (int group = 0; group < 3; ++group) {
            int now = 0;
            for (const Entity entity : groups[group]) {
                const Pose& pose = stage.pose(entity);
                now += equal(pose.joints, pose.previous) ? 0 : 1;
            }
            changes[group] += now;
            CHECK(now == expected[group] / 8);
        }
    }
    for (int group = 0; group < 3; ++group) {
        CHECK(changes[group] == expected[group]);
    }
    // What is due has the pose of now: all are equal after four steps, as all play the same.
    stage.world.get<Transform>(groups[2][0]).position = {1, 0, 0};
    stage.step(2);
    CHECK(stage.world.get<const CrowdPoseState>(groups[2][0]).interval == 1);
    CHECK(equal(stage.pose(groups[2][0]).joints, stage.pose(groups[0][0]).joints));
}

TEST_CASE("crowd pose: near a border the rate keeps, 10 % beyond it changes") {
    const CrowdPose crowd = {.full_rate_within = 10, .half_rate_within = 20};
    CHECK(choose_pose_interval(crowd, 9.9f, 1) == 1);
    CHECK(choose_pose_interval(crowd, 10.9f, 1) == 1);
    CHECK(choose_pose_interval(crowd, 11.1f, 1) == 2);
    CHECK(choose_pose_interval(crowd, 9.5f, 2) == 2);
    CHECK(choose_pose_interval(crowd, 9.0f, 2) == 1);
    CHECK(choose_pose_interval(crowd, 21.9f, 2) == 2);
    CHECK(choose_pose_interval(crowd, 22.1f, 2) == 4);
    CHECK(choose_pose_interval(crowd, 100, 1) == 4);
    CHECK(choose_pose_interval(crowd, 18.3f, 4) == 4);
    CHECK(choose_pose_interval(crowd, 15, 4) == 2);
    CHECK(choose_pose_interval(crowd, 0, 4) == 1);
}

TEST_CASE("crowd pose: a teleport of one that is far poses it at once, without velocity") {
    Stage stage;
    stage.add_camera({0, 0, 0});
    const Entity far = stage.add(0, 0, {100, 0, 0});
    start_world(stage.world);
    stage.step(3);
    for (int i = 0; i < 4; ++i) {
        stage.world.add(far, PoseCut{});
        stage.world.get<ClipPlayer>(far).time += 0.3f;
        const std::vector<Affine> before = stage.pose(far).joints;
        stage.step();
        CHECK_FALSE(equal(stage.pose(far).joints, before));
        CHECK(equal(stage.pose(far).joints, stage.pose(far).previous));
    }
}

TEST_CASE("crowd pose: a crowd has the same bits on any number of threads") {
    const int before = thread_count();
    const std::vector<std::uint64_t> one = crowd_hashes(1, 10);
    for (const int threads : {2, 3, 7}) {
        CHECK(crowd_hashes(threads, 10) == one);
    }
    set_thread_count(before);
    CHECK(one[8] != one[9]);
}

TEST_CASE("crowd pose: a world restored from a snapshot continues with the same bits") {
    register_all_components();
    Stage stage;
    stage.add_camera({0, 0, 0});
    for (int i = 0; i < 50; ++i) {
        stage.add(
            static_cast<std::uint32_t>(i % 2), 0.01f * static_cast<float>(i),
            {static_cast<float>(i), 0, 0});
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

}  // namespace limn::crowd_pose_test
