#include "bench/fakephong/fakephong_report.h"
#include "bench/fakephong/phong_models.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace limn::fakephong::fakephong_report_test {
namespace {

using test::near;
using Ids = std::vector<std::string>;

/// The largest distance from a printed row; the columns must be in its order.
double distance_from_printed(const SceneResult& result, const PrintedRow& row) {
    double largest = 0;
    for (std::size_t i = 0; i < kTableColumns; ++i) {
        const double value = result.methods[i].correctness;
        largest = std::max(largest, std::abs(value - row.correctness[i]));
        for (std::size_t j = 0; j < kTableColumns; ++j) {
            if (row.correctness[i] < row.correctness[j]) {
                CHECK(value < result.methods[j].correctness);
            }
        }
    }
    return largest;
}

}  // namespace

TEST_CASE(
    "fakephong: the fitted triangle has the printed figures within 0.01, in their order"
    * technique("fakephong.results")) {
    const SceneResult result = evaluate_scene(printed_triangle_scene());
    CHECK(distance_from_printed(result, printed_table()[1]) < 0.01);
    CHECK(
        rank_by_correctness(result)
        == Ids{
            "quadratic-blinn", "quadratic", "gouraud-subdivided", "blinn-map", "gouraud",
            "envmap"});
}

TEST_CASE(
    "fakephong: the canonical triangle has its derived figures, in the printed order"
    * technique("fakephong.results")) {
    constexpr double kDerived[] = {0.7726, 0.8754, 0.8782, 0.5548, 0.8177, 0.9149};
    const SceneResult result = evaluate_scene(triangle_scene());
    for (std::size_t i = 0; i < kTableColumns; ++i) {
        CHECK(std::abs(result.methods[i].correctness - kDerived[i]) < 0.001);
    }
    CHECK(distance_from_printed(result, printed_table()[1]) < 0.028);
}

TEST_CASE(
    "fakephong: the fitted teapot has the printed order, which fine textures do not give"
    * technique("fakephong.results")) {
    PhongScene scene = printed_teapot_scene();
    CHECK(distance_from_printed(evaluate_scene(scene), printed_table()[0]) < 0.0035);
    scene.texture_size = 256;
    CHECK(rank_by_correctness(evaluate_scene(scene))[0] == "quadratic-blinn");
}

TEST_CASE(
    "fakephong: methods with samples are exact at them, the environment map nowhere"
    * technique("fakephong.metric-analytic")) {
    const SceneResult result = evaluate_scene(sphere_scene());
    for (std::size_t i = 0; i < kTableColumns; ++i) {
        const MethodResult& one = result.methods[i];
        CAPTURE(std::string(one.method->id));
        if (one.method->exact_points == 0) {
            CHECK(one.error_at_samples > 0.01);
        } else {
            CHECK(one.error_at_samples < 1e-9);
        }
        CHECK(one.error_inside > 0.01);
    }
}

TEST_CASE(
    "fakephong: the environment map costs least on coarse and fine meshes alike"
    * technique("fakephong.metric-efficiency")) {
    for (const PhongScene& scene : {sphere_scene(), triangle_scene()}) {
        const Ids ranked = rank_by_work(evaluate_scene(scene));
        CHECK(ranked[0] == "envmap");
        CHECK(ranked[1] == "blinn-map");
    }
    CHECK(weighted_operations({.additions = 1, .multiplications = 2, .fetches = 1}) == 7);
}

// "About twice as slow as Gouraud" in the thesis (section 6.2), by its Java program.
TEST_CASE(
    "fakephong: quadratic shading takes about twice the work of Gouraud shading"
    * technique("fakephong.metric-efficiency, fakephong.quadratic")) {
    for (const PhongScene& scene : {teapot_scene(), sphere_scene(), triangle_scene()}) {
        CAPTURE(scene.name);
        const SceneResult result = evaluate_scene(scene);
        const auto work_of = [&](const char* id) {
            for (const MethodResult& one : result.methods) {
                if (one.method->id == std::string_view(id)) {
                    return weighted_operations(one.image);
                }
            }
            return 0.0;
        };
        const double ratio = work_of("quadratic") / work_of("gouraud");
        CHECK(ratio > 1.5);
        CHECK(ratio < 3);
    }
}

TEST_CASE(
    "fakephong: chords and quadratics miss an arc by the derived distances"
    * technique("fakephong.blinn-path")) {
    constexpr double kDegree = 3.141592653589793 / 180;
    const PathDeviation d30 = path_deviation(30 * kDegree);
    const PathDeviation d60 = path_deviation(60 * kDegree);
    const PathDeviation d90 = path_deviation(90 * kDegree);
    CHECK(d30.linear_sine == near(0.0090).epsilon(0.01));
    CHECK(d30.linear_cosine == near(0.0329).epsilon(0.01));
    CHECK(d30.quadratic_sine == near(0.0011).epsilon(0.05));
    CHECK(d30.quadratic_cosine == near(0.0003).epsilon(0.2));
    CHECK(d60.linear_sine == near(0.0684).epsilon(0.01));
    CHECK(d60.linear_cosine == near(0.1163).epsilon(0.01));
    CHECK(d60.quadratic_sine == near(0.0082).epsilon(0.02));
    CHECK(d60.quadratic_cosine == near(0.0051).epsilon(0.02));
    CHECK(d90.linear_sine == near(0.2105).epsilon(0.01));
    CHECK(d90.linear_cosine == near(0.2105).epsilon(0.01));
    CHECK(d90.quadratic_sine == near(0.0235).epsilon(0.02));
    CHECK(d90.quadratic_cosine == near(0.0235).epsilon(0.02));
    CHECK(d60.linear_cosine / d30.linear_cosine == near(3.5).epsilon(0.02));
    CHECK(d60.quadratic_sine / d30.quadratic_sine == near(7.3).epsilon(0.1));
    CHECK(path_deviation(1e-3).linear_cosine < 1e-6);
}

TEST_CASE(
    "fakephong: Blinn coordinates deviate from their chords as derived for the corners"
    * technique("fakephong.blinn-path")) {
    // Edges of the canonical triangle: the mean of two corners' coordinates against the midpoint's.
    const EdgePaths triangle = edge_paths(triangle_scene());
    CHECK(triangle.edges == 3);
    CHECK(triangle.turn == 0);
    const double side = std::hypot(0.27498 - 0.5 * (0.54681 - 0.14759), 0.29454 - 0.5 * 0.47458);
    CHECK(triangle.linear >= side - 1e-4);
    CHECK(triangle.linear < 1.1 * side);
    CHECK(triangle.quadratic < 0.8 * triangle.linear);  // the light is near: H turns along an edge
}

TEST_CASE(
    "fakephong: with constant normals and everything far away, coordinates are straight"
    * technique("fakephong.blinn-path")) {
    PhongScene far = triangle_scene();
    far.lights = {{.directional = true, .at = {0.3, 0.2, 1}}};
    far.camera.eye = {0, 0, 1e7};
    const EdgePaths paths = edge_paths(far);
    CHECK(paths.edges == 3);
    CHECK(paths.linear < 1e-6);
    CHECK(paths.from_h == near(0.5 * std::acos(1 / std::sqrt(1.13))).epsilon(1e-3));
}

TEST_CASE(
    "fakephong: with facets half as large, chords deviate a quarter as far, quadratics an eighth"
    * technique("fakephong.blinn-path")) {
    PhongScene scene = sphere_scene();
    scene.mesh = make_coarse_sphere(16, 16);
    const EdgePaths coarse = edge_paths(scene);
    scene.mesh = make_coarse_sphere(32, 32);
    const EdgePaths fine = edge_paths(scene);
    CHECK(coarse.turn == near(2 * fine.turn).epsilon(0.02));
    CHECK(coarse.linear_mean / fine.linear_mean == near(4).epsilon(0.1));
    CHECK(coarse.quadratic_mean / fine.quadratic_mean == near(8).epsilon(0.1));
    CHECK(fine.quadratic < fine.linear);
}

TEST_CASE("fakephong: a Phong map is compared by diffuse light, in which it is exact at corners") {
    const SceneResult result = evaluate_scene(sphere_scene());
    const auto map =
        std::find_if(result.methods.begin(), result.methods.end(), [](const MethodResult& one) {
            return one.method->diffuse_only;
        });
    REQUIRE(map != result.methods.end());
    CHECK(&reference_of(result, *map) == &result.phong_diffuse);
    CHECK(&reference_of(result, result.methods[0]) == &result.phong);
    CHECK(map->error_at_samples < 1e-9);
    CHECK(map->error_inside > 0.01);
    CHECK(map->correctness > 0.8);
    CHECK(map->correctness < 1);
}

TEST_CASE(
    "fakephong: stepped colors equal those evaluated at each pixel, and cost less on one facet") {
    for (const SteppedMethod& one : step_scene(triangle_scene())) {
        CAPTURE(std::string(one.method->id));
        CHECK(one.difference < 1e-6);
        CHECK(weighted_operations(one.stepped) < 0.6 * weighted_operations(one.direct));
        CHECK(one.correctness > 0.999);  // seen from far away
    }
    PhongScene near_eye = triangle_scene();
    near_eye.camera = {.eye = {0, 1.2, 1}, .target = {0, 0, 0}, .half_size = 1};
    CHECK(step_scene(near_eye)[1].correctness < 0.999);
}

TEST_CASE("fakephong: a row of the table is that of all methods") {
    const SceneResult result = evaluate_scene(dodecahedron_scene());
    const auto row = correctness_row(dodecahedron_scene());
    for (std::size_t i = 0; i < kTableColumns; ++i) {
        CHECK(row[i] == result.methods[i].correctness);
    }
    CHECK(correctness_row(result) == row);
    const std::array<double, kTableColumns> rising = {1, 2, 3, 4, 5, 6};
    CHECK(swapped_pairs(rising, rising) == 0);
    CHECK(swapped_pairs({6, 5, 4, 3, 2, 1}, rising) == 15);
    CHECK(swapped_pairs({1, 2, 2, 4, 5, 6}, rising) == 1);
}

}  // namespace limn::fakephong::fakephong_report_test
