#include "ecs/components/texture_combine.h"
#include "ecs/components/texture_layers.h"
#include "ecs/components/time.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace limn::test::texture_layers_test {
namespace {

constexpr int kSide = 16;

template <typename Texel>
ImageData painted(Texel&& texel) {
    ImageData image{
        .name = "painted",
        .width = kSide,
        .height = kSide,
        .format = PixelFormat::Rgba32F,
        .pixels = {}};
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const Vec4 color = texel(x, y);
            const auto* bytes = reinterpret_cast<const std::uint8_t*>(&color);
            image.pixels.insert(image.pixels.end(), bytes, bytes + sizeof color);
        }
    }
    return image;
}

Vec4 first_color(int x, int y) {
    return {0.05f * static_cast<float>(x), 0.9f - 0.05f * static_cast<float>(y), 0.3f, 1};
}

Vec4 second_color(int x, int y) {
    return {0.6f, 0.2f, (x + y) % 2 == 0 ? 0.8f : 0.1f, x < 5 ? 0.0f : x < 10 ? 0.5f : 1.0f};
}

/// A square that fills the image with the stack, one texel per pixel.
struct LayerScene : Scene {
    ImageId first = add(painted(first_color));
    ImageId second = add(painted(second_color));
    ImageId black = add(painted([](int, int) { return Vec4(0, 0, 0, 1); }));
    ImageId white = add(painted([](int, int) { return Vec4(1); }));
    ImageId clear = add(painted([](int, int) { return Vec4(1, 0, 1, 0); }));
    ImageId target = add(painted([](int, int) { return Vec4(0.5f); }));
    Entity entity = world.create();

    LayerScene() {
        Material material = {.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}};
        material.base_color_texture.image = target;
        material.base_color_texture.nearest = true;
        place(add(make_square()), add(material), at({0, 0, 0}));
    }
    gpu::FloatImage drawn(double time = 0) {
        world.insert_resource(FrameTime{.step = 1.0f / 60, .time = time});
        return radiance(look({0, 0, 1}, {0, 0, 0}, kSide, kSide));
    }
    gpu::FloatImage stacked(std::vector<TextureLayer> layers, double time = 0) {
        if (world.has<TextureLayers>(entity)) {
            world.remove<TextureLayers>(entity);
        }
        world.add(entity, TextureLayers{target, std::move(layers)});
        return drawn(time);
    }
    [[nodiscard]] TextureLayer layer(ImageId image, LayerBlend blend) const {
        return {.image = image, .blend = blend};
    }
};

}  // namespace

TEST_CASE_FIXTURE(
    LayerScene, "texture layers: adding black, multiplying by white and alpha 0 change nothing"
                    * technique("tex.layer-stack")) {
    const TextureLayer base = layer(first, LayerBlend::Replace);
    const gpu::FloatImage plain = stacked({base});
    CHECK(plain.at(4, 2, 0) == near(0.2f).epsilon(4e-3));
    CHECK(plain.at(4, 2, 1) == near(0.8f).epsilon(4e-3));
    CHECK(
        largest_difference(
            plain, stacked(
                       {base, layer(black, LayerBlend::Add), layer(white, LayerBlend::Multiply),
                        layer(clear, LayerBlend::Alpha)}))
        <= 1e-3f);
    CHECK(largest_difference(plain, stacked({base, layer(white, LayerBlend::Add)})) > 0.5f);
}

TEST_CASE_FIXTURE(
    LayerScene,
    "texture layers: each blend is its formula, layer over layer" * technique("tex.layer-stack")) {
    TextureLayer half = layer(second, LayerBlend::Add);
    half.factor = {0.5f, 0.25f, 1};
    TextureLayer map = layer(white, LayerBlend::Map);
    map.map = first;
    const gpu::FloatImage image = stacked(
        {layer(first, LayerBlend::Replace), half, layer(second, LayerBlend::Alpha),
         layer(second, LayerBlend::Multiply), half, map});
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const Vec4 a = first_color(x, y);
            const Vec4 b = second_color(x, y);
            for (int c = 0; c < 3; ++c) {
                float value = a[c] + half.factor[c] * b[c];
                value += b.w * (b[c] - value);
                value = value * b[c] + half.factor[c] * b[c];
                value += a.x * (1 - value);
                CHECK(image.at(x, y, c) == near(value).scale(1).epsilon(2e-3));
            }
        }
    }
}

TEST_CASE_FIXTURE(
    LayerScene,
    "texture layers: water under a grating is three layers" * technique("tex.layer-stack")) {
    // The same as the program that combines them at once.
    TextureLayer along_u = layer(first, LayerBlend::Replace);
    along_u.factor = Vec3(0.5f);
    TextureLayer along_v = layer(first, LayerBlend::Add);
    along_v.factor = Vec3(0.5f);
    along_u.scroll = {1.0f / 8, 0};
    along_v.scroll = {0, 1.0f / 16};
    TextureLayer grating = layer(second, LayerBlend::Alpha);
    grating.inverted = true;
    for (const double time : {0.0, 1.0, 3.3}) {
        const gpu::FloatImage layered = stacked({along_u, along_v, grating}, time);
        world.remove<TextureLayers>(entity);
        world.add(
            entity, TextureCombine{
                        .water = first,
                        .grating = second,
                        .target = target,
                        .speed = {1.0f / 8, 1.0f / 16},
                        .gain = 0.5f});
        CHECK(largest_difference(layered, drawn(time)) <= 2e-3f);
        world.remove<TextureCombine>(entity);
    }
}

TEST_CASE_FIXTURE(
    LayerScene,
    "texture layers: a layer scales, scrolls and spins" * technique("tex.layer-stack")) {
    TextureLayer moving = layer(first, LayerBlend::Replace);
    moving.scroll = {0.25f, 0};
    const gpu::FloatImage scrolled = stacked({moving}, 1);
    CHECK(scrolled.at(0, 3, 0) == near(first_color(4, 3).x).epsilon(4e-3));
    moving.scroll = {0, 0};
    moving.spin = 0.5f * kPi;
    const gpu::FloatImage turned = stacked({moving}, 1);
    const gpu::FloatImage still = stacked({moving}, 0);
    float largest = 0;
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const float a = turned.at(x, y, 0);
            const float b = still.at(y, kSide - 1 - x, 0);
            const float c = still.at(kSide - 1 - y, x, 0);
            largest = std::max(largest, std::min(std::abs(a - b), std::abs(a - c)));
        }
    }
    CHECK(largest <= 4e-3f);
    CHECK(largest_difference(turned, still) > 0.2f);
    CHECK(largest_difference(stacked({moving}, 4), still) <= 4e-3f);  // a whole turn
}

TEST_CASE_FIXTURE(
    LayerScene, "texture layers: layers without an image, or that show the target, are left out") {
    const TextureLayer base = layer(first, LayerBlend::Replace);
    const gpu::FloatImage plain = stacked({base});
    const gpu::FloatImage more = stacked(
        {base, layer({}, LayerBlend::Replace), layer(target, LayerBlend::Replace),
         layer(white, LayerBlend::Map)});
    CHECK(largest_difference(plain, more) == 0);
    const gpu::FloatImage none = stacked({});
    CHECK(none.at(3, 3, 0) == 0);
}

}  // namespace limn::test::texture_layers_test
