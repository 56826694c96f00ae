#include "bench/oracles/walker_motion.h"
#include "content/load/gltf/gltf_load.h"
#include "content/load/gltf/gltf_write.h"
#include "content/load/motion/bvh_export.h"
#include "content/load/motion/curve_plot.h"
#include "content/load/motion/ghost_figure.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

namespace limn::ghost_figure_test {

using test::near;

namespace {

/// A stick that slides along x and slows down: x = 2 t - t^2.
SkeletonMotion make_brake() {
    SkeletonMotion motion;
    motion.skeleton.joints = {"base", "tip"};
    motion.skeleton.parents = {-1, 0};
    motion.skeleton.rest = {
        {Vec3(0), Vec3(0, 1, 0)}, {Quat(1, 0, 0, 0), Quat(1, 0, 0, 0)}, {Vec3(1), Vec3(1)}};
    ClipSheet sheet;
    sheet.translating = {0};
    for (int f = 0; f <= 40; ++f) {
        const float t = static_cast<float>(f) / 40;
        sheet.times.push_back(t);
        sheet.translations.emplace_back(2 * t - t * t, 0, 0);
    }
    motion.clip.name = "brake";
    motion.clip.duration = 1;
    motion.clip.sheets = {sheet};
    return motion;
}

GltfScene ghosts_of(const SkeletonMotion& motion, const GhostOptions& options) {
    Result<GltfScene> scene = make_ghost_scene("ghosts", motion, options);
    REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
    const Result<std::vector<std::byte>> bytes = write_glb(*scene);
    REQUIRE_MESSAGE(bytes.ok(), (bytes ? "" : bytes.error().message));
    const Result<GltfScene> read = parse_gltf(*bytes, "ghosts.glb", "");
    REQUIRE(read.ok());
    CHECK(read->warnings.empty());
    CHECK(read->meshes.size() == scene->meshes.size());
    return *std::move(scene);
}

/// Coordinates of a polyline of the plot.
std::vector<Vec2> points_of(const std::string& svg, std::size_t number) {
    std::size_t at = 0;
    for (std::size_t i = 0; i <= number; ++i) {
        at = svg.find("<polyline", at + 1);
        REQUIRE(at != std::string::npos);
    }
    at = svg.find("points=\"", at) + 8;
    std::vector<Vec2> points;
    const std::size_t end = svg.find('"', at);
    while (at < end) {
        char* next = nullptr;
        const float x = std::strtof(svg.c_str() + at, &next);
        const float y = std::strtof(next + 1, &next);
        points.emplace_back(x, y);
        at = static_cast<std::size_t>(next - svg.c_str()) + 1;
    }
    return points;
}

}  // namespace

TEST_CASE(
    "ghosts: there are floor(T / dt) + 1 at equal time steps" * technique("char.ghost-view")) {
    CHECK(ghost_times(1, {.step = 0.1f}).size() == 11);
    CHECK(ghost_times(1, {.step = 0.3f}).size() == 4);
    for (std::size_t n = 1; n < 100; ++n) {
        CHECK(ghost_times(0.01f * static_cast<float>(n), {.step = 0.01f}).size() == n + 1);
    }
    CHECK(ghost_times(0, {.step = 0.3f}) == std::vector<float>{0});
    CHECK(
        ghost_times(1, {.begin = 0.25f, .end = 0.75f, .step = 0.25f})
        == std::vector<float>{0.25f, 0.5f, 0.75f});
    CHECK(ghost_times(1, {.begin = 5, .step = 0.25f}).size() == 1);
}

TEST_CASE(
    "ghosts: those of a joint that slows down draw nearer, the later are less faint"
    * technique("char.ghost-view")) {
    const GltfScene scene = ghosts_of(make_brake(), {.step = 0.2f});
    REQUIRE(scene.meshes.size() == 6);
    float previous = 1;
    for (std::size_t k = 1; k < 6; ++k) {
        const float way = center(scene.meshes[k].bounds).x - center(scene.meshes[k - 1].bounds).x;
        CHECK(way < previous);
        const float t = 0.2f * static_cast<float>(k);
        CHECK(way == near(static_cast<double>(0.2f * (2 - 2 * t + 0.2f))).scale(1));
        previous = way;
        CHECK(scene.materials[k].base_color.w > scene.materials[k - 1].base_color.w);
    }
    CHECK(scene.materials[5].base_color.w == 1);
    CHECK(scene.materials[5].alpha_mode == AlphaMode::Opaque);
    CHECK(scene.materials[0].alpha_mode == AlphaMode::Blend);
}

TEST_CASE(
    "ghosts: a trail follows the joint, the highlight is in all ghosts"
    * technique("char.ghost-view")) {
    const oracle::RecordedWalk walk = oracle::make_walk(oracle::make_walker());
    const GltfScene scene =
        ghosts_of(walk.motion, {.step = 0.5f, .trails = {"LeftFoot"}, .highlight = "LeftLeg"});
    std::size_t highlights = 0;
    for (const Material& material : scene.materials) {
        highlights += material.name == "highlight" ? 1 : 0;
    }
    CHECK(highlights == 7);
    CHECK(scene.materials.back().name == "trail of LeftFoot");
    const Bounds trail = scene.meshes.back().bounds;
    const MotionFrames frames = sample_frames(walk.motion, 60);
    Bounds path;
    for (const Vec3& p : joint_path(
             walk.motion.skeleton, frames,
             find_body_joints(walk.motion.skeleton)[BodyPart::LeftFoot])) {
        grow(path, p);
    }
    CHECK(glm::distance(trail.min, path.min) < 0.02f);
    CHECK(glm::distance(trail.max, path.max) < 0.02f);
    const auto unknown = make_ghost_scene("a", walk.motion, {.trails = {"LeftFot"}});
    REQUIRE(!unknown.ok());
    CHECK(unknown.error().message == "found no joint \"LeftFot\" (did you mean LeftFoot?)");
    CHECK(!make_ghost_scene("a", walk.motion, {.step = 1e-4f}).ok());
}

TEST_CASE(
    "curves: the plot passes through all samples of the channels" * technique("char.ghost-view")) {
    const oracle::RecordedWalk walk = oracle::make_walk(oracle::make_walker(), 1);
    const BvhFile bvh = make_bvh_file(walk.motion, 60);
    const auto curves = *find_channel_curves(bvh, "LeftUpLeg");
    REQUIRE(curves.size() == 3);
    CHECK(curves[1].name == "Xrotation");
    const std::string svg = plot_curves("LeftUpLeg <1>", curves, bvh.frame_time);
    CHECK(svg.find("LeftUpLeg &lt;1>") != std::string::npos);
    const std::vector<Vec2> points = points_of(svg, 1);
    REQUIRE(points.size() == 61);
    // One linear map from times and degrees to pixels.
    const Vec2 first = points[0];
    const float per_frame = points[1].x - first.x;
    std::size_t other = 1;
    while (std::abs(curves[1].values[other] - curves[1].values[0]) < 5) {
        ++other;
    }
    const float per_degree =
        (points[other].y - first.y) / (curves[1].values[other] - curves[1].values[0]);
    CHECK(per_degree < 0);
    for (std::size_t f = 0; f < points.size(); ++f) {
        CHECK(std::abs(points[f].x - first.x - per_frame * static_cast<float>(f)) < 0.1f);
        CHECK(
            std::abs(
                points[f].y - first.y - per_degree * (curves[1].values[f] - curves[1].values[0]))
            < 0.01f);
    }
    CHECK(
        find_channel_curves(bvh, "LeftUpLg").error().message
        == "found no joint \"LeftUpLg\" (did you mean LeftUpLeg?)");
}

}  // namespace limn::ghost_figure_test
