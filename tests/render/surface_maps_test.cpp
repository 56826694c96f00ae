#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

// Maps in place of the factors of a material: its color, and what controls its reflection.

namespace limn::test::surface_maps_test {
namespace {

/// An image of floats, row by row from the top.
ImageData float_image(int width, const std::vector<Vec4>& texels) {
    ImageData image{
        .name = "texels",
        .width = width,
        .height = static_cast<int>(texels.size()) / width,
        .format = PixelFormat::Rgba32F,
        .pixels = {}};
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(texels.data());
    image.pixels.assign(bytes, bytes + texels.size() * sizeof(Vec4));
    return image;
}

/// The square of side 2, which fills the image, lit from a side.
struct MapScene : Scene {
    MaterialId material = add(Material{});

    MapScene() {
        place(add(make_square()), material, at({0, 0, 0}));
        shine(PointLight{.intensity = 6, .radius = 0}, at({0.4f, 0.3f, 1.2f}));
    }
    gpu::FloatImage with(const Material& m, int size = 32) {
        auto& assets = world.resource<Assets>();
        assets.materials[material.index] = m;
        ++assets.material_version;
        return radiance(look({0, 0, 1}, {0, 0, 0}, size, size));
    }
    TextureSlot map_of(int width, const std::vector<Vec4>& texels) {
        return {.image = add(float_image(width, texels)), .nearest = true};
    }
};

}  // namespace

TEST_CASE_FIXTURE(
    MapScene, "color map: a texel of one color is that base color" * technique("tex.colour-map")) {
    const Vec4 color = {0.7f, 0.35f, 0.1f, 1};
    for (const ShadingModel model : {ShadingModel::Pbr, ShadingModel::Phong, ShadingModel::Toon}) {
        const Material plain = {.shading = model, .base_color = color};
        const Material mapped = {
            .shading = model, .base_color = {1, 1, 1, 1}, .base_color_texture = map_of(1, {color})};
        CHECK(largest_difference(with(plain), with(mapped)) <= 1e-3f);
    }
}

TEST_CASE_FIXTURE(
    MapScene, "color map: a scale of t repeats it t times" * technique("tex.colour-map")) {
    for (const int tiles : {1, 2, 5}) {
        Material striped = {.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}};
        striped.base_color_texture = map_of(2, {{0, 0, 0, 1}, {1, 1, 1, 1}});
        striped.base_color_texture.scale = {static_cast<float>(tiles), 1};
        const gpu::FloatImage image = with(striped, 80);
        int changes = 0;
        for (int x = 1; x < 80; ++x) {
            const bool before = image.at(x - 1, 40, 0) > 0.5f;
            changes += (image.at(x, 40, 0) > 0.5f) != before ? 1 : 0;
        }
        CHECK(changes == 2 * tiles - 1);
        CHECK(image.at(0, 40, 0) < 0.5f);
    }
}

TEST_CASE_FIXTURE(
    MapScene, "color map: at the centers of its texels, unfiltered, it is exact"
                  * technique("tex.colour-map")) {
    std::vector<Vec4> texels;
    for (int i = 0; i < 16; ++i) {
        texels.emplace_back(static_cast<float>(i) / 16, 1 - static_cast<float>(i) / 16, 0.5f, 1);
    }
    const Material mapped = {
        .shading = ShadingModel::Unlit,
        .base_color = {1, 1, 1, 1},
        .base_color_texture = map_of(4, texels)};
    const gpu::FloatImage image = with(mapped, 4);
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 4; ++x) {
            const Vec4 texel = texels[static_cast<std::size_t>(4 * y + x)];
            // Emission has a mantissa of nine bits.
            CHECK(image.at(x, y, 0) == near(texel.x).scale(1).epsilon(2e-3));
            CHECK(image.at(x, y, 1) == near(texel.y).scale(1).epsilon(2e-3));
        }
    }
}

TEST_CASE_FIXTURE(
    MapScene, "control map: a value in the map is that fraction of the parameter"
                  * technique("tex.control-map")) {
    for (const float value : {0.0f, 0.25f, 0.5f, 1.0f}) {
        CAPTURE(value);
        const Material uniform = {
            .base_color = {0.8f, 0.6f, 0.3f, 1},
            .metalness = 0.9f * value,
            .roughness = 0.8f * value};
        const Material mapped = {
            .base_color = {0.8f, 0.6f, 0.3f, 1},
            .metalness = 0.9f,
            .roughness = 0.8f,
            .metal_rough_texture = map_of(1, {{0, value, value, 1}})};
        CHECK(largest_difference(with(uniform), with(mapped)) <= 1e-3f);
    }
}

TEST_CASE_FIXTURE(
    MapScene, "control map: two halves of a map are two materials in one draw"
                  * technique("tex.control-map")) {
    const auto metal = [](float roughness) {
        return Material{
            .base_color = {0.8f, 0.6f, 0.3f, 1}, .metalness = 1, .roughness = roughness};
    };
    Material halves = metal(1);
    halves.metal_rough_texture = map_of(2, {{0, 0.3f, 1, 1}, {0, 0.9f, 1, 1}});
    const gpu::FloatImage smooth = with(metal(0.3f));
    const gpu::FloatImage rough = with(metal(0.9f));
    const gpu::FloatImage both = with(halves);
    const FrameOutput drawn = draw(look({0, 0, 1}, {0, 0, 0}, 32, 32));
    CHECK(drawn.statistics.draws == 1);
    CHECK(largest_difference(smooth, rough) > 0.05f);
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
            const gpu::FloatImage& half = x < 16 ? smooth : rough;
            CHECK(both.at(x, y, 0) == near(half.at(x, y, 0)).scale(1).epsilon(1e-3));
        }
    }
}

TEST_CASE_FIXTURE(
    MapScene,
    "control map: it is read as numbers, not as encoded colors" * technique("tex.control-map")) {
    ImageData bytes{.name = "bytes", .width = 1, .height = 1, .pixels = {0, 128, 0, 255}};
    Material mapped = {.roughness = 1};
    mapped.metal_rough_texture.image = add(bytes);
    const Material uniform = {.roughness = 128.0f / 255};
    CHECK(largest_difference(with(uniform), with(mapped)) <= 2e-3f);
}

}  // namespace limn::test::surface_maps_test
