#include "ecs/components/all.h"
#include "ecs/components/animation.h"
#include "ecs/components/camera.h"
#include "ecs/components/camera_path.h"
#include "ecs/components/rotation_track.h"
#include "ecs/components/step_jumps.h"
#include "ecs/hierarchy.h"
#include "systems/animation/clip_jumps.h"
#include "systems/animation/clip_player_system.h"
#include "systems/update_world.h"
#include "tests/near.h"
#include "tests/systems/clip_fixture.h"

#include <doctest/doctest.h>

#include <vector>

namespace limn::step_jumps_test {

using namespace limn::test;

namespace {

/// Joint 1 of three moves along x through these values.
ClipData make_slide(
    Interpolation interpolation, const std::vector<float>& times, const std::vector<float>& xs) {
    ClipData clip;
    clip.name = "slide";
    clip.duration = times.back();
    ClipSheet sheet;
    sheet.interpolation = interpolation;
    sheet.times = times;
    sheet.translating = {1};
    for (const float x : xs) {
        sheet.translations.emplace_back(x, 1, 0);
    }
    clip.sheets.push_back(sheet);
    return clip;
}

std::vector<float> joint_jumps(const ClipData& clip, const ClipStep& step) {
    std::vector<float> at(3, kNoJump);
    find_clip_jumps(clip, step, at, {});
    CHECK(may_jump(clip, step) >= (at[1] != kNoJump));
    CHECK(at[0] == kNoJump);
    CHECK(at[2] == kNoJump);
    return at;
}

float slide_jump(const ClipData& clip, const ClipStep& step) {
    return joint_jumps(clip, step)[1];
}

struct JumpStage {
    World world;
    Schedule schedule = make_world_schedule();

    explicit JumpStage(float step) { world.insert_resource(FrameTime{.step = step}); }
    void add_clip(const ClipData& clip) {
        Assets assets;
        assets.skeletons.push_back(make_chain(3));
        assets.clips.push_back(clip);
        world.insert_resource(std::move(assets));
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) {
            step_world(world, schedule);
        }
    }
    [[nodiscard]] const Affine& now(Entity e) { return world.get<const WorldTransform>(e).world; }
    [[nodiscard]] const Affine& previous(Entity e) {
        return world.get<const PreviousWorldTransform>(e).world;
    }
    [[nodiscard]] const TransformJump* jump(Entity e) {
        return find_jump(world.find_resource<StepJumps>(), e);
    }
};

float x_of(const Affine& a) {
    return a.row[0].w;
}

}  // namespace

TEST_CASE("clip jumps: a step key counts at its own time, forward and backward") {
    const ClipData clip = make_slide(Interpolation::Step, {0, 1, 1.5f, 2}, {-1, 1, 1, 3});
    CHECK(slide_jump(clip, {0.9f, 1.1f}) == test::near(0.5));
    CHECK(slide_jump(clip, {0.9f, 1.0f}) == test::near(1.0));
    CHECK(slide_jump(clip, {1.0f, 1.1f}) == kNoJump);  // it has jumped already
    CHECK(slide_jump(clip, {0.5f, 0.9f}) == kNoJump);
    CHECK(slide_jump(clip, {1.4f, 1.6f}) == kNoJump);  // a key of the same value
    CHECK(slide_jump(clip, {1.05f, 0.9f}) == test::near(1.0 / 3));
    CHECK(slide_jump(clip, {1.75f, 2.0f}) == test::near(1.0));
    CHECK_FALSE(may_jump(clip, {0.5f, 0.9f}));
}

TEST_CASE("clip jumps: a loop jumps where it starts over, unless it closes") {
    const ClipData open = make_slide(Interpolation::Linear, {0, 1}, {-1, 1});
    CHECK(slide_jump(open, {-0.05f, 0.15f, true}) == test::near(0.25));
    CHECK(slide_jump(open, {1.15f, 0.95f, true}) == test::near(0.75));
    CHECK(slide_jump(open, {0.5f, 0.7f, true}) == kNoJump);
    CHECK(slide_jump(open, {0.9f, 1.0f, false}) == kNoJump);
    const ClipData closed = make_slide(Interpolation::Linear, {0, 0.5f, 1}, {2, 5, 2});
    CHECK(slide_jump(closed, {-0.05f, 0.15f, true}) == kNoJump);
    const ClipData turned = make_turn({0, 0.5f, 1, 1.5f, 2}, {0, 90, 180, 270, 360}, 1);
    CHECK(slide_jump(turned, {-0.05f, 0.15f, true}) == kNoJump);
    const ClipData stepped = make_slide(Interpolation::Step, {0, 0.1f, 1}, {-1, 1, 2});
    CHECK(slide_jump(stepped, {-0.1f, 0.05f, true}) == test::near(2.0 / 3));
    CHECK(slide_jump(stepped, {-0.1f, 0.15f, true}) == test::near(0.8));
}

TEST_CASE("clip jumps: two keys at nearly the same time are a jump, a fast motion is none") {
    const ClipData abrupt = make_slide(Interpolation::Linear, {0, 1, 1.000001f, 2}, {-1, -1, 1, 1});
    CHECK(slide_jump(abrupt, {0.99f, 1.01f}) == test::near(0.5).epsilon(1e-3));
    CHECK(slide_jump(abrupt, {1.01f, 1.03f}) == kNoJump);
    CHECK(slide_jump(abrupt, {0.97f, 0.99f}) == kNoJump);
    const ClipData fast = make_slide(Interpolation::Linear, {0, 1, 1.001f, 2}, {-1, -1, 1, 1});
    CHECK(slide_jump(fast, {0.99f, 1.01f}) == kNoJump);
}

TEST_CASE("step jumps: joints that jump, their descendants and attachments have no velocity; the "
          "state before is kept until the time of the jump") {
    JumpStage stage(0.25f);
    stage.add_clip(make_slide(Interpolation::Linear, {0, 0.875f}, {0, 7}));
    const Entity walker = stage.world.create(Transform{}, Skeleton{{0}}, ClipPlayer{{0}});
    const Entity tip = stage.world.create(Transform{}, Parent{walker}, JointAttachment{walker, 2});
    const Entity hat = stage.world.create(Transform{.position = {0, 3, 0}}, Parent{tip});
    start_world(stage.world);
    stage.run(3);
    const auto& pose = std::as_const(stage.world).get<Pose>(walker);
    CHECK(pose.joints[1].row[0].w == test::near(6));
    CHECK(pose.previous[1].row[0].w == test::near(4));  // it moves
    CHECK(pose.jumps.empty());
    CHECK(stage.jump(tip) == nullptr);
    stage.run(1);  // the loop ends halfway through this step
    REQUIRE(pose.jumps.size() == 2);
    CHECK(pose.jumps[0].index == 1);
    CHECK(pose.jumps[0].at == test::near(0.5));
    CHECK(pose.jumps[0].before.row[0].w == test::near(6));
    CHECK(pose.joints[2].row[0].w == test::near(1));
    for (std::size_t i = 0; i < 3; ++i) {
        for (int row = 0; row < 3; ++row) {
            CHECK(pose.previous[i].row[row] == pose.joints[i].row[row]);
        }
    }
    for (const Entity entity : {tip, hat}) {
        CHECK(x_of(stage.now(entity)) == test::near(1));
        CHECK(x_of(stage.previous(entity)) == x_of(stage.now(entity)));
        REQUIRE(stage.jump(entity) != nullptr);
        CHECK(stage.jump(entity)->at == test::near(0.5));
        CHECK(x_of(stage.jump(entity)->before) == test::near(6));
    }
    CHECK(stage.jump(walker) == nullptr);
    stage.run(1);
    CHECK(pose.jumps.empty());
    CHECK(stage.jump(hat) == nullptr);
    CHECK(x_of(stage.previous(hat)) == test::near(1));
    CHECK(x_of(stage.now(hat)) == test::near(3));
}

TEST_CASE("step jumps: morph weights jump with the loop of each of their clips") {
    ClipData fade;
    fade.duration = 0.875f;
    ClipSheet sheet;
    sheet.times = {0, 0.875f};
    sheet.morphing = {1};
    sheet.weights = {0, 0.875f};
    fade.sheets.push_back(sheet);
    JumpStage stage(0.25f);
    stage.add_clip(fade);
    const Entity played = stage.world.create(ClipPlayer{{0}}, MorphWeights{{0.5f, 0}, {}});
    const Entity layered =
        stage.world.create(MorphPlayer{{{.clip = {0}}}}, MorphWeights{{0.5f, 0}, {}});
    start_world(stage.world);
    stage.run(3);
    for (const Entity face : {played, layered}) {
        const auto& morph = std::as_const(stage.world).get<MorphWeights>(face);
        CHECK(morph.previous[1] == test::near(0.5));
        CHECK(morph.jumps.empty());
    }
    stage.run(1);
    for (const Entity face : {played, layered}) {
        const auto& morph = std::as_const(stage.world).get<MorphWeights>(face);
        CHECK(morph.weights[1] == test::near(0.125));
        CHECK(morph.previous == morph.weights);
        REQUIRE(morph.jumps.size() == 1);
        CHECK(morph.jumps[0].index == 1);
        CHECK(morph.jumps[0].at == test::near(0.5));
        CHECK(morph.jumps[0].before == test::near(0.75));
    }
}

TEST_CASE("step jumps: a pose that is replaced has no velocity, while its entity keeps its own") {
    JumpStage stage(0.25f);
    stage.add_clip(make_slide(Interpolation::Linear, {0, 10}, {0, 10}));
    const Entity walker = stage.world.create(Transform{}, Sway{}, Skeleton{{0}}, ClipPlayer{{0}});
    start_world(stage.world);
    stage.run(2);
    stage.world.get<ClipPlayer>(walker).time = 8;
    stage.world.add(walker, PoseCut{});
    stage.run(1);
    const auto& pose = std::as_const(stage.world).get<Pose>(walker);
    CHECK(pose.joints[1].row[0].w == test::near(8.25));
    CHECK(pose.previous[1].row[0].w == pose.joints[1].row[0].w);
    CHECK(stage.now(walker).row[1].w != stage.previous(walker).row[1].w);
    CHECK_FALSE(stage.world.has<PoseCut>(walker));
    stage.run(1);
    CHECK(pose.previous[1].row[0].w == test::near(8.25));
    CHECK(pose.joints[1].row[0].w == test::near(8.5));
}

TEST_CASE("step jumps: a camera path cuts between keys of the same time, and where a loop does not "
          "close") {
    CameraPath path;
    path.keys = {
        {.time = 0, .position = {0, 0, 0}},
        {.time = 1, .position = {1, 0, 0}},
        {.time = 1, .position = {5, 0, 0}},
        {.time = 2, .position = {6, 0, 0}}};
    CHECK(camera_cut(path, 0.9, 1.1).value_or(-1) == 1.0);
    CHECK(camera_cut(path, 0.9, 1.0).value_or(-1) == 1.0);
    CHECK_FALSE(camera_cut(path, 1.0, 1.1));
    CHECK_FALSE(camera_cut(path, 1.9, 2.1));
    path.loop = true;
    CHECK(camera_cut(path, 3.9, 4.1).value_or(-1) == 4.0);
    CHECK(camera_cut(path, 4.9, 5.1).value_or(-1) == 5.0);
    CHECK_FALSE(camera_cut(path, 5.1, 5.9));
    path.keys.back() = path.keys.front();
    path.keys.back().time = 2;
    CHECK_FALSE(camera_cut(path, 3.9, 4.1));

    JumpStage stage(0.3f);
    const Entity camera = stage.world.create(Transform{}, path, Camera{});
    start_world(stage.world);
    stage.run(3);
    CHECK(stage.jump(camera) == nullptr);
    stage.run(1);  // from 0.9 s to 1.2 s
    REQUIRE(stage.jump(camera) != nullptr);
    CHECK(stage.jump(camera)->at == test::near(1.0 / 3).epsilon(1e-4));
    CHECK(x_of(stage.jump(camera)->before) < 1.0f);
    CHECK(x_of(stage.now(camera)) > 3.0f);
    CHECK(x_of(stage.previous(camera)) == x_of(stage.now(camera)));
}

TEST_CASE("step jumps: a rotation track jumps where its loop does not close") {
    for (const bool closes : {false, true}) {
        RotationTrack track;
        track.keys = {
            {0, rotation_about({0, 0, 1}, 0)},
            {0.4f, rotation_about({0, 0, 1}, 1)},
            {0.7f, rotation_about({0, 0, 1}, closes ? 0.0f : 2.0f)}};
        track.loop = true;
        JumpStage stage(0.5f);
        const Entity wheel = stage.world.create(Transform{}, track);
        start_world(stage.world);
        stage.run(1);
        CHECK(stage.jump(wheel) == nullptr);
        stage.run(1);  // from 0.5 s to 1.0 s
        CHECK((stage.jump(wheel) == nullptr) == closes);
        if (!closes) {
            CHECK(stage.jump(wheel)->at == test::near(0.4).epsilon(1e-4));
        }
    }
}

}  // namespace limn::step_jumps_test
