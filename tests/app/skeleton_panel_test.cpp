#include "content/app/panels/edit_json.h"
#include "content/app/panels/skeleton_panel.h"
#include "content/app/panels/undo.h"
#include "content/bake/motion/pose_editing.h"
#include "ecs/base/rotation.h"
#include "ecs/components/all.h"
#include "ecs/components/animation.h"
#include "ecs/components/camera.h"
#include "ecs/components/name.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "render/render_view.h"
#include "systems/update_world.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <string>
#include <utility>

namespace limn::skeleton_panel_test {

using test::near;

namespace {

/// A trunk with two arms; the elbow is a hinge from 0 to 90 degrees.
SkeletonData make_figure() {
    SkeletonData figure;
    figure.name = "figure";
    figure.joints = {"trunk", "arm.L", "elbow.L", "arm.R", "elbow.R"};
    figure.parents = {-1, 0, 1, 0, 3};
    figure.rest.translations = {
        Vec3(0, 1, 0), Vec3(0.3f, 0, 0), Vec3(0.4f, 0, 0), Vec3(-0.3f, 0, 0), Vec3(-0.4f, 0, 0)};
    figure.rest.rotations.assign(5, Quat(1, 0, 0, 0));
    figure.rest.scales.assign(5, Vec3(1));
    figure.freedoms = {
        {.joint = 2, .axis = {0, 0, 1}, .min = 0, .max = radians(90.0f)},
        {.joint = 4, .axis = {0, 0, -1}, .min = 0, .max = radians(90.0f)}};
    return figure;
}

struct FigureStage {
    World world;
    Schedule schedule = make_world_schedule();
    UndoStack undo;
    SkeletonPanel panel;
    Entity figure;

    FigureStage() {
        register_all_components();
        Assets assets;
        assets.skeletons.push_back(make_figure());
        ClipData clip;
        clip.name = "swing";
        clip.duration = 2;
        ClipSheet sheet;
        sheet.times = {0, 2};
        sheet.rotating = {1};
        sheet.rotations = {Quat(1, 0, 0, 0), rotation_about({0, 0, 1}, 1.0f)};
        clip.sheets.push_back(std::move(sheet));
        assets.clips.push_back(std::move(clip));
        world.insert_resource(std::move(assets));
        figure = world.create(
            Name{"figure"}, Transform{}, Skeleton{{0}},
            ClipPlayer{.clip = {0}, .time = 0, .loop = false});
        start_world(world);
        panel.open(figure);
    }
    void step(int count = 1) {
        for (int i = 0; i < count; ++i) {
            step_world(world, schedule);
            panel.record(world, static_cast<double>(++steps_) / 60);
        }
    }
    [[nodiscard]] CharacterView view() { return *view_character(world, figure); }
    [[nodiscard]] float turn_of(std::uint16_t joint) {
        return 2
               * std::acos(
                   std::min(std::abs(shown_turn(*view().skeleton, view().joints, joint).w), 1.0f));
    }
    [[nodiscard]] std::size_t keys() { return world.get<const PoseKeys>(figure).keys.size(); }

  private:
    int steps_ = 0;
};

RenderView view_from(const Vec3& eye, const Vec3& at) {
    const Affine camera = look_at(eye, at);
    return make_render_view(Camera{}, camera, camera, {.width = 800, .height = 600});
}

float difference(const Quat& a, const Quat& b) {
    return 1 - std::abs(glm::dot(a, b));
}

}  // namespace

TEST_CASE(
    "skeleton panel: a turn sets a key, undo and redo take it back and set it again"
    * technique("char.fk-keypose")) {
    FigureStage stage;
    stage.step(30);
    const float swung = stage.turn_of(1);
    CHECK(swung == near(0.25f).epsilon(1e-3));
    stage.panel.start_poses(stage.world, stage.undo);
    stage.step();
    CHECK(stage.keys() == 1);
    CHECK(stage.turn_of(1) == near(swung).epsilon(1e-3));  // its present pose
    // To begin is one edit.
    CHECK(stage.undo.undo(stage.world).find("begin") != std::string::npos);
    CHECK_FALSE(stage.world.has<PoseKeys>(stage.figure));
    CHECK(stage.world.get<const ClipPlayer>(stage.figure).clip == ClipId{0});
    CHECK(stage.undo.undo_count() == 0);
    stage.undo.redo(stage.world);
    stage.step();
    CHECK(stage.keys() == 1);
    CHECK(stage.turn_of(1) == near(swung).epsilon(1e-3));

    stage.panel.select(3);
    stage.panel.set_time(stage.world, 1);
    for (const float angle : {0.1f, 0.2f, 0.7f}) {  // a drag
        stage.panel.turn_selected(stage.world, stage.undo, rotation_about({0, 1, 0}, angle));
    }
    stage.panel.release();
    stage.step();
    CHECK(stage.keys() == 2);
    CHECK(stage.turn_of(3) == near(0.7f).epsilon(1e-3));
    CHECK(stage.turn_of(1) == near(swung).epsilon(1e-3));
    stage.panel.set_time(stage.world, 0.5f);
    stage.step();
    CHECK(stage.turn_of(3) == near(0.35f).epsilon(1e-3));

    CHECK(stage.undo.undo(stage.world).find("arm.R at 1.00 s") != std::string::npos);
    stage.step();
    CHECK(stage.keys() == 1);
    CHECK(stage.turn_of(3) < 1e-3f);
    stage.undo.redo(stage.world);
    stage.step();
    CHECK(stage.keys() == 2);
    CHECK(stage.turn_of(3) == near(0.35f).epsilon(1e-3));
    while (!stage.undo.undo(stage.world).empty()) {
    }
    stage.step();
    CHECK_FALSE(stage.world.has<PoseKeys>(stage.figure));
    CHECK(stage.world.get<const ClipPlayer>(stage.figure).clip == ClipId{0});
}

TEST_CASE(
    "skeleton panel: keys are set, removed and mirrored, and are part of the level's edits"
    * technique("char.fk-keypose")) {
    FigureStage stage;
    stage.panel.start_poses(stage.world, stage.undo);
    stage.panel.set_time(stage.world, 2);
    stage.panel.set_key(stage.world, stage.undo);
    CHECK(stage.keys() == 2);
    stage.panel.select(1);
    stage.panel.turn_selected(stage.world, stage.undo, rotation_about({0, 0, 1}, 0.5f));
    stage.panel.mirror(stage.world, stage.undo);
    stage.step();
    CHECK(stage.turn_of(1) < 1e-3f);
    CHECK(stage.turn_of(3) == near(0.5f).epsilon(1e-3));
    CHECK(edits_as_json(stage.world, stage.undo.done()).find("\"pose_keys\"") != std::string::npos);
    stage.panel.remove_key(stage.world, stage.undo);
    CHECK(stage.keys() == 1);
    stage.panel.remove_key(stage.world, stage.undo);  // there is none
    CHECK(stage.keys() == 1);
}

TEST_CASE("skeleton panel: a joint turns within its limits") {
    FigureStage stage;
    stage.panel.start_poses(stage.world, stage.undo);
    stage.panel.select(2);
    stage.panel.turn_selected(stage.world, stage.undo, rotation_about({0, 0, 1}, 2.5f));
    stage.step();
    CHECK(stage.turn_of(2) == near(radians(90.0f)).epsilon(1e-3));
    stage.panel.turn_selected(stage.world, stage.undo, rotation_about({0, 0, 1}, -1));
    stage.step();
    CHECK(stage.turn_of(2) < 1e-3f);
}

TEST_CASE("skeleton view: angles of a joint are those of its turn") {
    const SkeletonData figure = make_figure();
    for (const Vec3& angles :
         {Vec3(0.3f, -0.4f, 2), Vec3(-2, 1.2f, 0.1f), Vec3(1, kPi / 2, 0.2f)}) {
        const Quat turn = rotation_about({0, 1, 0}, angles.x) * rotation_about({1, 0, 0}, angles.y)
                          * rotation_about({0, 0, 1}, angles.z);
        CHECK(difference(turn_of_angles(joint_angles(figure, 1, turn)), turn) < 1e-5f);
        CHECK(difference(limit_turn(figure, 1, turn), turn) < 1e-6f);
    }
    const auto hinge = joint_angles(figure, 4, rotation_about({0, 0, -1}, 0.6f));
    REQUIRE(hinge.size() == 1);
    CHECK(hinge[0].value == near(0.6f).epsilon(1e-4));
    CHECK(hinge[0].max == near(radians(90.0f)));
    CHECK(hinge[0].name == "z");
}

TEST_CASE(
    "skeleton view: ghosts before and after are the clip's poses, trails pass the joints"
    * technique("char.ghost-view")) {
    FigureStage stage;
    stage.step(60);
    MotionHistory none;
    const CharacterView view = stage.view();
    for (const float offset : {-0.5f, 0.0f, 0.5f}) {
        const auto moment = moment_at(view, none, offset);
        REQUIRE(moment.has_value());
        const Quat want = rotation_about({0, 0, 1}, 0.5f * (1 + offset));
        CHECK(difference(shown_turn(*view.skeleton, moment->joints, 1), want) < 1e-5f);
    }
    CHECK_FALSE(moment_at(view, none, 1.5f).has_value());  // it does not loop
    const std::vector<Vec3> trail = trail_of(view, none, 2, 0.5f, 0.5f);
    REQUIRE(trail.size() == 61);
    const Vec3 now = transform_point(view.world_from_character * view.joints[2], Vec3(0));
    CHECK(glm::distance(trail[30], now) < 1e-4f);
    const JointCurves curves = curves_of(view, none, 1, 0.5f, 0.5f);
    REQUIRE(curves.curves.size() == 3);
    CHECK(curves.curves[2].values.front() == near(degrees(0.25f)).epsilon(1e-3));
    CHECK(curves.curves[2].values.back() == near(degrees(0.75f)).epsilon(1e-3));
}

TEST_CASE(
    "skeleton view: of what no clip moves, the past is what was shown"
    * technique("char.ghost-view")) {
    FigureStage stage;
    stage.world.remove<ClipPlayer>(stage.figure);
    MotionHistory history;
    for (int i = 0; i <= 400; ++i) {
        stage.world.get<Transform>(stage.figure).position.x = 0.01f * static_cast<float>(i);
        stage.step();
        history.record(stage.view(), i / 60.0);
        history.record(stage.view(), i / 60.0);  // a frame without a step
    }
    CHECK(history.moments().size() == MotionHistory::kMoments);
    const auto before = moment_at(stage.view(), history, -1);
    REQUIRE(before.has_value());
    CHECK(before->world_from_character.row[0].w == near(3.4f).epsilon(1e-3));
    CHECK_FALSE(moment_at(stage.view(), history, 0.1f).has_value());
    CHECK_FALSE(moment_at(stage.view(), history, -100).has_value());
    history.record(stage.view(), 0);  // time went back
    CHECK(history.moments().size() == 1);
}

TEST_CASE(
    "pose gizmo: rings and joints are picked where they are drawn, a ring measures its angle") {
    const RenderView view = view_from({0, 1, 3}, {0, 1, 0});
    const IVec2 window(800, 600);
    const Affine joint = affine_from({0.2f, 1.1f, 0}, rotation_about({1, 2, 3}, 0.7f), Vec3(1));
    const PoseGizmo gizmo = make_gizmo(view, joint);
    CHECK(gizmo.radius > 0.1f);
    for (int axis = 0; axis < 3; ++axis) {
        for (const float angle : {0.3f, 2.0f, -1.5f}) {
            const Vec3 point = ring_point(gizmo, axis, angle);
            const auto pixel = window_point(view, point, window);
            REQUIRE(pixel.has_value());
            CHECK(pick_ring(gizmo, view, *pixel, window).has_value());
            const auto got = ring_angle(gizmo, axis, ray_through(view, *pixel / Vec2(window)));
            REQUIRE(got.has_value());
            CHECK(*got == near(angle).epsilon(1e-2));
        }
    }
    CHECK_FALSE(pick_ring(gizmo, view, {5, 5}, window).has_value());
    const std::vector<Vec3> points = {{0, 1, 0}, {0.5f, 1, 0}, {0, 1, 9}};
    const auto middle = window_point(view, points[0], window);
    REQUIRE(middle.has_value());
    CHECK(glm::distance(*middle, Vec2(400, 300)) < 1);
    CHECK(pick_joint(points, view, *middle + Vec2(5, 0), window) == std::uint16_t{0});
    CHECK_FALSE(pick_joint(points, view, {40, 40}, window).has_value());
}

}  // namespace limn::skeleton_panel_test
