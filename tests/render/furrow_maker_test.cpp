// Furrows grown on the GPU against those of content/bake.

#include "content/bake/furrow_recipe.h"
#include "content/bake/furrow_trace.h"
#include "content/make/patterns/furrow_patterns.h"
#include "ecs/base/repeatable_math.h"
#include "ecs/base/rng.h"
#include "ecs/components/surface.h"
#include "render/gpu/readback.h"
#include "render/material/furrow_maker.h"
#include "tests/content/furrow_shapes.h"
#include "tests/render/shader_eval.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <vector>

namespace limn::test::furrow_maker_test {
namespace {

/// Largest differences of the maps of the GPU from those of the CPU.
struct Difference {
    float height = 0;  ///< of both fields
    float noisy = 0;
    float normal = 0;
    int furrowed = 0;  ///< pixels
};

Difference compare_makers(gpu::Device& device, const FurrowMap& map, const FurrowStyle& style) {
    const auto maker = create_furrow_maker(device);
    REQUIRE_MESSAGE(maker.ok(), (maker ? "" : maker.error().message));
    const FurrowMaps expected = make_furrow_maps(map, style);
    const FurrowTextures made =
        make_furrow_textures(device, *maker, map, expected.growth.cover, style);
    const gpu::FloatImage heights = gpu::read_floats(made.height);
    const gpu::FloatImage normals = gpu::read_floats(made.normal);
    Difference most;
    for (int y = 0; y < map.size.y; ++y) {
        for (int x = 0; x < map.size.x; ++x) {
            const auto pixel = static_cast<std::size_t>(y * map.size.x + x);
            const int row = map.size.y - 1 - y;  // images are read with the first row at the top
            const float first = heights.at(x, row, 0);
            const float second = heights.at(x, row, 1);
            most.height = std::max(most.height, std::abs(first - expected.growth.first[pixel]));
            most.height = std::max(most.height, std::abs(second - expected.growth.second[pixel]));
            most.noisy =
                std::max(most.noisy, std::abs(heights.at(x, row, 2) - expected.height[pixel]));
            for (int c = 0; c < 3; ++c) {
                most.normal = std::max(
                    most.normal, std::abs(normals.at(x, row, c) - expected.normals[pixel][c]));
            }
            most.furrowed += first < 1 ? 1 : 0;
        }
    }
    return most;
}

Difference compare_makers(gpu::Device& device, FurrowSurface surface, const FurrowRecipe& recipe) {
    const auto map = lay_out_furrows(make_furrow_surface(surface), recipe);
    REQUIRE(map.ok());
    return compare_makers(device, *map, style_of(recipe));
}

}  // namespace

TEST_CASE_FIXTURE(
    RenderTest, "repeatable math: shaders give the same bits" * technique("wrinkle.furrow.trace")) {
    std::vector<Vec4> inputs;
    Random random(1, 2, 3, 4);
    for (int i = 0; i < 4096; ++i) {
        const float size = std::exp2(random.uniform(-40, 40));
        inputs.emplace_back(size, random.uniform(-1.2f, 1.2f), random.uniform() < 0.5f ? -1 : 1, 0);
    }
    const std::vector<Vec4> found = evaluate_shader(
        "#include \"lib/repeatable.glsl\"\n",
        "y = vec4(repeatable_reciprocal(x.x * x.z), repeatable_inverse_root(x.x),"
        " repeatable_cos_sin(x.y));",
        inputs);
    int different = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const Vec2 turn = repeatable_cos_sin(inputs[i].y);
        const Vec4 expected(
            repeatable_reciprocal(inputs[i].x * inputs[i].z), repeatable_inverse_root(inputs[i].x),
            turn);
        for (int c = 0; c < 4; ++c) {
            different += std::bit_cast<std::uint32_t>(expected[c])
                                 != std::bit_cast<std::uint32_t>(found[i][c])
                             ? 1
                             : 0;
        }
    }
    CHECK(different == 0);
}

TEST_CASE_FIXTURE(
    RenderTest, "furrow maker: the GPU grows the furrows of the CPU, bit for bit"
                    * technique("wrinkle.furrow.trace")) {
    FurrowRecipe recipe = {.size = 128, .tiles = true};
    recipe.arrows = {
        {.at = {-0.3f, 0.2f, 0}, .first = {0.3f, 0.9f, 0}, .second = {1.3f, -0.2f, 0}},
        {.at = {0.3f, -0.2f, 0}, .first = {-0.6f, 0.4f, 0}, .second = {0.4f, 0.5f, 0}}};
    recipe.style.noise = 0.3f;
    for (const float scale : {0.6f, 1.3f}) {
        recipe.style.scale = scale;
        const Difference most = compare_makers(device(), FurrowSurface::Square, recipe);
        CHECK(most.height == 0.0f);
        CHECK(most.noisy <= 1e-6f);
        CHECK(most.normal <= 1e-3f);
        CHECK(most.furrowed > 1000);
    }
}

TEST_CASE_FIXTURE(
    RenderTest, "furrow maker: it agrees on other projections and styles"
                    * technique("wrinkle.furrow.normal-perturb")) {
    FurrowRecipe planar = {.projection = FurrowProjection::Planar, .size = 100};
    planar.style.bump = 1;
    const Difference pad = compare_makers(device(), FurrowSurface::Pad, planar);
    CHECK(pad.height == 0.0f);
    CHECK(pad.normal <= 1e-3f);
    FurrowRecipe cylinder = {.projection = FurrowProjection::Cylinder, .size = 96};
    cylinder.style.literal_turn = true;
    cylinder.style.seed = 9;
    const Difference limb = compare_makers(device(), FurrowSurface::Limb, cylinder);
    CHECK(limb.height == 0.0f);
    CHECK(limb.normal <= 1e-3f);
}

TEST_CASE_FIXTURE(
    RenderTest, "furrow maker: it agrees where segments pass through corners of pixels"
                    * technique("wrinkle.furrow.trace")) {
    FurrowStyle style;
    style.functions.angle = {0, 0};
    const FurrowMap map = make_flat_furrow_map({90, 90}, {0.5f, 0.5f}, {-0.7f, 0.7f});
    CHECK(compare_makers(device(), map, style).height == 0.0f);
}

TEST_CASE_FIXTURE(
    RenderTest, "furrow maker: it agrees on long segments with wide bands"
                    * technique("wrinkle.furrow.trace")) {
    FurrowStyle style = {.scale = 2};
    style.functions.length = {30, 10};
    style.functions.density = {30, 0};
    const FurrowMap map = make_flat_furrow_map({1500, 1500}, {0.9f, 0.2f}, {0.3f, 0.9f});
    CHECK(compare_makers(device(), map, style).height == 0.0f);
}

TEST_CASE_FIXTURE(RenderTest, "furrow maker: images of a few pixels are grown as well") {
    for (const int size : {1, 3, 7}) {
        FurrowRecipe recipe = {.size = size, .tiles = true};
        recipe.style.scale = 2;
        const Difference most = compare_makers(device(), FurrowSurface::Square, recipe);
        CHECK(most.height == 0.0f);
        CHECK(most.normal <= 1e-3f);
    }
}

}  // namespace limn::test::furrow_maker_test
