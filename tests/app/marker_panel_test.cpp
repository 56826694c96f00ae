#include "content/app/panels/furrow_panel.h"
#include "content/app/panels/marker_panel.h"
#include "content/app/player/pick.h"
#include "content/load/files/atomic_file.h"
#include "content/make/head/head.h"
#include "content/make/head/head_expressions.h"
#include "ecs/components/animation.h"
#include "ecs/components/camera.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "render/render_view.h"
#include "tests/app/run_program.h"
#include "tests/near.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace limn::marker_panel_test {

using test::TemporaryFolder;

namespace {

constexpr IVec2 kWindow = {640, 360};

/// Two frames of four markers, one of them named after a place.
constexpr const char* kTake = "PathFileType\t4\t(X/Y/Z)\ttake.trc\n"
                              "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n"
                              "60\t60\t2\t4\tmm\n"
                              "Frame#\tTime\tA\t\t\tB\t\t\tC\t\t\tnose\n"
                              "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\tX3\tY3\tZ3\tX4\tY4\tZ4\n"
                              "1\t0\t-30\t40\t0\t30\t40\t0\t0\t-60\t10\t0\t0\t30\n"
                              "2\t0.02\t-30\t42\t0\t30\t42\t0\t0\t-62\t10\t0\t0\t30\n";

/// The built-in head, moved and turned, its mouth open, before a camera.
struct FaceStage {
    TemporaryFolder folder;
    World world;
    Entity face;
    RenderView view;
    MarkerPanel panel;

    FaceStage() {
        Assets& assets = world.insert_resource(Assets{});
        assets.meshes.push_back(make_head({}));
        const std::size_t shapes = assets.meshes[0].morphs.size();
        const Affine pose =
            affine_from({1, 2, 3}, glm::normalize(Quat(0.9f, 0.05f, 0.2f, -0.1f)), Vec3(1.5f));
        std::vector<float> weights(shapes, 0.0f);
        weights[expression_index("AU26")] = 0.8f;
        face = world.create(
            WorldTransform{pose}, MeshInstance{{0}, {}},
            MorphWeights{.weights = weights, .previous = weights});
        world.add(face, Deformed{face, {}, 0, Skinning::Linear});
        const Vec3 front = transform_point(pose, Vec3(0.1f, -0.02f, 0.5f));
        const Affine eye = look_at(front, transform_point(pose, Vec3(0, -0.02f, 0)));
        view = make_render_view(Camera{}, eye, eye, {.width = kWindow.x, .height = kWindow.y});
        test::write_text(folder.file("take.trc"), kTake);
        REQUIRE(panel.load(folder.file("take.trc"), ""));
        REQUIRE(panel.open(world, {}));
    }
    [[nodiscard]] const MeshData& mesh() const { return world.find_resource<Assets>()->meshes[0]; }
    [[nodiscard]] bool click(const Vec2& pixel) {
        return panel.take_pointer(world, view, {.at = pixel, .clicked = true, .window = kWindow});
    }
    /// The pixel of a point of the skin, as it is posed.
    [[nodiscard]] Vec2 pixel_of(const SkinPoint& point) const {
        const MorphTarget& jaw = mesh().morphs[expression_index("AU26")];
        std::vector<Vec3> posed = mesh().positions;
        for (std::size_t i = 0; i < jaw.vertices.size(); ++i) {
            posed[jaw.vertices[i]] += 0.8f * jaw.positions[i];
        }
        const Vec3 at =
            transform_point(world.get<const WorldTransform>(face).world, position_on(point, posed));
        const Vec4 clip = view.unjittered_from_world * Vec4(at, 1);
        return Vec2(0.5f + 0.5f * clip.x / clip.w, 0.5f - 0.5f * clip.y / clip.w) * Vec2(kWindow);
    }
};

std::string text_of(const std::string& path) {
    const auto bytes = read_file(path);
    REQUIRE(bytes);
    return {reinterpret_cast<const char*>(bytes->data()), bytes->size()};
}

}  // namespace

TEST_CASE(
    "marker panel: a click places a marker on the skin at rest, whatever pose it is in"
    * technique("face.retarget-fit")) {
    FaceStage stage;
    CHECK_FALSE(stage.panel.point_of(0));
    CHECK(stage.panel.point_of(3));  // by its name
    for (const Vec2 pixel : {Vec2(320, 180), Vec2(322.5f, 231), Vec2(300, 120)}) {
        stage.panel.select(0);
        REQUIRE(stage.click(pixel));
        const auto& point = stage.panel.point_of(0);
        REQUIRE(point);
        for (int k = 0; k < 3; ++k) {
            CHECK(point->weights[k] >= -1e-4f);
        }
        CHECK(glm::distance(stage.pixel_of(*point), pixel) < 0.05f);
        const Vec3 rest = position_on(*point, stage.mesh().positions);
        CHECK(glm::distance(rest, stage.panel.places().back().point) < 1e-6f);
    }
    // Beside the face, over a panel, or without a click nothing is placed.
    const std::size_t count = stage.panel.places().size();
    CHECK_FALSE(stage.click({5, 5}));
    CHECK_FALSE(stage.panel.take_pointer(
        stage.world, stage.view, {.at = {320, 180}, .clicked = true, .blocked = true}));
    CHECK_FALSE(stage.panel.take_pointer(stage.world, stage.view, {.at = {320, 180}}));
    CHECK(stage.panel.places().size() == count);
}

TEST_CASE(
    "marker panel: each click goes on to the next marker without a place, and undo goes back"
    * technique("face.retarget-fit")) {
    FaceStage stage;
    for (const std::size_t expected : {0U, 1U, 2U}) {
        CHECK(stage.panel.selected() == expected);
        REQUIRE(stage.click({300.0f + 20.0f * static_cast<float>(expected), 180}));
    }
    CHECK(stage.panel.take_message() == "every marker has a place");
    CHECK(stage.panel.places().size() == 3);
    stage.panel.select(1);
    stage.panel.remove_place(stage.world);
    CHECK_FALSE(stage.panel.point_of(1));
    CHECK(stage.panel.undo(stage.world));
    CHECK(stage.panel.point_of(1));
    for (std::size_t left = 3; left-- > 0;) {
        CHECK(stage.panel.undo(stage.world));
        CHECK(stage.panel.places().size() == left);
    }
    CHECK_FALSE(stage.panel.undo(stage.world));
}

TEST_CASE(
    "marker panel: the saved file is read back, with its comments, and places the markers there"
    * technique("face.retarget-fit")) {
    FaceStage stage;
    const std::string map = stage.folder.file("take.map");
    test::write_text(map, "# by hand\nC = chin  # below the lip\n\nA = 0 0 0.1\n");
    REQUIRE(stage.panel.load(stage.folder.file("take.trc"), ""));
    REQUIRE(stage.panel.open(stage.world, {}));
    stage.panel.select(0);
    REQUIRE(stage.click({310, 180}));
    stage.panel.select(1);
    REQUIRE(stage.click({330, 170}));
    CHECK(stage.panel.has_unsaved());
    stage.panel.save();
    CHECK_FALSE(stage.panel.has_unsaved());
    const std::string text = text_of(map);
    CHECK(text.starts_with("# by hand\nC = chin  # below the lip\n\nA = "));
    const auto read = parse_marker_map(text, map);
    REQUIRE(read);
    REQUIRE(read->size() == 3);
    const std::vector<std::string> names{"A", "B", "C", "nose"};
    GltfScene scene;
    scene.name = "head";
    scene.meshes.push_back(stage.mesh());
    const auto placed = place_markers(scene, names, *read, map);
    REQUIRE(placed);
    for (std::size_t m = 0; m < names.size(); ++m) {
        const Vec3 shown = position_on(*stage.panel.point_of(m), stage.mesh().positions);
        CHECK(glm::distance(placed->points[m], shown) < 1e-6f);
    }

    test::write_text(map, "D = chin\n");
    const Status wrong = stage.panel.load(stage.folder.file("take.trc"), "");
    CHECK(wrong.error().message.find("no markers \"D\"") != std::string::npos);
    World empty;
    CHECK_FALSE(stage.panel.open(empty, {}));
}

}  // namespace limn::marker_panel_test
