#include "ecs/components/ink.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace limn::test::ink_lines_test {
namespace {

constexpr int kSize = 90;          // lines: 1/8 of those that widths refer to
constexpr float kOnePixel = 8.0f;  // the width of a line of one pixel

/// White surfaces that ink makes red.
struct InkScene : Scene {
    MeshId square = add(make_square());
    MaterialId white = add(
        Material{.shading = ShadingModel::Unlit, .double_sided = true, .base_color = {1, 1, 1, 1}});

    gpu::FloatImage with(const InkLines& ink, const RenderView& view) {
        world.insert_resource(ink);
        return radiance(view);
    }
    [[nodiscard]] RenderView view(int size = kSize) const {
        return look({0, 0, 2}, {0, 0, 0}, size, size);
    }
    static InkLines red(float width) { return {.width = width, .color = {1, 0, 0}}; }
    /// How much of a white surface is covered by red ink.
    static float ink_at(const gpu::FloatImage& image, int x, int y) {
        return image.at(x, y, 0) > 0.5f ? 1 - image.at(x, y, 1) : 0.0f;
    }
    static float sum_of(const gpu::FloatImage& image) {
        float sum = 0;
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) {
                sum += ink_at(image, x, y);
            }
        }
        return sum;
    }
};

}  // namespace

TEST_CASE_FIXTURE(
    InkScene, "ink lines: a step in depth has a line of the wanted width, and nothing else has"
                  * technique("tex.ink-lines")) {
    place(square, white, affine_from({0, 0, -1}, {1, 0, 0, 0}, Vec3(4)));
    place(square, white, affine_from({0, 0, 0}, {1, 0, 0, 0}, Vec3(0.5f)));
    for (const int size : {180, 360, 720}) {
        const float width = 4;
        const gpu::FloatImage image = with(red(width), view(size));
        const float pixels = width * static_cast<float>(size) / 720;
        float across = 0;
        for (int x = 0; x < size / 2; ++x) {
            across += ink_at(image, x, size / 2);
        }
        CAPTURE(size);
        CHECK(across == near(pixels).epsilon(2e-3));
        CHECK(ink_at(image, size / 2, size / 2) == 0);
        CHECK(ink_at(image, 2, size / 2) == 0);
    }
}

TEST_CASE_FIXTURE(
    InkScene, "ink lines: thinner than a pixel they are fainter, and without width or ink absent"
                  * technique("tex.ink-lines")) {
    place(square, white, affine_from({0, 0, -1}, {1, 0, 0, 0}, Vec3(4)));
    place(square, white, affine_from({0, 0, 0}, {1, 0, 0, 0}, Vec3(0.5f)));
    const gpu::FloatImage thin = with(red(4), view());  // half a pixel
    float darkest = 0;
    for (int x = 0; x < kSize / 2; ++x) {
        darkest = std::max(darkest, ink_at(thin, x, kSize / 2));
    }
    CHECK(darkest > 0.1f);
    CHECK(darkest <= 0.5f + 1e-3f);
    CHECK(sum_of(with(red(0), view())) == 0);
    CHECK_FALSE(frame_graph(shared_renderer()).was_run("ink lines"));
    InkLines clear = red(kOnePixel);
    clear.opacity = 0;
    CHECK(sum_of(with(clear, view())) == 0);
}

TEST_CASE_FIXTURE(
    InkScene, "ink lines: a floor seen at a grazing angle has none" * technique("tex.ink-lines")) {
    place(
        square, white,
        affine_from({0, -0.3f, 0}, glm::angleAxis(radians(-89.0f), Vec3(1, 0, 0)), Vec3(40)));
    const gpu::FloatImage image = with(red(kOnePixel), look({0, 0, 2}, {0, 0, -3}, kSize, kSize));
    float sum = 0;
    for (int y = 60; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            CHECK(image.at(x, y, 0) > 0.5f);
            sum += ink_at(image, x, y);
        }
    }
    CHECK(sum == 0);
}

TEST_CASE_FIXTURE(
    InkScene,
    "ink lines: a fold has one if it is sharper than the angle" * technique("tex.ink-lines")) {
    // A roof whose ridge runs up the image, 40 degrees between its sides.
    for (const float side : {-1.0f, 1.0f}) {
        const Quat turn = glm::angleAxis(side * radians(20.0f), Vec3(0, 1, 0));
        place(square, white, affine_from(turn * Vec3(side, 0, 0), turn, Vec3(1, 3, 1)));
    }
    InkLines ink = red(kOnePixel);
    ink.angle = radians(35.0f);
    CHECK(ink_at(with(ink, view()), kSize / 2, kSize / 2) > 0.4f);
    CHECK(ink_at(with(ink, view()), kSize / 4, kSize / 2) == 0);
    ink.angle = radians(45.0f);
    CHECK(ink_at(with(ink, view()), kSize / 2, kSize / 2) == 0);
    ink.angle = kPi;
    CHECK(ink_at(with(ink, view()), kSize / 2, kSize / 2) == 0);
}

TEST_CASE_FIXTURE(
    InkScene,
    "ink lines: between materials, if wanted, whatever shades them" * technique("tex.ink-lines")) {
    const MaterialId other = add(world.resource<Assets>().materials[white.index]);
    place(square, white, at({-1, 0, 0}));
    place(square, other, at({1, 0, 0}));
    InkLines ink = red(kOnePixel);
    CHECK(ink_at(with(ink, view()), kSize / 2, kSize / 2) > 0.4f);
    CHECK(ink_at(with(ink, view()), kSize / 4, kSize / 2) == 0);
    ink.materials = false;
    CHECK(ink_at(with(ink, view()), kSize / 2, kSize / 2) == 0);
}

}  // namespace limn::test::ink_lines_test
