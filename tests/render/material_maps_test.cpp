#include "render/material/image_pool.h"
#include "render/material/material_maps.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace limn::test::material_maps_test {
namespace {

/// Layer of a slot, as the shaders read it.
std::uint32_t layer_of(std::span<const Vec4> maps, std::uint32_t slot) {
    const Vec4& texel = maps[slot / layout::kLayersPerTexel];
    const auto layers = static_cast<std::uint32_t>(
        texel[static_cast<int>(slot % layout::kLayersPerTexel / layout::kLayersPerFloat)]);
    return layers >> layout::kLayerBits * (slot % layout::kLayersPerFloat)
           & ((1u << layout::kLayerBits) - 1);
}

ImageData plain(const std::array<std::uint8_t, 3>& color, int size = 2, bool srgb = false) {
    ImageData image = {.name = "plain", .width = size, .height = size, .srgb = srgb, .pixels = {}};
    for (int i = 0; i < size * size; ++i) {
        image.pixels.insert(image.pixels.end(), {color[0], color[1], color[2], 255});
    }
    return image;
}

}  // namespace

TEST_CASE("material maps: all maps in three arrays need three texture units") {
    MapBindings bindings;
    MapUnits units;
    Vec4 layers[layout::kMapTexels] = {};
    for (std::uint32_t slot = 0; slot < layout::kMaxMapSlots; ++slot) {
        const auto unit = bindings.add({.array = 1 + slot % 3, .sampler = 7});
        REQUIRE(unit);
        units.set(slot, *unit);
        set_layer(layers, slot, 255 - 10 * slot);
    }
    CHECK(bindings.used().size() == 3);
    for (std::uint32_t slot = 0; slot < layout::kMaxMapSlots; ++slot) {
        CAPTURE(slot);
        CHECK(units.has(slot));
        CHECK(bindings.used()[units.unit(slot)].array == 1 + slot % 3);
        CHECK(layer_of(layers, slot) == 255 - 10 * slot);
        MapUnits only;
        only.add(units, 1u << slot);
        CHECK(only.unit(slot) == units.unit(slot));
        CHECK_FALSE(only.has_any(~(1u << slot)));
        only.remove_all(~(1u << slot));
        CHECK(only.has(slot));
        only.remove_all(1u << slot);
        CHECK(only == MapUnits{});
    }
    units.remove(4);
    CHECK(!units.has(4));
    CHECK(units.unit(5) == 2);
}

TEST_CASE("material maps: a unit is one array, one sampler and one decoding") {
    MapBindings bindings;
    CHECK(bindings.add({.array = 1}) == 0u);
    CHECK(bindings.add({.array = 1, .sampler = 1}) == 1u);
    CHECK(bindings.add({.array = 1, .encoded = true}) == 2u);
    CHECK(bindings.add({.array = 1}) == 0u);
    CHECK(bindings.add({.array = 2}) == 3u);
    CHECK(bindings.add({.array = 3}) == 4u);
    CHECK(!bindings.add({.array = 4}));
    CHECK(bindings.add({.array = 2}) == 3u);
    CHECK(bindings.used().size() == layout::kMapUnits);
}

TEST_CASE_FIXTURE(RenderTest, "image pool: images of one size and format share an array") {
    ImagePool pool(device());
    std::vector<ImageData> images = {
        plain({1, 2, 3}), plain({4, 5, 6}, 4), plain({7, 8, 9}), plain({1, 1, 1}, 2, true)};
    images.push_back({.name = "broken", .width = 2, .height = 2, .pixels = {}});
    pool.update(images);
    CHECK(pool.find({0}).array == pool.find({2}).array);
    CHECK(pool.find({0}).layer == 0);
    CHECK(pool.find({2}).layer == 1);
    CHECK(pool.array(pool.find({0}).array).layers() == 2);
    CHECK(pool.find({1}).array != pool.find({0}).array);
    CHECK(pool.find({3}).array != pool.find({0}).array);
    CHECK(pool.find({4}).array == 0);
    CHECK(pool.find({77}).array == 0);
    CHECK(pool.find_texture({4}) == nullptr);

    // Later images have arrays of their own; those that are there do not move.
    const ImageLayer before = pool.find({2});
    images.push_back(plain({10, 11, 12}));
    pool.update(images);
    CHECK(pool.size() == images.size());
    CHECK(pool.find({2}).array == before.array);
    CHECK(pool.find({5}).array != before.array);
    for (const std::uint32_t i : {0u, 2u, 5u}) {
        const gpu::FloatImage texels = gpu::read_floats(*pool.find_texture({i}));
        CHECK(texels.pixels[0] == test::near(images[i].pixels[0] / 255.0f).epsilon(1e-4));
        CHECK(texels.width == 2);
    }
}

TEST_CASE_FIXTURE(RenderTest, "image pool: an array has as many layers as a record can number") {
    ImagePool pool(device());
    const std::vector<ImageData> images((1u << layout::kLayerBits) + 3, plain({1, 2, 3}, 1));
    pool.update(images);
    const auto last = static_cast<std::uint32_t>(images.size() - 1);
    CHECK(pool.find({0}).array == 1);
    CHECK(pool.array(1).layers() == 1 << layout::kLayerBits);
    CHECK(pool.find({last}).array == 2);
    CHECK(pool.find({last}).layer == 2);
}

TEST_CASE_FIXTURE(
    Scene, "material maps: materials that differ only in their images are drawn together") {
    const std::array<std::array<std::uint8_t, 3>, 3> colors = {
        {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}}};
    const MeshId square = add(make_square());
    std::array<MaterialId, 3> materials;
    for (std::size_t i = 0; i < colors.size(); ++i) {
        Material material = {.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}};
        material.base_color_texture.image = add(plain(colors[i]));
        materials[i] = add(material);
        place(square, materials[i], at({2.5f * static_cast<float>(i) - 2.5f, 0, 0}));
    }
    const RenderView view = look({0, 0, 4}, {0, 0, 0}, 192, 64);
    const gpu::FloatImage seen = radiance(view);
    for (std::size_t i = 0; i < colors.size(); ++i) {
        const Vec3 color = rgb_at(seen, 96 + (static_cast<int>(i) - 1) * 20, 32);
        CAPTURE(i);
        for (int c = 0; c < 3; ++c) {
            CHECK(color[c] == test::near(colors[i][static_cast<std::size_t>(c)] / 255.0f));
        }
    }
    CHECK(draw(view).statistics.draws == 1);
    auto& assets = world.resource<Assets>();
    // An image of another size is another array.
    assets.materials[materials[1].index].base_color_texture.image = add(plain(colors[1], 4));
    ++assets.material_version;
    CHECK(draw(view).statistics.draws == 2);
}

}  // namespace limn::test::material_maps_test
