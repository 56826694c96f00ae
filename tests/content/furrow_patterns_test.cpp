#include "content/bake/furrow_map.h"
#include "content/make/patterns/furrow_patterns.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>

namespace limn::furrow_patterns_test {
namespace {

Vec3 normal_at(const PatternMaps& maps, int x, int y) {
    const auto at = static_cast<std::size_t>(4 * (y * maps.normal.width + x));
    const auto& p = maps.normal.pixels;
    return Vec3(p[at], p[at + 1], p[at + 2]) / 127.5f - 1.0f;
}

/// Mean |x| and |y| of the normals: how much slope there is across the image and down it.
Vec2 mean_slopes(const PatternMaps& maps, int from, int to) {
    Vec2 sum(0);
    for (int y = 0; y < maps.normal.height; ++y) {
        for (int x = from; x < to; ++x) {
            sum += glm::abs(Vec2(normal_at(maps, x, y)));
        }
    }
    return sum / static_cast<float>((to - from) * maps.normal.height);
}

}  // namespace

TEST_CASE("furrows pattern: strong furrows of one field lie along its arrow") {
    FurrowsPattern pattern = {.recipe = {.size = 128, .tiles = true}};
    pattern.recipe.style.functions.angle = {0.1f, 0};
    pattern.recipe.arrows = {{.at = {0, 0, 0}, .first = {0, 1.2f, 0}, .second = {0, 0, 0}}};
    const Vec2 upright = mean_slopes(make_furrows(pattern), 0, 128);
    CHECK(upright.x > 3 * upright.y);
    pattern.recipe.arrows[0].first = {1.2f, 0, 0};
    const Vec2 level = mean_slopes(make_furrows(pattern), 0, 128);
    CHECK(level.y > 3 * level.x);
}

TEST_CASE(
    "furrows pattern: normals of a pad have its curvature, unless switched off"
    * technique("wrinkle.furrow.normal-base")) {
    FurrowsPattern pattern = {
        .recipe = {.projection = FurrowProjection::Planar, .size = 128},
        .surface = FurrowSurface::Pad};
    pattern.recipe.style.bump = 0;
    const PatternMaps curved = make_furrows(pattern);
    CHECK(normal_at(curved, 30, 64).x < -0.3f);
    CHECK(normal_at(curved, 98, 64).x > 0.3f);
    CHECK(normal_at(curved, 64, 30).y > 0.3f);
    CHECK(normal_at(curved, 64, 64).z > 0.99f);
    pattern.smooth_normals = false;
    CHECK(normal_at(make_furrows(pattern), 30, 64).z > 0.99f);
}

TEST_CASE(
    "furrows pattern: a cylinder keeps furrows even around a limb, a plane does not"
    * technique("wrinkle.furrow.map-cylinder")) {
    FurrowsPattern pattern = {
        .recipe = {.projection = FurrowProjection::Cylinder, .size = 256},
        .surface = FurrowSurface::Limb};
    pattern.recipe.style.functions.angle = {0.2f, 0};
    const PatternMaps cylinder = make_furrows(pattern);
    // s is 0 in front, a quarter turn at a quarter of the width.
    const float front = mean_slopes(cylinder, 0, 24).y;
    const float side = mean_slopes(cylinder, 52, 76).y;
    CHECK(side == test::near(front).epsilon(0.35));
    pattern.recipe.projection = FurrowProjection::Planar;
    const PatternMaps planar = make_furrows(pattern);
    CHECK(mean_slopes(planar, 60, 68).y < 0.6f * mean_slopes(planar, 0, 24).y);
}

TEST_CASE("furrows pattern: cells roughen the skin without a direction") {
    FurrowsPattern pattern = {.recipe = {.size = 128, .tiles = true}};
    pattern.recipe.style.functions.depth = 0;
    const Vec2 smooth = mean_slopes(make_furrows(pattern), 0, 128);
    CHECK(smooth.x < 0.005f);
    pattern.cells = 16;
    pattern.cell_depth = 0.6f;
    const Vec2 rough = mean_slopes(make_furrows(pattern), 0, 128);
    CHECK(rough.x > 0.02f);
    CHECK(rough.x == test::near(rough.y).epsilon(0.15));
}

}  // namespace limn::furrow_patterns_test
