#include "content/bake/odd_map.h"
#include "content/bake/relief_map.h"
#include "content/load/files/exr_file.h"
#include "content/load/files/image_load.h"
#include "content/load/files/png_file.h"
#include "content/load/gltf/gltf_load.h"
#include "content/make/models/shapes.h"
#include "ecs/components/surface.h"
#include "tests/app/run_program.h"
#include "tests/one_mesh_glb.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace limn::bake_relief_test {

using test::count_lines;
using test::ProgramRun;
using test::run_limn;
using test::TemporaryFolder;
using test::write_text;

namespace {

using Words = std::vector<std::string>;

void write_mesh(const std::string& path, MeshData mesh) {
    GltfScene scene;
    scene.name = "scene";
    mesh.name = "mesh";
    scene.meshes.push_back(std::move(mesh));
    test::write_one_mesh(path, scene, "node");
}

ImageData load(const std::string& path) {
    Result<ImageData> image = load_image(path, false);
    REQUIRE_MESSAGE(image.ok(), (image ? std::string() : image.error().message));
    return std::move(*image);
}

Vec4 texel_at(const ImageData& image, int x, int y) {
    const std::size_t i = 4 * static_cast<std::size_t>(y * image.width + x);
    return Vec4(image.pixels[i], image.pixels[i + 1], image.pixels[i + 2], image.pixels[i + 3])
           / 255.0f;
}

ProgramRun bake(const TemporaryFolder& folder, Words words) {
    words.insert(words.begin(), "bake");
    return run_limn(folder, words);
}

void check_ok(const ProgramRun& run) {
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
}

/// The run fails with one line that says `says`, and writes nothing.
void check_fails(const TemporaryFolder& folder, const Words& words, const std::string& says) {
    const ProgramRun run = bake(folder, words);
    CAPTURE(run.err);
    CHECK(run.exit_code == 1);
    CHECK(count_lines(run.err) == 1);
    CHECK(run.err.find(says) != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(folder.file("out.png")));
    CHECK_FALSE(std::filesystem::exists(folder.file("out_normal.png")));
}

/// A ramp to the right with 16 bits.
void write_ramp(const std::string& path, int width, int height) {
    std::vector<std::uint16_t> words;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            words.push_back(static_cast<std::uint16_t>(65535 * x / (width - 1)));
        }
    }
    REQUIRE(write_png16(path, width, height, 1, words).ok());
}

}  // namespace

TEST_CASE(
    "bake: normal of a ramp of 16 bits is one slope, without steps"
    * technique("bump.nm-from-height")) {
    const TemporaryFolder folder;
    write_ramp(folder.file("ramp.png"), 64, 32);
    check_ok(bake(
        folder,
        {"normal", "ramp.png", "-o", "out.png", "--set", "repeats=false", "--set", "depth=0.5"}));
    const ImageData map = load(folder.file("out.png"));
    CHECK(map.width == 64);
    CHECK(map.height == 32);
    const float slope = 0.5f * 64 / 63;
    const Vec3 expected = glm::normalize(Vec3(-slope, 0, 1));
    for (int x = 0; x < 64; ++x) {
        CHECK(glm::length(decode_normal(Vec3(texel_at(map, x, x / 2))) - expected) < 0.008f);
    }
}

TEST_CASE(
    "bake: relief of a mesh has its depth in alpha, double-depth its back in blue"
    * technique("relief.map-bake, relief.map-format, bump.nm-from-basrelief")) {
    const TemporaryFolder folder;
    write_mesh(
        folder.file("ball.glb"), make_sphere({.radius = 0.5f, .segments = 128, .rings = 64}));
    const ProgramRun run = bake(
        folder, {"relief", "ball.glb", "-o", "out.png", "--set", "size=65", "--set", "depth=0.5"});
    check_ok(run);
    CHECK(run.err.find("relief_depth 0.5 m") != std::string::npos);
    CHECK(run.err.find("relief_steps") != std::string::npos);
    const ImageData map = load(folder.file("out.png"));
    const float x = 20.0f / 65;
    const float z = std::sqrt(0.25f - x * x);
    CHECK(std::abs(texel_at(map, 52, 32).w - (0.5f - z) / 0.5f) < 0.006f);
    CHECK(std::abs(texel_at(map, 52, 32).x - (0.5f + x)) < 0.006f);
    check_ok(bake(folder, {"double-depth", "ball.glb", "-o", "double.exr", "--set", "size=65"}));
    const auto exr = read_exr(folder.file("double.exr"));
    REQUIRE(exr.ok());
    const std::size_t center = 32 * 65 + 52;
    CHECK(std::abs(find_channel(*exr, "A")->values[center] - (0.5f - z)) < 1e-3f);
    CHECK(std::abs(find_channel(*exr, "B")->values[center] - (0.5f + z)) < 1e-3f);
}

TEST_CASE("bake: levels of a relief are half as large each" * technique("relief.filter")) {
    const TemporaryFolder folder;
    write_ramp(folder.file("ramp.png"), 16, 8);
    check_ok(bake(folder, {"relief", "ramp.png", "-o", "out.png", "--set", "levels=true"}));
    for (int level = 1; level <= 4; ++level) {
        const ImageData map = load(folder.file("out_level" + std::to_string(level) + ".png"));
        CHECK(map.width == 16 >> level);
        CHECK(map.height == std::max(8 >> level, 1));
        CHECK(std::abs(texel_at(map, 0, 0).w + texel_at(map, map.width - 1, 0).w - 1) < 0.01f);
    }
    CHECK_FALSE(std::filesystem::exists(folder.file("out_level5.png")));
}

TEST_CASE("bake: cone maps keep normal and depth of the relief, blue is the ratio") {
    const TemporaryFolder folder;
    write_mesh(folder.file("torus.glb"), make_torus({}));
    const Words settings = {"--set", "size=32", "--set", "face=top"};
    Words relief = {"relief", "torus.glb", "-o", "relief.png"};
    Words cone = {"cone", "torus.glb", "-o", "cone.png"};
    relief.insert(relief.end(), settings.begin(), settings.end());
    cone.insert(cone.end(), settings.begin(), settings.end());
    check_ok(bake(folder, relief));
    check_ok(bake(folder, cone));
    const ImageData a = load(folder.file("relief.png"));
    const ImageData b = load(folder.file("cone.png"));
    float narrowest = 1;
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
            const Vec4 one = texel_at(a, x, y);
            const Vec4 other = texel_at(b, x, y);
            CHECK(Vec3(one.x, one.y, one.w) == Vec3(other.x, other.y, other.w));
            narrowest = std::min(narrowest, other.z);
        }
    }
    CHECK(narrowest > 0);
    CHECK(narrowest < 0.9f);
}

TEST_CASE("bake: ao of a flat map is white, of a pit dark at its bottom") {
    const TemporaryFolder folder;
    std::vector<std::uint8_t> pit(32 * 32, 255);
    for (std::size_t y = 12; y < 20; ++y) {
        for (std::size_t x = 12; x < 20; ++x) {
            pit[32 * y + x] = 0;
        }
    }
    REQUIRE(write_png(folder.file("pit.png"), 32, 32, 1, pit).ok());
    check_ok(bake(folder, {"ao", "pit.png", "-o", "out.png", "--set", "depth=0.3"}));
    const ImageData map = load(folder.file("out.png"));
    CHECK(texel_at(map, 3, 3).x == 1);
    CHECK(texel_at(map, 15, 15).x < 0.4f);
    CHECK(texel_at(map, 15, 15).x > 0.02f);
}

TEST_CASE(
    "bake: odd writes 512 x 512 texels in either order, and the index map"
    * technique("odd.bake, odd.map-format, odd.order, odd.index-map")) {
    const TemporaryFolder folder;
    std::vector<std::uint8_t> heights;
    for (int i = 0; i < 256; ++i) {
        heights.push_back(static_cast<std::uint8_t>((i % 16) < 8 ? 255 : 40));
    }
    REQUIRE(write_png(folder.file("h.png"), 16, 16, 1, heights).ok());
    check_ok(bake(folder, {"odd", "h.png", "-o", "a.png"}));
    check_ok(bake(folder, {"odd", "h.png", "-o", "b.png", "--set", "order=positions"}));
    const ImageData a = load(folder.file("a.png"));
    const ImageData b = load(folder.file("b.png"));
    CHECK(a.pixels.size() == 1048576);
    const IVec2 from = odd_texel({5, 9}, {8, 7}, OddOrder::Directions);
    const IVec2 to = odd_texel({5, 9}, {8, 7}, OddOrder::Positions);
    CHECK(texel_at(a, from.x, from.y) == texel_at(b, to.x, to.y));
    CHECK(load(folder.file("a_index.png")).width == 256);
}

TEST_CASE(
    "bake: detail writes maps and a model that shows them" * technique("bump.nm-detail-recovery")) {
    const TemporaryFolder folder;
    write_mesh(folder.file("low.glb"), make_sphere({.radius = 1, .segments = 16, .rings = 8}));
    write_mesh(folder.file("high.glb"), make_sphere({.radius = 1, .segments = 128, .rings = 64}));
    const ProgramRun run = bake(
        folder, {"detail", "low.glb", "--high", "high.glb", "-o", "ball.png", "--set", "size=64",
                 "--set", "rays=4"});
    check_ok(run);
    CHECK(run.err.find("64 x 64 from") != std::string::npos);
    for (const char* name : {"ball_normal.png", "ball_height.png", "ball_occlusion.png"}) {
        CHECK(load(folder.file(name)).width == 64);
    }
    const auto model = load_gltf(folder.file("ball.glb"));
    REQUIRE_MESSAGE(model.ok(), (model ? std::string() : model.error().message));
    REQUIRE(model->materials.size() == 1);
    CHECK(model->materials[0].normal_texture.image.index != kNoAsset);
    CHECK(model->materials[0].occlusion_texture.image.index != kNoAsset);
    CHECK(model->meshes[0].indices.size() == 3u * 2 * 16 * 7);
    CHECK(model->images.size() == 2);
}

TEST_CASE("bake: detail with relief writes a low mesh around the high one, displaced to it") {
    const TemporaryFolder folder;
    write_mesh(folder.file("low.glb"), make_sphere({.radius = 1, .segments = 16, .rings = 8}));
    write_mesh(folder.file("high.glb"), make_sphere({.radius = 1, .segments = 128, .rings = 64}));
    check_ok(bake(
        folder, {"detail", "low.glb", "--high", "high.glb", "-o", "ball.png", "--set", "size=64",
                 "--set", "rays=0", "--set", "distance=0.05", "--set", "relief=true"}));
    const auto model = load_gltf(folder.file("ball.glb"));
    REQUIRE_MESSAGE(model.ok(), (model ? std::string() : model.error().message));
    const Material& material = model->materials.at(0);
    CHECK(material.detail == SurfaceDetail::Displaced);
    CHECK(material.relief_texture.image.index != kNoAsset);
    // The middle of a face is 2 to 4 % of the radius below the ball: the mesh is moved out by that.
    CHECK(material.relief_depth > 0.02f);
    CHECK(material.relief_depth < 0.08f);
    CHECK(model->meshes[0].bounds.max.y > 1.015f);
}

TEST_CASE("bake: the same command writes the same maps") {
    const TemporaryFolder folder;
    write_mesh(folder.file("torus.glb"), make_torus({}));
    for (const char* name : {"a.png", "b.png"}) {
        check_ok(bake(
            folder, {"cone", "torus.glb", "-o", name, "--set", "size=48", "--set", "bits=16"}));
    }
    CHECK(test::read_text(folder.file("a.png")) == test::read_text(folder.file("b.png")));
}

TEST_CASE("bake: maps from what cannot be baked are errors of one line") {
    const TemporaryFolder folder;
    write_ramp(folder.file("ramp.png"), 4, 4);
    MeshData flat = make_sphere({.segments = 8, .rings = 4});
    for (Vec2& uv : flat.uvs) {
        uv = {0.5f, 0.5f};
    }
    write_mesh(folder.file("flat.glb"), flat);
    write_mesh(folder.file("ball.glb"), make_sphere({.segments = 8, .rings = 4}));
    MeshData far = make_sphere({.segments = 8, .rings = 4});
    for (Vec3& p : far.positions) {
        p.x += 100;
    }
    write_mesh(folder.file("far.glb"), far);
    check_fails(folder, {"relief", "none.glb", "-o", "out.png"}, "none.glb");
    check_fails(folder, {"relief", "none.png", "-o", "out.png"}, "none.png");
    write_text(folder.file("text.png"), "text");
    check_fails(folder, {"normal", "text.png", "-o", "out.png"}, "text.png: found 4 bytes");
    check_fails(folder, {"double-depth", "ramp.png", "-o", "out.png"}, "expected a mesh");
    check_fails(folder, {"relief", "ball.glb", "-o", "out.png", "--set", "size=0"}, "size");
    check_fails(folder, {"relief", "ball.glb", "-o", "out.png", "--set", "face=inside"}, "face");
    check_fails(folder, {"relief", "ball.glb", "-o", "out.png", "--mesh", "nose"}, "\"nose\"");
    check_fails(folder, {"detail", "ball.glb", "-o", "out.png"}, "--high");
    check_fails(
        folder, {"detail", "flat.glb", "--high", "ball.glb", "-o", "out.png"},
        "no triangle with an area in texture space");
    check_fails(
        folder, {"detail", "ball.glb", "--high", "far.glb", "-o", "out.png", "--set", "size=16"},
        "raise distance");
}

}  // namespace limn::bake_relief_test
