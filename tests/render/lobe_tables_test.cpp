#include "ecs/components/rendering.h"
#include "render/light/lobe_tables.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace limn::test::lobe_tables_test {
namespace {

constexpr int kSize = 256;

/// As a GPU filters between texel centers.
double filtered(const std::vector<double>& values, double t) {
    const double x = t * static_cast<double>(values.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(x), values.size() - 2);
    const double part = x - static_cast<double>(i);
    return values[i] * (1 - part) + values[i + 1] * part;
}

/// Column `u` of the table, of diffuse light or of the highlight.
std::vector<double> column(const std::vector<Vec2>& table, int u, int channel) {
    std::vector<double> values;
    for (int j = 0; j < kSize; ++j) {
        values.push_back(double(table[static_cast<std::size_t>(j * kSize + u)][channel]));
    }
    return values;
}

/// Ball and floor of the model, by two lights.
struct LobeScene : Scene {
    gpu::FloatImage draw(ShadingModel shading, float shininess, const Rendering& rendering) {
        world.clear();
        world.insert_resource(rendering);
        shine(DirectionalLight{.illuminance = 3}, look_at({1, 2, 2}, {0, 0, 0}));
        shine(PointLight{.intensity = 2, .radius = 6}, at({-1, 0.5f, 1.2f}));
        Material material = {.shading = shading, .base_color = {0.7f, 0.5f, 0.3f, 1}};
        material.specular = {0.5f, 0.5f, 0.5f};
        material.shininess = shininess;
        place(add(make_ball(32)), add(material), at({0, 0, 0}));
        return radiance(look({0.6f, 0.4f, 1.9f}, {0, 0, 0}, 64, 64));
    }
};

}  // namespace

TEST_CASE(
    "lobe table: highlights are those of the power to within the error of linear filtering"
    * technique("shade.phong-lut")) {
    for (const double n : {5.0, 20.0, 50.0}) {
        const std::vector<double> highlight =
            column(bake_lobe_table(static_cast<float>(n), kSize), 128, 1);
        const double bound = n * (n - 1) / (8.0 * (kSize - 1) * (kSize - 1));
        double error = 0;
        for (int i = 0; i <= 10000; ++i) {
            const double v = i / 10000.0;
            error = std::max(error, std::abs(filtered(highlight, v) - std::pow(v, n)));
        }
        CAPTURE(n);
        CHECK(error <= bound + 1e-6);
        CHECK(error >= 0.5 * bound);  // the bound is that of this table, not a loose one
    }
}

TEST_CASE(
    "lobe table: nothing is lit from behind, all of it head on, and diffuse light is linear"
    * technique("shade.phong-lut")) {
    const std::vector<Vec2> table = bake_lobe_table(20, kSize);
    CHECK(table.front() == Vec2(0, 0));
    CHECK(table.back() == Vec2(1, 1));
    CHECK(table[kSize * (kSize - 1)] == Vec2(0, 0));  // u = 0, v = 1: no highlight
    for (int i = 0; i < kSize; ++i) {
        CHECK(table[static_cast<std::size_t>(i)].x == near(double(i) / (kSize - 1)));
    }
}

TEST_CASE("lobe factors: samples are those of the function" * technique("shade.factorise")) {
    const auto line = [](float x) { return 2 * x - 1; };
    const std::vector<float> factor = bake_factor(line, -1, 5);
    CHECK(factor == std::vector<float>{-3, -2, -1, 0, 1});
    // A separable function of two cosines is recovered at every pair of samples.
    for (std::size_t i = 0; i < 5; ++i) {
        for (std::size_t j = 0; j < 5; ++j) {
            const float u = -1 + 0.5f * static_cast<float>(i);
            const float v = -1 + 0.5f * static_cast<float>(j);
            CHECK(factor[i] * factor[j] == line(u) * line(v));
        }
    }
}

TEST_CASE("lobe tables: there is a layer per exponent, and never more than the most") {
    std::vector<Material> materials = {
        {.shading = ShadingModel::Blinn, .shininess = 30},
        {.shading = ShadingModel::Pbr, .shininess = 7},
        {.shading = ShadingModel::Strand, .shininess = 5},
        {.shading = ShadingModel::Phong, .shininess = 30}};
    const LobeExponents few = lobe_exponents(materials);
    CHECK(few.exponents == std::vector<float>{5, 30});
    CHECK(few.of_material == std::vector<std::uint32_t>{1, 0, 0, 1});
    for (int i = 0; i < 200; ++i) {
        materials.push_back(
            {.shading = ShadingModel::Blinn, .shininess = 40 + static_cast<float>(i)});
    }
    const LobeExponents many = lobe_exponents(materials);
    CHECK(many.exponents.size() == kMaxLobeExponents);
    for (std::size_t i = 0; i < materials.size(); ++i) {
        REQUIRE(many.of_material[i] < kMaxLobeExponents);
        if (i >= 4) {  // those that are a step apart
            const float exponent = many.exponents[many.of_material[i]];
            CHECK(exponent >= materials[i].shininess);
            CHECK(exponent <= materials[i].shininess + 5);
        }
    }
    CHECK(lobe_exponents({}).exponents.empty());
}

TEST_CASE_FIXTURE(
    LobeScene, "lobe tables: the image is that of the arithmetic, by every lighting method"
                   * technique("shade.phong-lut, shade.factorise")) {
    for (const ShadingModel model :
         {ShadingModel::Blinn, ShadingModel::Phong, ShadingModel::Skin, ShadingModel::Strand}) {
        const gpu::FloatImage computed = draw(model, 20, {});
        for (const LobeSource source : {LobeSource::Table, LobeSource::Factors}) {
            for (const LightMethod method : {LightMethod::Clustered, LightMethod::ObjectMajor}) {
                const gpu::FloatImage looked_up =
                    draw(model, 20, {.lights = method, .lobes = source});
                CAPTURE(static_cast<int>(model));
                CAPTURE(static_cast<int>(source));
                // Of strands the root of 1 - x^2 is filtered, too, which is steep at its ends.
                CHECK(
                    largest_difference(looked_up, computed)
                    <= (model == ShadingModel::Strand ? 0.02f : 2e-3f));
            }
        }
        // Another exponent is another layer.
        CHECK(largest_difference(draw(model, 5, {.lobes = LobeSource::Table}), computed) > 0.02f);
    }
}

}  // namespace limn::test::lobe_tables_test
