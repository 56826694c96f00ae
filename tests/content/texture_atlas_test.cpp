// Texture atlases: where textures are in them, what their mip levels hold, and models whose
// materials become one.

#include "content/bake/scene_atlas.h"
#include "content/bake/texture_atlas.h"
#include "content/load/gltf/gltf_load.h"
#include "content/load/gltf/gltf_write.h"
#include "ecs/base/srgb.h"
#include "tests/near.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace limn::texture_atlas_test {
using test::near;

namespace {

/// Opaque noise about a color of its own.
ImageData noise(int width, int height, unsigned seed, bool srgb = false) {
    std::mt19937 random(seed);
    ImageData image;
    image.name = "noise" + std::to_string(seed);
    image.width = width;
    image.height = height;
    image.srgb = srgb;
    const std::uint_fast32_t center[3] = {random() % 200, random() % 200, random() % 200};
    for (int i = 0; i < width * height; ++i) {
        for (const std::uint_fast32_t c : center) {
            image.pixels.push_back(static_cast<std::uint8_t>(c + random() % 56));
        }
        image.pixels.push_back(255);
    }
    return image;
}

const std::uint8_t* texel(const ImageData& image, int x, int y) {
    return &image.pixels[4 * static_cast<std::size_t>(y * image.width + x)];
}

/// Bilinear, of level 0, in the bytes of the image.
Vec3 sampled(const ImageData& image, const Vec2& uv) {
    const Vec2 at = uv * Vec2(image.width, image.height) - 0.5f;
    const Vec2 low = glm::floor(at);
    Vec3 sum(0);
    for (int corner = 0; corner < 4; ++corner) {
        const Vec2 p = low + Vec2(corner % 2, corner / 2);
        const Vec2 w = 1.0f - glm::abs(at - p);
        const std::uint8_t* const t = texel(
            image, std::clamp(static_cast<int>(p.x), 0, image.width - 1),
            std::clamp(static_cast<int>(p.y), 0, image.height - 1));
        sum += w.x * w.y * Vec3(t[0], t[1], t[2]);
    }
    return sum;
}

std::vector<const ImageData*> pointers(const std::vector<ImageData>& images) {
    std::vector<const ImageData*> all;
    for (const ImageData& image : images) {
        all.push_back(&image);
    }
    return all;
}

/// Mip levels of one channel by means of 2 x 2 texels.
std::vector<double> level_of(const ImageData& image, int level, std::size_t channel) {
    std::vector<double> values;
    for (std::size_t i = channel; i < image.pixels.size(); i += 4) {
        values.push_back(image.pixels[i]);
    }
    auto width = static_cast<std::size_t>(image.width);
    auto height = static_cast<std::size_t>(image.height);
    for (int l = 0; l < level; ++l) {
        std::vector<double> next;
        for (std::size_t y = 0; y + 1 < height; y += 2) {
            for (std::size_t x = 0; x + 1 < width; x += 2) {
                const std::size_t at = y * width + x;
                next.push_back(
                    (values[at] + values[at + 1] + values[at + width] + values[at + width + 1])
                    / 4);
            }
        }
        values = std::move(next);
        width /= 2;
        height /= 2;
    }
    return values;
}

/// A square of side 1 in the plane of x and y, at x = `place`.
MeshData square(float place) {
    MeshData mesh;
    for (int i = 0; i < 4; ++i) {
        const Vec2 uv = {i % 2, i / 2};
        mesh.positions.emplace_back(place + uv.x, uv.y, 0);
        mesh.normals.emplace_back(0, 0, 1);
        mesh.uvs.push_back(uv);
    }
    mesh.indices = {0, 1, 2, 2, 1, 3};
    return mesh;
}

/// Squares with a material each, whose base colors are images of their own.
GltfScene tiles(std::size_t count) {
    GltfScene scene;
    scene.name = "tiles";
    for (std::uint32_t i = 0; i < count; ++i) {
        scene.images.push_back(noise(16, 16, i, true));
        scene.meshes.push_back(square(static_cast<float>(i)));
        scene.meshes.back().name = "square" + std::to_string(i);
        Material material;
        material.name = "tile" + std::to_string(i);
        material.base_color_texture.image = {i};
        scene.materials.push_back(material);
        GltfNode node;
        node.parts = {{i, i}};
        scene.nodes.push_back(node);
    }
    return scene;
}

}  // namespace

TEST_CASE(
    "texture atlas: sixteen cells of 256 end at level 8, with the mean of a texture in each texel"
    * technique("engine.texture-atlas")) {
    std::vector<ImageData> images;
    for (unsigned i = 0; i < 16; ++i) {
        images.push_back(noise(256, 256, i));
    }
    const AtlasLayout layout = lay_out_atlas(images.size(), 256, 8192, 0);
    CHECK(layout.columns == 4);
    CHECK(layout.rows == 4);
    CHECK(last_atlas_level(layout) == 8);
    const ImageData atlas = make_atlas(layout, pointers(images));
    REQUIRE(atlas.width == 1024);
    REQUIRE(atlas.height == 1024);
    for (std::size_t channel = 0; channel < 4; ++channel) {
        const std::vector<double> last = level_of(atlas, 8, channel);
        REQUIRE(last.size() == 16);
        for (std::size_t i = 0; i < 16; ++i) {
            double sum = 0;
            for (std::size_t k = channel; k < images[i].pixels.size(); k += 4) {
                sum += images[i].pixels[k];
            }
            CHECK(last[i] == near(sum / (256 * 256)).epsilon(1e-12));
        }
    }
}

TEST_CASE("texture atlas: the layout has room for all, and no side beyond the limit") {
    for (std::size_t count = 1; count < 40; ++count) {
        CAPTURE(count);
        const AtlasLayout layout = lay_out_atlas(count, 300, 2048, 8);
        CHECK(static_cast<std::size_t>(layout.columns * layout.rows) >= count);
        CHECK(layout.rows <= layout.columns);
        CHECK(layout.columns * layout.cell <= 2048);
        CHECK((layout.cell & (layout.cell - 1)) == 0);
        CHECK(2 * layout.gutter < layout.cell);
    }
    CHECK(lay_out_atlas(2, 300, 2048, 8).cell == 512);
    CHECK(lay_out_atlas(2, 300, 2048, 8).gutter == 8);
    CHECK(lay_out_atlas(9, 1, 2048, 8).cell == 1);
}

TEST_CASE(
    "texture atlas: corners are within the texture's own cell"
    * technique("engine.texture-atlas")) {
    for (const float gutter : {0.0f, 8.0f}) {
        const AtlasLayout layout = lay_out_atlas(5, 64, 8192, gutter);
        const Vec2 size = Vec2(layout.columns, layout.rows) * static_cast<float>(layout.cell);
        for (std::size_t i = 0; i < 5; ++i) {
            const AtlasCell rect = atlas_cell(layout, i);
            const Vec2 first = rect.offset * size;
            const Vec2 last = (rect.offset + rect.scale) * size;
            const Vec2 cell = Vec2(i % 3, i / 3) * 64.0f;
            const float inset = gutter > 0 ? static_cast<float>(layout.gutter) : 0.5f;
            CHECK(first.x == near(cell.x + inset));
            CHECK(first.y == near(cell.y + inset));
            CHECK(last.x == near(cell.x + 64 - inset));
            CHECK(last.y == near(cell.y + 64 - inset));
        }
    }
}

TEST_CASE("texture atlas: with a gutter, filters see the texture's own edge") {
    const std::vector<ImageData> images = {noise(48, 48, 1), noise(48, 48, 2), noise(48, 48, 3)};
    AtlasLayout layout = lay_out_atlas(3, 64, 8192, 64);
    REQUIRE(layout.gutter == 8);  // 48 pixels are left: textures are as they were
    const ImageData atlas = make_atlas(layout, pointers(images));
    for (std::size_t i = 0; i < 3; ++i) {
        const AtlasCell rect = atlas_cell(layout, i);
        for (const Vec2 uv :
             {Vec2(0, 0), Vec2(1, 1), Vec2(0, 1), Vec2(0.31f, 0.62f), Vec2(1, 0.5f)}) {
            const Vec3 expected = sampled(images[i], uv);
            const Vec3 found = sampled(atlas, rect.offset + rect.scale * uv);
            for (int c = 0; c < 3; ++c) {
                CHECK(found[c] == near(expected[c]).epsilon(1e-3));
            }
        }
    }
}

TEST_CASE(
    "texture atlas: no filter of a level that may be read sees a neighbor"
    * technique("engine.texture-atlas")) {
    std::vector<ImageData> images(4);
    for (std::size_t i = 0; i < 4; ++i) {
        images[i].width = images[i].height = 100;
        for (int k = 0; k < 100 * 100; ++k) {
            for (const std::size_t channel : {0u, 1u, 2u, 3u}) {
                images[i].pixels.push_back(channel == i ? 255 : 0);
            }
        }
    }
    const AtlasLayout layout = lay_out_atlas(4, 100, 8192, 16);
    REQUIRE(layout.cell == 128);
    REQUIRE(layout.gutter == 4);
    const ImageData atlas = make_atlas(layout, pointers(images));
    REQUIRE(last_atlas_level(layout) == 3);
    for (int level = 0; level <= 3; ++level) {
        CAPTURE(level);
        ImageData coarse;
        coarse.width = coarse.height = atlas.width >> level;
        coarse.pixels.resize(4 * static_cast<std::size_t>(coarse.width * coarse.height));
        for (std::size_t channel = 0; channel < 4; ++channel) {
            const std::vector<double> values = level_of(atlas, level, channel);
            for (std::size_t k = 0; k < values.size(); ++k) {
                coarse.pixels[4 * k + channel] = static_cast<std::uint8_t>(values[k]);
            }
        }
        for (std::size_t i = 0; i < 3; ++i) {
            const AtlasCell cell = atlas_cell(layout, i);
            for (const Vec2 uv : {Vec2(0, 0), Vec2(1, 1), Vec2(0, 1), Vec2(1, 0), Vec2(0.5f, 1)}) {
                const Vec3 found = sampled(coarse, cell.offset + cell.scale * uv);
                CHECK(found[static_cast<int>(i)] == near(255).epsilon(1e-3));
            }
        }
    }
}

TEST_CASE("texture atlas: a texture that is enlarged is interpolated") {
    ImageData ramp;
    ramp.width = 4;
    ramp.height = 1;
    for (const int value : {0, 60, 120, 180}) {
        ramp.pixels.insert(ramp.pixels.end(), 4, static_cast<std::uint8_t>(value));
    }
    const AtlasLayout layout = {.columns = 1, .rows = 1, .cell = 64, .gutter = 0};
    const ImageData atlas = make_atlas(layout, std::vector<const ImageData*>{&ramp});
    for (int x = 1; x < 64; ++x) {
        const int step = *texel(atlas, x, 20) - *texel(atlas, x - 1, 20);
        CHECK(step >= 0);
        CHECK(step <= 5);  // 60 of 255 in 16 pixels
    }
    CHECK(*texel(atlas, 0, 0) == 0);
    CHECK(*texel(atlas, 63, 63) == 180);
}

TEST_CASE("texture atlas: a stretched texture keeps its mean, in linear light") {
    const std::vector<ImageData> images = {noise(100, 77, 4, true), noise(640, 129, 5, true)};
    const AtlasLayout layout = {.columns = 2, .rows = 1, .cell = 64, .gutter = 0};
    const ImageData atlas = make_atlas(layout, pointers(images));
    CHECK(atlas.srgb);
    const auto linear = [](std::uint8_t byte) {
        return static_cast<double>(linear_from_srgb(static_cast<float>(byte) / 255));
    };
    for (int i = 0; i < 2; ++i) {
        const ImageData& image = images[static_cast<std::size_t>(i)];
        double expected = 0;
        for (std::size_t k = 0; k < image.pixels.size(); k += 4) {
            expected += linear(image.pixels[k]);
        }
        double found = 0;
        for (int y = 0; y < 64; ++y) {
            for (int x = 0; x < 64; ++x) {
                found += linear(*texel(atlas, 64 * i + x, y));
            }
        }
        CHECK(
            found / 4096
            == near(expected * 4 / static_cast<double>(image.pixels.size())).epsilon(1e-3));
    }
}

TEST_CASE(
    "scene atlas: materials that differ in their textures become one, and show what they showed"
    * technique("engine.texture-atlas")) {
    const GltfScene before = tiles(5);
    GltfScene scene = before;
    const SceneAtlasReport report = merge_materials(scene, {.gutter = 0});
    CHECK(report.notes.empty());
    CHECK(report.materials_before == 5);
    CHECK(report.materials == 1);
    CHECK(report.images == 1);
    REQUIRE(scene.nodes.size() == 5);
    for (std::size_t i = 0; i < 5; ++i) {
        const GltfPart part = scene.nodes[i].parts[0];
        const MeshData& mesh = scene.meshes[part.mesh];
        const TextureSlot& slot = scene.materials[part.material].base_color_texture;
        CHECK(slot.lod_range == Vec2(0, 4));
        CHECK(slot.wrap_u == Wrap::Clamp);
        CHECK(mesh.positions == before.meshes[i].positions);
        for (std::size_t v = 0; v < 4; ++v) {
            const Vec2 corner = before.meshes[i].uvs[v];
            const std::uint8_t* const expected =
                texel(before.images[i], corner.x > 0 ? 15 : 0, corner.y > 0 ? 15 : 0);
            const Vec3 found = sampled(scene.images[slot.image.index], mesh.uvs[v]);
            CHECK(found.x == near(expected[0]).epsilon(1e-3));
            CHECK(found.y == near(expected[1]).epsilon(1e-3));
        }
    }
}

TEST_CASE("scene atlas: what tiles, is moved or differs in more than its textures stays as it is") {
    GltfScene scene = tiles(6);
    scene.meshes[1].uvs[3] = {4, 4};
    scene.materials[2].base_color_texture.scale = {2, 2};
    scene.materials[3].roughness = 0.9f;
    scene.meshes[4].uvs.clear();
    const GltfScene before = scene;
    const SceneAtlasReport report = merge_materials(scene);
    REQUIRE(report.notes.size() == 2);
    CHECK(
        report.notes[0]
        == "material \"tile1\": found texture coordinates (4, 4) in the mesh \"square1\", expected "
           "0 "
           "to 1: an atlas cannot tile; it keeps its textures");
    CHECK(
        report.notes[1].find("no texture coordinates in the mesh \"square4\"")
        != std::string::npos);
    CHECK(report.materials == 5);  // tile0 and tile5 are one
    CHECK(scene.nodes[0].parts[0].material == scene.nodes[5].parts[0].material);
    for (const std::size_t i : {1u, 2u, 3u, 4u}) {
        CAPTURE(i);
        const GltfPart part = scene.nodes[i].parts[0];
        CHECK(scene.meshes[part.mesh].uvs == before.meshes[i].uvs);
        const Material& material = scene.materials[part.material];
        CHECK(material.name == before.materials[i].name);
        CHECK(
            scene.images[material.base_color_texture.image.index].pixels
            == before.images[i].pixels);
    }
}

TEST_CASE(
    "scene atlas: a mesh that several materials share is copied, textures of one size or not") {
    GltfScene scene = tiles(3);
    scene.images[1] = noise(64, 32, 7, true);
    scene.nodes[1].parts[0].mesh = 0;
    scene.nodes[2].parts[0] = {0, 0};
    const SceneAtlasReport report = merge_materials(scene);
    CHECK(report.materials == 1);
    CHECK(scene.meshes.size() == 2);
    CHECK(scene.nodes[0].parts[0].mesh == scene.nodes[2].parts[0].mesh);
    CHECK(scene.nodes[0].parts[0].mesh != scene.nodes[1].parts[0].mesh);
    CHECK(scene.images[0].width == 2 * 64);
}

TEST_CASE("scene atlas: levels of a file that are no two levels are told, and all are read") {
    const test::TemporaryFolder folder;
    const std::string path = folder.file("levels.gltf");
    for (const char* range :
         {"[0, 4, 0]", "[3]", "\"low\"", "[0, \"4\"]", "[4, 0]", "[-1, 99]", "{}", "[0, 4]"}) {
        CAPTURE(range);
        std::ofstream(path)
            << R"({"asset": {"version": "2.0"}, "materials": [{"pbrMetallicRoughness":
            {"baseColorTexture": {"index": 0}}}], "textures": [{"source": 0, "sampler": 0}],
            "samplers": [{"extras": {"limn": {"lod_range": )"
            << range << R"(}}}], "images": [{"uri": "data:image/png;base64,)"
            << "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAA"
               "ABJRU5ErkJggg=="
            << R"("}]})";
        const Result<GltfScene> read = load_gltf(path);
        REQUIRE_MESSAGE(read.ok(), (read ? std::string() : read.error().message));
        const bool is_good = std::string(range) == "[0, 4]";
        CHECK(
            read->materials[0].base_color_texture.lod_range
            == (is_good ? Vec2(0, 4) : TextureSlot{}.lod_range));
        CHECK(read->warnings.empty() == is_good);
    }
}

TEST_CASE("scene atlas: relief whose only image is missing is gone, not another image") {
    const test::TemporaryFolder folder;
    const std::string path = folder.file("relief.gltf");
    std::ofstream(path) << R"({"asset": {"version": "2.0"}, "materials": [{"extras": {"limn":
        {"relief_texture": {"index": 0}}}}], "textures": [{"source": 0}],
        "images": [{"uri": "missing.png"}]})";
    Result<GltfScene> read = load_gltf(path);
    REQUIRE_MESSAGE(read.ok(), (read ? std::string() : read.error().message));
    CHECK(read->images.empty());
    CHECK(read->materials[0].relief_texture.image.index == kNoAsset);
    (void)merge_materials(*read);
}

TEST_CASE("scene atlas: a written file says which mip levels may be read") {
    GltfScene scene = tiles(4);
    (void)merge_materials(scene);
    const test::TemporaryFolder folder;
    const std::string path = folder.file("tiles.glb");
    REQUIRE(save_glb(path, scene).ok());
    const Result<GltfScene> read = load_gltf(path);
    REQUIRE_MESSAGE(read.ok(), (read ? std::string() : read.error().message));
    REQUIRE(read->materials.size() == 1);
    CHECK(read->materials[0].base_color_texture.lod_range == Vec2(0, 1));
    CHECK(read->materials[0].base_color_texture.wrap_v == Wrap::Clamp);
    CHECK(read->images[0].pixels == scene.images[0].pixels);
}

}  // namespace limn::texture_atlas_test
