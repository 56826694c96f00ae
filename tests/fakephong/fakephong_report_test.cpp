#include "bench/fakephong/fakephong_report.h"
#include "bench/fakephong/phong_models.h"
#include "tests/near.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace limn::fakephong {
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

TEST_CASE("fakephong: the fitted triangle has the printed figures within 0.01, in their order") {
    const SceneResult result = evaluate_scene(printed_triangle_scene());
    CHECK(distance_from_printed(result, printed_table()[1]) < 0.01);
    CHECK(
        rank_by_correctness(result)
        == Ids{
            "quadratic-blinn", "quadratic", "gouraud-subdivided", "blinn-map", "gouraud",
            "envmap"});
}

TEST_CASE("fakephong: the canonical triangle has its derived figures, in the printed order") {
    constexpr double kDerived[] = {0.7726, 0.8754, 0.8782, 0.5548, 0.8177, 0.9149};
    const SceneResult result = evaluate_scene(triangle_scene());
    for (std::size_t i = 0; i < kTableColumns; ++i) {
        CHECK(std::abs(result.methods[i].correctness - kDerived[i]) < 0.001);
    }
    CHECK(distance_from_printed(result, printed_table()[1]) < 0.028);
}

TEST_CASE("fakephong: the fitted teapot has the printed order, which fine textures do not give") {
    PhongScene scene = printed_teapot_scene();
    CHECK(distance_from_printed(evaluate_scene(scene), printed_table()[0]) < 0.0035);
    scene.texture_size = 256;
    CHECK(rank_by_correctness(evaluate_scene(scene))[0] == "quadratic-blinn");
}

TEST_CASE("fakephong: methods of samples are exact there, and the environment map nowhere") {
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

TEST_CASE("fakephong: the environment map costs least on coarse and fine meshes alike") {
    for (const PhongScene& scene : {sphere_scene(), triangle_scene()}) {
        const Ids ranked = rank_by_work(evaluate_scene(scene));
        CHECK(ranked[0] == "envmap");
        CHECK(ranked[1] == "blinn-map");
    }
    CHECK(weighted_operations({.additions = 1, .multiplications = 2, .fetches = 1}) == 7);
}

TEST_CASE("fakephong: chords and quadratics miss an arc by the derived distances") {
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

}  // namespace limn::fakephong
