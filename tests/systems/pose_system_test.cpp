#include "ecs/base/jobs.h"
#include "ecs/components/all.h"
#include "ecs/components/animation.h"
#include "ecs/snapshot.h"
#include "systems/animation/clip_player_system.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/pose_system.h"
#include "systems/update_world.h"
#include "tests/ecs/allocation_count.h"
#include "tests/near.h"
#include "tests/systems/clip_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <limits>

namespace limn::pose_system_test {

using namespace limn::test;

namespace {

/// A chain of four joints whose second one turns once about z in two seconds, and morph weight 1,
/// which goes up; then a clip for a longer chain.
Assets make_assets() {
    Assets assets;
    assets.skeletons.push_back(make_chain(4));
    ClipData turn = make_turn({0, 0.5f, 1, 1.5f, 2}, {0, 90, 180, 270, 360}, 1);
    assets.clips.push_back(turn);
    ClipSheet fade;
    fade.times = {0, 2};
    fade.morphing = {1};
    fade.weights = {0, 1};
    turn.sheets.push_back(fade);
    assets.clips.push_back(turn);
    assets.clips.push_back(make_turn({0, 1}, {0, 90}, 7));
    MeshData mesh;
    mesh.morphs.resize(3);
    assets.meshes.push_back(mesh);
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
};

bool equal(const std::vector<Affine>& a, const std::vector<Affine>& b) {
    bool same = a.size() == b.size();
    for (std::size_t i = 0; same && i < a.size(); ++i) {
        for (int row = 0; row < 3; ++row) {
            same = same && a[i].row[row] == b[i].row[row];
        }
    }
    return same;
}

Vec3 tip(const std::vector<Affine>& joints) {
    return transform_point(joints.back(), Vec3(0));
}

std::vector<std::uint64_t> crowd_hashes(int threads, int steps) {
    set_thread_count(threads);
    Stage stage;
    for (int i = 0; i < 300; ++i) {
        const Entity character = stage.world.create(
            Transform{}, Skeleton{{0}},
            ClipPlayer{.clip = {1}, .time = 0.01f * static_cast<float>(i)},
            MorphWeights{{0, 0}, {}});
        stage.world.create(Transform{}, Parent{character}, JointAttachment{character, 3});
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

TEST_CASE("clip player: loops, holds at both ends and never leaves the clip") {
    const auto at = [](float time, float speed, bool loop, float step) {
        return step_clip_time(
            ClipPlayer{.clip = {}, .time = time, .speed = speed, .loop = loop}, 2.0f, step);
    };
    CHECK(at(0.5f, 1, true, 0.25f) == 0.75f);
    CHECK(at(1.75f, 1, true, 0.5f) == test::near(0.25));
    CHECK(at(1.75f, 1, false, 0.5f) == 2.0f);
    CHECK(at(0.25f, -1, true, 0.5f) == test::near(1.75));
    CHECK(at(0.25f, -1, false, 0.5f) == 0.0f);
    CHECK(at(0.5f, -2, true, 0.125f) == test::near(0.25));
    CHECK(at(0, 100, true, 100) <= 2.0f);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    for (const float bad : {nan, infinity, -infinity}) {
        for (const bool loop : {true, false}) {
            CHECK(at(bad, 1, loop, 0.1f) == 0.0f);
            CHECK(at(1, bad, loop, 0.1f) == 0.0f);
        }
    }
    CHECK(step_clip_time(ClipPlayer{.clip = {}, .time = 1}, 0.0f, 0.1f) == 0.0f);  // a single key
}

TEST_CASE("pose system: a character shows its clip at the time of its player") {
    Stage stage;
    const Entity character =
        stage.world.create(Transform{}, Skeleton{{0}}, ClipPlayer{.clip = {0}});
    stage.world.insert_resource(FrameTime{.step = 0.25f});
    start_world(stage.world);
    CHECK(glm::distance(tip(stage.pose(character).joints), Vec3(0, 3, 0)) < 1e-6f);
    stage.step(2);
    CHECK(stage.world.get<const ClipPlayer>(character).time == 0.5f);
    // Joint 1, at (0, 1, 0), has turned a quarter to the left; two more hang on it.
    CHECK(glm::distance(tip(stage.pose(character).joints), Vec3(-2, 1, 0)) < 1e-5f);
    stage.step(6);
    CHECK(stage.world.get<const ClipPlayer>(character).time == 0.0f);  // wrapped around
}

TEST_CASE(
    "pose system: previous joints are those of the last step, in the first step the current ones") {
    Stage stage;
    const Entity early = stage.world.create(
        Transform{}, Skeleton{{0}}, ClipPlayer{.clip = {1}}, MorphWeights{{0.5f, 0}, {}});
    start_world(stage.world);
    CHECK(equal(stage.pose(early).previous, stage.pose(early).joints));
    CHECK(stage.world.get<const MorphWeights>(early).previous.size() == 2);
    for (int i = 0; i < 5; ++i) {
        const std::vector<Affine> before = stage.pose(early).joints;
        const std::vector<float> weights = stage.world.get<const MorphWeights>(early).weights;
        stage.step();
        CHECK(equal(stage.pose(early).previous, before));
        CHECK_FALSE(equal(stage.pose(early).joints, before));
        CHECK(stage.world.get<const MorphWeights>(early).previous == weights);
        CHECK(stage.world.get<const MorphWeights>(early).weights[1] > weights[1]);
        CHECK(stage.world.get<const MorphWeights>(early).weights[0] == 0.5f);
    }
    const Entity late = stage.world.create(
        Transform{}, Skeleton{{0}}, ClipPlayer{.clip = {1}, .time = 0.5f},
        MorphWeights{{0, 0}, {}});
    stage.step();
    CHECK(equal(stage.pose(late).previous, stage.pose(late).joints));
    const auto& morph = stage.world.get<const MorphWeights>(late);
    CHECK(morph.previous == morph.weights);
    CHECK(morph.weights[1] > 0.25f);
}

TEST_CASE("pose system: a teleport of a character, or of an ancestor, gives no velocity") {
    Stage stage;
    const Entity cart = stage.world.create(Transform{});
    const Entity rider = stage.world.create(
        Transform{}, Parent{cart}, Skeleton{{0}}, ClipPlayer{.clip = {0}},
        MorphWeights{{0, 0}, {}});
    start_world(stage.world);
    stage.step();
    CHECK_FALSE(equal(stage.pose(rider).previous, stage.pose(rider).joints));
    for (const Entity jumping : {rider, cart}) {
        stage.world.add(jumping, Teleport{});
        stage.step();
        CHECK(equal(stage.pose(rider).previous, stage.pose(rider).joints));
        stage.step();
        CHECK_FALSE(equal(stage.pose(rider).previous, stage.pose(rider).joints));
    }
}

TEST_CASE("pose system: an entity attached to a joint is sheared like a child of entities with the "
          "same transforms") {
    const Quat turned = rotation_about({0, 0, 1}, radians(45));
    Assets assets;
    SkeletonData skeleton = make_chain(3);
    skeleton.rest.scales[1] = {2, 1, 1};
    skeleton.rest.rotations[2] = turned;
    assets.skeletons.push_back(skeleton);
    Stage stage;
    stage.world.insert_resource(std::move(assets));
    const Quat leaning = rotation_about({1, 0, 0}, 0.4f);
    const Transform start{.position = {1, 2, 3}, .rotation = leaning, .scale = {1, 3, 1}};
    const Entity character = stage.world.create(Transform{start}, Skeleton{{0}});
    const Entity attached =
        stage.world.create(Transform{}, Parent{character}, JointAttachment{character, 2});
    const Entity below = stage.world.create(Transform{.rotation = turned}, Parent{attached});
    const auto add = [&stage](const Transform& transform, Entity parent) {
        return stage.world.create(Transform{transform}, Parent{parent});
    };
    const Entity root = stage.world.create(Transform{start});
    const Entity wide = add({.position = {0, 1, 0}, .scale = {2, 1, 1}}, root);
    const Entity tip = add({.position = {0, 1, 0}, .rotation = turned}, wide);
    const Entity leaf = add({.rotation = turned}, tip);
    start_world(stage.world);
    for (int step = 0; step < 3; ++step) {
        for (const auto& [one, other] : {std::pair(attached, tip), std::pair(below, leaf)}) {
            const Affine& a = stage.world.get<const WorldTransform>(one).world;
            const Affine& b = stage.world.get<const WorldTransform>(other).world;
            for (int row = 0; row < 3; ++row) {
                CHECK(glm::distance(a.row[row], b.row[row]) < 1e-5f);
            }
        }
        stage.step();
        stage.world.get<Transform>(character).position.x += 1;
        stage.world.get<Transform>(root).position.x += 1;
    }
}

TEST_CASE("pose system: without a clip, or with one that does not fit, a character rests") {
    Stage stage;
    const Entity bare = stage.world.create(Transform{}, Skeleton{{0}});
    const Entity none = stage.world.create(Transform{}, Skeleton{{0}}, ClipPlayer{});
    const Entity other = stage.world.create(Transform{}, Skeleton{{0}}, ClipPlayer{.clip = {2}});
    const Entity small = stage.world.create(
        Transform{}, Skeleton{{0}}, ClipPlayer{.clip = {1}}, MorphWeights{{7}, {}});
    const Entity gone = stage.world.create(Transform{}, Skeleton{{9}}, ClipPlayer{.clip = {9}});
    start_world(stage.world);
    stage.step(3);
    for (const Entity entity : {bare, none, other, small}) {
        CHECK(tip(stage.pose(entity).joints) == Vec3(0, 3, 0));
    }
    CHECK(stage.world.get<const MorphWeights>(small).weights[0] == 7);
    CHECK(stage.pose(gone).joints.empty());
}

TEST_CASE("pose system: new characters get weights for the morph targets of their meshes") {
    Stage stage;
    const Entity character =
        stage.world.create(Transform{}, Skeleton{{0}}, ClipPlayer{.clip = {1}});
    const Entity own = stage.world.create(Transform{}, Skeleton{{0}}, MorphWeights{{2}, {}});
    const Entity plain = stage.world.create(Transform{}, Skeleton{{0}});
    for (const Entity followed : {character, own}) {
        stage.world.create(
            Transform{}, MeshInstance{{0}, {}},
            Deformed{.character = followed, .skin = {}, .first_morph = 2});
    }
    start_world(stage.world);
    CHECK(stage.world.get<const MorphWeights>(character).weights == std::vector<float>(5, 0.0f));
    CHECK(stage.world.get<const MorphWeights>(own).weights == std::vector<float>{2});
    CHECK_FALSE(stage.world.has<MorphWeights>(plain));
    stage.step();
    CHECK(stage.world.get<const MorphWeights>(character).weights[1] > 0);
}

TEST_CASE("pose system: faces that are animated get weights for all levels of detail") {
    Stage stage;
    stage.world.resource<Assets>().meshes.emplace_back();  // without morph targets
    const MeshLevels levels = {.meshes = {{1}, {0}}};
    const auto create = [&](auto... more) {
        const Entity made =
            stage.world.create(Transform{}, Skeleton{{0}}, MeshInstance{{1}, {}}, levels, more...);
        stage.world.add(made, Deformed{.character = made, .skin = {}});
        return made;
    };
    const Entity talks = create(MorphPlayer{});
    const Entity silent = create();
    start_world(stage.world);
    CHECK(stage.world.get<const MorphWeights>(talks).weights == std::vector<float>(3, 0.0f));
    CHECK_FALSE(stage.world.has<MorphWeights>(silent));
}

TEST_CASE("pose system: morph weights move without a skeleton too" * technique("char.morph-anim")) {
    Stage stage;
    ClipData fade;
    fade.duration = 1;
    fade.sheets.push_back({});
    fade.sheets[0].times = {0, 1};
    fade.sheets[0].morphing = {1};
    fade.sheets[0].weights = {0, 1};
    stage.world.resource<Assets>().clips.push_back(fade);
    const Entity face =
        stage.world.create(ClipPlayer{.clip = {3}, .time = 0.5f}, MorphWeights{{0.25f, 0.75f}, {}});
    start_world(stage.world);
    CHECK(stage.world.get<const MorphWeights>(face).weights == std::vector<float>{0.25f, 0.5f});
    CHECK(stage.world.get<const MorphWeights>(face).previous == std::vector<float>{0.25f, 0.5f});
    stage.step();
    CHECK(stage.world.get<const MorphWeights>(face).previous == std::vector<float>{0.25f, 0.5f});
    CHECK(stage.world.get<const MorphWeights>(face).weights[1] > 0.5f);
}

namespace {

/// A clip that moves morph weights along one curve.
ClipData make_fade(
    std::vector<std::uint16_t> targets, std::vector<float> times, std::vector<float> weights) {
    ClipData fade;
    fade.duration = times.back();
    ClipSheet& sheet = fade.sheets.emplace_back();
    sheet.morphing = std::move(targets);
    sheet.times = std::move(times);
    sheet.weights = std::move(weights);
    return fade;
}

}  // namespace

TEST_CASE(
    "morph player: curves are scaled by the weight of their animation, tiny weights are ignored"
    * technique("char.morph-anim")) {
    std::vector<float> weights = {0, 0, 1};
    const ClipData fade = make_fade({0, 1}, {0, 1}, {0.5f, 0.00005f, 0.5f, 0.00005f});
    add_morph_weights(fade, 0.5f, 0.5f, weights);
    CHECK(weights == std::vector<float>{0.25f, 0, 1});
    add_morph_weights(fade, 0.5f, 0.5f, weights);
    CHECK(weights[0] == 0.5f);  // added, not set
    add_morph_weights(make_fade({1}, {0}, {1}), 0, 1, weights);
    CHECK(weights[1] == 0);  // a single key does nothing
    add_morph_weights(make_fade({1}, {0, 1}, {-1, -1}), 0.5f, 1, weights);
    CHECK(weights[1] == 0);
}

TEST_CASE(
    "morph player: animations of different regions add up, step by step"
    * technique("char.morph-anim")) {
    Stage stage;
    Assets& assets = stage.world.resource<Assets>();
    assets.clips.push_back(make_fade({0}, {0, 2}, {1, 1}));
    assets.clips.push_back(make_fade({1, 0}, {0, 2}, {0.5f, 0.25f, 0.5f, 0.25f}));
    assets.clips.push_back(make_fade({9}, {0, 1}, {1, 1}));
    const MorphAnimation smile = {.clip = {3}, .weight = 0.5f};
    const MorphAnimation frown = {.clip = {4}};
    const MorphAnimation strange = {.clip = {5}};
    const auto make = [&](std::vector<MorphAnimation> animations, bool with_body) {
        const Entity face =
            stage.world.create(MorphWeights{{0, 0, 0.75f}, {}}, MorphPlayer{std::move(animations)});
        if (with_body) {
            stage.world.add(face, Skeleton{{0}});
        }
        return face;
    };
    const Entity one = make({smile}, false);
    const Entity other = make({frown}, true);
    const Entity both = make({smile, frown, strange}, true);
    const Entity nobody = make({MorphAnimation{.clip = {77}}}, false);
    start_world(stage.world);
    for (int i = 0; i < 4; ++i) {  // what was there is cleared, or each step would add to it
        const auto weights = [&](Entity face) {
            return stage.world.get<const MorphWeights>(face).weights;
        };
        CHECK(weights(one) == std::vector<float>{0.5f, 0, 0.75f});
        CHECK(weights(other) == std::vector<float>{0.25f, 0.5f, 0.75f});
        CHECK(weights(both) == std::vector<float>{0.75f, 0.5f, 0.75f});
        CHECK(weights(nobody) == std::vector<float>{0, 0, 0.75f});
        CHECK(stage.world.get<const MorphWeights>(both).previous == weights(both));
        CHECK(stage.world.get<const MorphWeights>(one).previous == weights(one));
        stage.step();
    }
    CHECK(stage.world.get<const MorphPlayer>(both).animations[1].time > 0.06f);
}

TEST_CASE("pose system: an entity attached to a joint follows it in the same step") {
    Stage stage;
    const Entity character = stage.world.create(
        Transform{.position = {10, 0, 0}}, Skeleton{{0}}, ClipPlayer{.clip = {0}});
    const Entity lamp =
        stage.world.create(Transform{}, Parent{character}, JointAttachment{character, 3});
    const Entity lost = stage.world.create(
        Transform{.position = {1, 2, 3}}, Parent{character}, JointAttachment{character, 30});
    start_world(stage.world);
    for (int i = 0; i < 20; ++i) {
        const Vec3 at = transform_point(stage.world.get<const WorldTransform>(lamp).world, Vec3(0));
        CHECK(glm::distance(at, Vec3(10, 0, 0) + tip(stage.pose(character).joints)) < 1e-5f);
        stage.step();
    }
    CHECK(stage.world.get<const Transform>(lost).position == Vec3(1, 2, 3));
}

TEST_CASE("pose system: steps after a character's first allocate nothing") {
    const int before = thread_count();
    set_thread_count(1);
    Stage stage;
    for (int i = 0; i < 50; ++i) {
        const Entity character = stage.world.create(
            Transform{}, Skeleton{{0}}, ClipPlayer{.clip = {1}}, MorphWeights{{0, 0}, {}});
        stage.world.create(Transform{}, Parent{character}, JointAttachment{character, 3});
        stage.world.create(Transform{}, Skeleton{{0}}, ClipPlayer{.clip = {0}}, CrowdPose{});
    }
    start_world(stage.world);
    const auto step = [&] {
        stage.world.run(advance_clips);
        stage.world.run(update_poses);
        stage.world.run(update_attachments);
    };
    // What running a system costs by itself, with nobody to update.
    World empty;
    empty.insert_resource(Assets{});
    empty.insert_resource(FrameTime{});
    const auto nothing = [&] {
        empty.run(advance_clips);
        empty.run(update_poses);
        empty.run(update_attachments);
    };
    for (int i = 0; i < 3; ++i) {
        step();
        nothing();
    }
    const std::size_t bare = bytes_allocated_by(nothing);
    CHECK(bytes_allocated_by(step) <= bare);
    set_thread_count(before);
}

TEST_CASE("pose system: a crowd has the same bits on any number of threads") {
    const int before = thread_count();
    const std::vector<std::uint64_t> one = crowd_hashes(1, 10);
    CHECK(crowd_hashes(1, 10) == one);
    CHECK(crowd_hashes(2, 10) == one);
    CHECK(crowd_hashes(5, 10) == one);
    CHECK(one[0] != one[1]);
    set_thread_count(before);
}

TEST_CASE("pose system: a world restored from a snapshot continues with the same bits") {
    register_all_components();
    Stage stage;
    for (int i = 0; i < 20; ++i) {
        stage.world.create(
            Transform{}, Skeleton{{0}},
            ClipPlayer{.clip = {1}, .time = 0.1f * static_cast<float>(i), .speed = -1.5f},
            MorphWeights{{0, 0}, {}});
    }
    start_world(stage.world);
    stage.step(7);
    const Result<std::vector<std::byte>> image = save_snapshot(stage.world);
    REQUIRE(image.ok());
    Stage other;
    const Status restored = restore_snapshot(other.world, *image);
    REQUIRE(restored.ok());
    for (int i = 0; i < 30; ++i) {
        stage.step();
        other.step();
        REQUIRE(state_hash(other.world) == state_hash(stage.world));
    }
}

}  // namespace limn::pose_system_test
