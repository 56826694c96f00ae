#include "content/bake/skin_cells.h"
#include "ecs/base/rng.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn::skin_cells_test {
namespace {

constexpr SkinCells kOne = {.cells = 9, .levels = 1, .seed = 3};

/// Distance on the torus, in units of the image.
float distance_between(const Vec2& a, const Vec2& b) {
    const Vec2 d = a - b;
    return glm::length(d - glm::round(d));
}

/// Distances to the nearest and the second nearest of all sites.
Vec2 two_distances(const Vec2& uv, const SkinCells& cells) {
    std::vector<float> distances;
    for (int y = 0; y < cells.cells; ++y) {
        for (int x = 0; x < cells.cells; ++x) {
            distances.push_back(distance_between(uv, skin_cell_site({x, y}, cells)));
        }
    }
    std::sort(distances.begin(), distances.end());
    return {distances[0], distances[1]};
}

}  // namespace

TEST_CASE(
    "skin cells: they are 0 on the edges, 1 at the sites and fill the image"
    * technique("wrinkle.furrow.polygon-models")) {
    for (int y = 0; y < 9; ++y) {
        for (int x = 0; x < 9; ++x) {
            CHECK(
                skin_cell_height(skin_cell_site({x, y}, kOne), kOne)
                == test::near(1).epsilon(1e-4));
        }
    }
    Random random(1, 0, 0, 0);
    double least = 1;
    for (int i = 0; i < 4000; ++i) {
        const Vec2 uv(random.uniform(), random.uniform());
        const Vec2 d = two_distances(uv, kOne);
        const float height = skin_cell_height(uv, kOne);
        CHECK(height == test::near(1.0f - d.x / d.y).epsilon(1e-3).scale(1));
        least = std::min(least, static_cast<double>(height));
    }
    CHECK(least < 0.01);
}

TEST_CASE(
    "skin cells: finer levels are within the coarser one, and half as deep"
    * technique("wrinkle.furrow.polygon-models")) {
    const SkinCells two = {.cells = 9, .levels = 2, .seed = 3};
    double lower = 0;
    Random random(2, 0, 0, 0);
    for (int i = 0; i < 4000; ++i) {
        const Vec2 uv(random.uniform(), random.uniform());
        const float one = skin_cell_height(uv, kOne);
        const float both = skin_cell_height(uv, two);
        CHECK(both <= one);
        CHECK(both >= std::min(one, 0.5f));
        lower += both < one ? 1 : 0;
    }
    CHECK(lower > 500);
}

TEST_CASE("skin cells: the image tiles" * technique("wrinkle.furrow.polygon-models")) {
    for (float v = 0; v < 1; v += 0.01f) {
        CHECK(
            skin_cell_height({0.0f, v}, kOne)
            == test::near(skin_cell_height({0.99999f, v}, kOne)).epsilon(1e-2).scale(1));
    }
    CHECK(make_skin_cells(16, kOne).size() == 256);
    CHECK(
        make_skin_cells(16, kOne)[16 * 3 + 5] == skin_cell_height(Vec2(5.5f, 3.5f) / 16.0f, kOne));
}

}  // namespace limn::skin_cells_test
