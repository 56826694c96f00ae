#include "ecs/components/ink.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace limn::test::hatching_test {
namespace {

/// A square of paper, lit head on, that black ink hatches.
struct HatchedScene : Scene {
    MaterialId paper = add(
        Material{.shading = ShadingModel::Toon, .base_color = {1, 1, 1, 1}, .specular = {0, 0, 0}});
    Entity sun = shine(DirectionalLight{.illuminance = kPi}, look_at({0, 0, 1}, {0, 0, 0}));

    HatchedScene() {
        place(add(make_square()), paper, at({0, 0, 0}));
        world.insert_resource(Hatching{.color = {0, 0, 0}});
    }
    gpu::FloatImage lit(float light, const RenderView& view) {
        world.get<DirectionalLight>(sun).illuminance = light * kPi;
        return radiance(view);
    }
    [[nodiscard]] RenderView view(float distance, int size = 180) const {
        return look({0, 0, distance}, {0, 0, 0}, size, size);
    }
    /// Fraction of the central half that ink covers.
    static float ink_of(const gpu::FloatImage& image) {
        float sum = 0;
        int count = 0;
        for (int y = image.height / 4; y < 3 * image.height / 4; ++y) {
            for (int x = image.width / 4; x < 3 * image.width / 4; ++x) {
                sum += 1 - image.at(x, y, 0);
                ++count;
            }
        }
        return sum / static_cast<float>(count);
    }
};

}  // namespace

TEST_CASE_FIXTURE(
    HatchedScene, "hatching: white has no strokes, black is nearly all ink, and tones between grow"
                      * technique("tex.hatching")) {
    CHECK(ink_of(lit(1, view(1))) <= 1e-3f);
    CHECK(ink_of(lit(0, view(1))) >= 0.5f);
    float last = 0;
    for (const float light : {0.9f, 0.7f, 0.5f, 0.35f, 0.2f, 0.1f, 0.05f, 0.0f}) {
        const float ink = ink_of(lit(light, view(1)));
        CHECK(ink >= last);
        last = ink;
    }
}

TEST_CASE_FIXTURE(
    HatchedScene, "hatching: strokes of a lighter tone are among those of a darker one"
                      * technique("tex.hatching")) {
    gpu::FloatImage lighter = lit(0.95f, view(1));
    for (const float light : {0.6f, 0.4f, 0.25f, 0.1f, 0.02f}) {
        const gpu::FloatImage darker = lit(light, view(1));
        int erased = 0;
        for (std::size_t i = 0; i < darker.pixels.size(); ++i) {
            erased += darker.pixels[i] > lighter.pixels[i] + 1e-3f ? 1 : 0;
        }
        CHECK(erased == 0);
        lighter = darker;
    }
}

TEST_CASE_FIXTURE(
    HatchedScene,
    "hatching: a tone has as much ink from near and from far" * technique("tex.hatching")) {
    std::vector<float> inks;
    for (const float distance : {0.3f, 0.5f, 0.8f, 1.3f}) {
        inks.push_back(ink_of(lit(0.12f, view(distance, 360))));
    }
    const auto [least, most] = std::minmax_element(inks.begin(), inks.end());
    CHECK(*least > 0.05f);
    CHECK(*most < 1.6f * *least);
}

TEST_CASE_FIXTURE(
    HatchedScene,
    "hatching: nothing pops while the camera comes closer" * technique("tex.hatching")) {
    // Twice as near: one level of strokes gives way to the next. The image about the center moves
    // by less than a tenth of a pixel a step.
    constexpr int kSteps = 240;
    gpu::FloatImage last;
    float largest = 0;
    for (int i = 0; i <= kSteps; ++i) {
        const float distance = std::exp2(-static_cast<float>(i) / kSteps);
        gpu::FloatImage image = lit(0.2f, view(distance, 90));
        if (i > 0) {
            float change = 0;
            for (int y = 40; y < 50; ++y) {
                for (int x = 40; x < 50; ++x) {
                    change += std::abs(image.at(x, y, 0) - last.at(x, y, 0));
                }
            }
            largest = std::max(largest, change / 100);
        }
        last = std::move(image);
    }
    CHECK(largest < 0.008f);
}

TEST_CASE_FIXTURE(
    HatchedScene, "hatching: paper keeps its color, with a wash of the shading if wanted"
                      * technique("tex.hatching")) {
    auto& assets = world.resource<Assets>();
    assets.materials[paper.index].base_color = {0.8f, 0.4f, 0.2f, 1};
    ++assets.material_version;
    world.insert_resource(Hatching{.color = {0, 0, 0}, .white = 2});
    const gpu::FloatImage plain = lit(2, view(1));
    CHECK(plain.at(90, 90, 0) == near(1.6f).epsilon(2e-3));
    CHECK(plain.at(90, 90, 2) == near(0.4f).epsilon(4e-3));
    world.remove_resource<Hatching>();
    const gpu::FloatImage shaded = lit(0.3f, view(1));
    world.insert_resource(Hatching{.opacity = 1e-6f, .white = 1, .wash = 1});
    CHECK(largest_difference(lit(0.3f, view(1)), shaded) <= 1e-3f);
}

TEST_CASE_FIXTURE(
    HatchedScene, "hatching: other shading models have none" * technique("tex.hatching")) {
    auto& assets = world.resource<Assets>();
    assets.materials[paper.index].shading = ShadingModel::Blinn;
    ++assets.material_version;
    const gpu::FloatImage with = lit(0.2f, view(1));
    world.remove_resource<Hatching>();
    CHECK(largest_difference(with, lit(0.2f, view(1))) == 0);
}

}  // namespace limn::test::hatching_test
