#include "content/load/files/exr_file.h"
#include "content/load/files/image_load.h"
#include "content/load/files/png_file.h"
#include "ecs/base/srgb.h"
#include "ecs/components/surface.h"
#include "tests/app/run_program.h"
#include "tests/one_mesh_glb.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <tuple>
#include <vector>

namespace limn::bake_command_test {

using test::count_lines;
using test::ProgramRun;
using test::run_limn;
using test::TemporaryFolder;
using test::write_text;

namespace {

const std::string kModel = LIMN_SOURCE_DIR "/content/levels/lagoon_lantern.gltf";

using Words = std::vector<std::string>;

ProgramRun bake(const TemporaryFolder& folder, Words more) {
    Words words = {"bake", "furrows", kModel};
    words.insert(words.end(), more.begin(), more.end());
    return run_limn(folder, words);
}

/// The run failed with `code` and one line that says `says`, and left no file.
void check_fails(const TemporaryFolder& folder, const Words& more, int code, const char* says) {
    const ProgramRun run = bake(folder, more);
    CAPTURE(run.err);
    CHECK(run.exit_code == code);
    CHECK(count_lines(run.err) == 1);
    CHECK(run.err.find(says) != std::string::npos);
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        CHECK(entry.path().extension() != ".png");
    }
}

}  // namespace

TEST_CASE(
    "bake: block writes an image in blocks that info and view read"
    * technique("engine.opt-texture")) {
    const TemporaryFolder folder;
    std::vector<std::uint8_t> pixels;
    for (int i = 0; i < 32 * 20; ++i) {
        const auto value = static_cast<std::uint8_t>(i % 32 * 8);
        pixels.insert(pixels.end(), {value, 128, 255});
    }
    REQUIRE(write_png(folder.file("wall.png"), 32, 20, 3, pixels).ok());
    for (const auto& [set, format, bytes] :
         {std::tuple("kind=color", "BC7 (sRGB)", 148 + 944),
          {"kind=data", "BC7", 148 + 944},
          {"kind=normal", "BC5", 148 + 944},
          {"levels=false", "BC7 (sRGB)", 148 + 640}}) {
        const ProgramRun run = run_limn(
            folder, {"bake", "block", folder.file("wall.png"), "-o", "wall.dds", "--set", set});
        CAPTURE(run.err);
        REQUIRE(run.exit_code == 0);
        CHECK(count_lines(run.out) == 1);
        CHECK(std::filesystem::file_size(folder.file("wall.dds")) == bytes);
        const ProgramRun info = run_limn(folder, {"info", "wall.dds"});
        CHECK(info.exit_code == 0);
        CHECK(info.out.find("32 x 20 pixels, " + std::string(format) + ", ") != std::string::npos);
    }
    CHECK(run_limn(folder, {"view", "wall.dds", "-o", "shown.png"}).exit_code == 0);
    const auto shown = load_image(folder.file("shown.png"), true);
    REQUIRE(shown.ok());
    CHECK(shown->width == 32);
    for (std::size_t i = 0; i < pixels.size() / 3; ++i) {
        CHECK(std::abs(shown->pixels[4 * i] - pixels[3 * i]) <= 4);
    }

    ExrImage floats = {.width = 1, .height = 1};
    add_layer(floats, "", "RGB", std::vector<float>{1, 1, 1}, false);
    REQUIRE(write_exr(folder.file("light.exr"), floats).ok());
    const ProgramRun refused = run_limn(folder, {"bake", "block", "light.exr", "-o", "light.dds"});
    CHECK(refused.exit_code == 1);
    CHECK(refused.err.find("expected 8 bits") != std::string::npos);
    CHECK(count_lines(refused.err) == 1);
    const ProgramRun named = run_limn(folder, {"bake", "block", "wall.png", "-o", "wall.png"});
    CHECK(named.err.find("ending in .dds") != std::string::npos);
}

TEST_CASE(
    "bake: photometric writes the normals and the reflectance of the photographed surface"
    * technique("face.photometric-normals")) {
    const TemporaryFolder folder;
    const Vec3 normals[2] = {{0.2f, 0.3f, 0.932738f}, {-0.4f, 0.1f, 0.911043f}};
    const float albedo[2] = {0.7f, 0.35f};
    const Vec3 lights[3] = {{1, 0, 1}, {-1, 0, 1}, {0, 1, 1}};
    for (int shot = 0; shot < 3; ++shot) {
        ExrImage image = {.width = 2, .height = 1};
        std::vector<float> values;
        for (int x = 0; x < 2; ++x) {
            const float lit =
                albedo[x] * std::max(glm::dot(normals[x], glm::normalize(lights[shot])), 0.0f);
            values.insert(values.end(), 3, lit);
        }
        add_layer(image, "", "RGB", values, false);
        REQUIRE(write_exr(folder.file("shot" + std::to_string(shot) + ".exr"), image).ok());
    }
    write_text(
        folder.file("shots.json"),
        R"({"shots": [{"image": "shot0.exr", "to_light": [1, 0, 1]}, {"image": "shot1.exr", "to_light": [-1, 0, 1]},
            {"image": "shot2.exr", "to_light": [0, 2, 2]}]})");
    const ProgramRun run =
        run_limn(folder, {"bake", "photometric", folder.file("shots.json"), "-o", "face.png"});
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
    const auto normal = load_image(folder.file("face_normal.png"), false);
    const auto gray = load_image(folder.file("face_albedo.png"), true);
    REQUIRE((normal.ok() && gray.ok()));
    for (std::size_t x = 0; x < 2; ++x) {
        for (int c = 0; c < 3; ++c) {
            const float found =
                static_cast<float>(normal->pixels[4 * x + static_cast<std::size_t>(c)]) / 127.5f
                - 1;
            CHECK(std::abs(found - normals[x][c]) < 0.006f);
        }
        const float found = static_cast<float>(gray->pixels[4 * x]) / 255.0f;
        CHECK(std::abs(linear_from_srgb(found) - albedo[x]) < 0.005f);
    }
}

TEST_CASE("bake: photometric refuses coplanar lights, different sizes and missing files by name") {
    const TemporaryFolder folder;
    const auto says = [&](const char* shots, const char* expected) {
        write_text(folder.file("shots.json"), shots);
        const ProgramRun run =
            run_limn(folder, {"bake", "photometric", folder.file("shots.json"), "-o", "face.png"});
        CAPTURE(run.err);
        CHECK(run.exit_code == 1);
        CHECK(count_lines(run.err) == 1);
        CHECK(run.err.find(expected) != std::string::npos);
        CHECK_FALSE(std::filesystem::exists(folder.file("face_normal.png")));
    };
    says(R"({"shots": []})", "shots.json: found 0 lights, expected at least 3");
    says(
        R"({"shots": [{"image": "a.png", "to_light": [1, 0, 1]}, {"image": "b.png", "to_light": [0, 0, 1]},
            {"image": "c.png", "to_light": [-1, 0, 1]}]})",
        "lights that all lie in one plane");
    says(
        R"({"shots": [{"image": "a.png", "to_light": [1, 0, 1]}, {"image": "b.png", "to_light": [0, 1, 1]},
            {"image": "c.png", "to_light": [-1, 0, 1]}]})",
        "a.png: ");
    says(R"({"shot": []})", "shot");
    for (int size = 1; size <= 2; ++size) {
        ExrImage image = {.width = size, .height = 1};
        add_layer(image, "", "Y", std::vector<float>(static_cast<std::size_t>(size), 0.5f), false);
        REQUIRE(write_exr(folder.file(size == 1 ? "a.exr" : "b.exr"), image).ok());
    }
    says(
        R"({"shots": [{"image": "a.exr", "to_light": [1, 0, 1]}, {"image": "b.exr", "to_light": [0, 1, 1]},
            {"image": "a.exr", "to_light": [-1, 0, 1]}]})",
        "b.exr: found 2 x 1 pixels, expected the 1 x 1 of the first image");
}

TEST_CASE("bake: furrows writes a height map and unit normals of the requested size") {
    const TemporaryFolder folder;
    const ProgramRun run =
        bake(folder, {"-o", "skin.exr", "--set", "size=96", "--recipe", "recipe.json"});
    CHECK(run.exit_code == 1);  // there is no recipe yet
    write_text(
        folder.file("recipe.json"),
        R"({"preset": "rough", "projection": "planar", "arrows": [{"at": [0, 0, 0], "first": [0, 1, 0],
            "second": [1, 0.2, 0]}]})");
    const ProgramRun good =
        bake(folder, {"-o", "skin.exr", "--set", "size=96", "--recipe", "recipe.json"});
    CAPTURE(good.err);
    REQUIRE(good.exit_code == 0);
    const auto height = read_exr(folder.file("skin_height.exr"));
    REQUIRE(height.ok());
    CHECK(height->width == 96);
    CHECK(height->height == 96);
    const ExrChannel* const all = find_channel(*height, "Y");
    const ExrChannel* const first = find_channel(*height, "first.Y");
    const ExrChannel* const second = find_channel(*height, "second.Y");
    REQUIRE((all != nullptr && first != nullptr && second != nullptr));
    std::size_t furrowed = 0;
    for (std::size_t i = 0; i < all->values.size(); ++i) {
        const float lesser = std::min(first->values[i], second->values[i]);
        CHECK(all->values[i] <= lesser);
        if (lesser < 1) {                            // of the surface, not of the gutter around it
            CHECK(all->values[i] >= lesser - 0.3f);  // the noise of the preset
        }
        furrowed += lesser < 1 ? 1 : 0;
    }
    CHECK(furrowed > 100);
    const auto normals = load_image(folder.file("skin_normal.png"), false);
    REQUIRE(normals.ok());
    CHECK(normals->width == 96);
    for (std::size_t i = 0; i < normals->pixels.size(); i += 4) {
        const Vec3 n =
            Vec3(normals->pixels[i], normals->pixels[i + 1], normals->pixels[i + 2]) / 127.5f
            - 1.0f;
        CHECK(std::abs(glm::length(n) - 1.0f) < 0.02f);
    }
}

TEST_CASE("bake: the same command writes the same files, a different seed different ones") {
    const TemporaryFolder folder;
    for (const char* name : {"a.png", "b.png"}) {
        REQUIRE(
            bake(folder, {"-o", name, "--set", "size=64", "--set", "projection=planar"}).exit_code
            == 0);
    }
    REQUIRE(
        bake(
            folder,
            {"-o", "c.png", "--set", "size=64", "--set", "projection=planar", "--set", "seed=7"})
            .exit_code
        == 0);
    const std::string a = test::read_text(folder.file("a_height.png"));
    CHECK(!a.empty());
    CHECK(a == test::read_text(folder.file("b_height.png")));
    CHECK(a != test::read_text(folder.file("c_height.png")));
}

TEST_CASE("bake: the GPU makes the same height map") {
    const TemporaryFolder folder;
    const Words settings = {"--set", "size=48", "--set", "projection=planar", "--set", "noise=0.2"};
    Words cpu = {"-o", "cpu.png"};
    Words gpu = {"-o", "gpu.png", "--gpu"};
    cpu.insert(cpu.end(), settings.begin(), settings.end());
    gpu.insert(gpu.end(), settings.begin(), settings.end());
    REQUIRE(bake(folder, cpu).exit_code == 0);
    REQUIRE(bake(folder, gpu).exit_code == 0);
    CHECK(
        test::read_text(folder.file("cpu_height.png"))
        == test::read_text(folder.file("gpu_height.png")));
}

TEST_CASE("bake: an error is one line that says what was found and what was expected") {
    const TemporaryFolder folder;
    const ProgramRun unknown = run_limn(folder, {"bake", "furows", kModel, "-o", "a.png"});
    CHECK(unknown.exit_code == 2);
    CHECK(unknown.err.find("did you mean furrows?") != std::string::npos);
    check_fails(folder, {}, 2, "--out");
    check_fails(folder, {"-o", "a.bmp"}, 2, ".png");
    check_fails(folder, {"-o", "a.png", "--set", "size=0"}, 1, "size: found the number 0");
    check_fails(folder, {"-o", "a.png", "--set", "sise=4"}, 1, "did you mean size?");
    check_fails(folder, {"-o", "a.png"}, 1, "found no triangle with an area");
    check_fails(folder, {"-o", "a.png", "--mesh", "nose"}, 1, "found no mesh \"nose\"");
    write_text(folder.file("recipe.json"), "{\n  \"noice\": 1}");
    check_fails(folder, {"-o", "a.png", "--recipe", "recipe.json"}, 1, "recipe.json:2:3");
    write_text(folder.file("recipe.json"), R"({"arrows": [{"weight": 11}]})");
    check_fails(folder, {"-o", "a.png", "--recipe", "recipe.json"}, 1, "arrows[0].weight");
    const ProgramRun absent = run_limn(folder, {"bake", "furrows", "none.glb", "-o", "a.png"});
    CHECK(absent.exit_code == 1);
    CHECK(absent.err.find("none.glb") != std::string::npos);
}

namespace {

/// A square of skin with the shape "narrow", which shortens it by 0.3 along u.
void write_skin(const std::string& path) {
    GltfScene scene;
    scene.name = "skin";
    MeshData& mesh = scene.meshes.emplace_back();
    mesh.name = "skin";
    for (const Vec2 uv : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1)}) {
        mesh.positions.emplace_back(uv.x, 1 - uv.y, 0);
        mesh.normals.emplace_back(0, 0, 1);
        mesh.tangents.emplace_back(1, 0, 0, 1);
        mesh.uvs.push_back(uv);
    }
    mesh.indices = {0, 2, 1, 1, 2, 3};
    MorphTarget& morph = mesh.morphs.emplace_back();
    morph.name = "narrow";
    morph.vertices = {1, 3};
    morph.positions = {{-0.3f, 0, 0}, {-0.3f, 0, 0}};
    test::write_one_mesh(path, scene, "skin");
}

/// 4 x 4 texels with one normal.
void write_normals(const std::string& path, std::uint8_t x, std::uint8_t y) {
    std::vector<std::uint8_t> pixels;
    for (int i = 0; i < 16; ++i) {
        pixels.insert(pixels.end(), {x, y, 240});
    }
    REQUIRE(write_png(path, 4, 4, 3, pixels).ok());
}

}  // namespace

TEST_CASE(
    "bake: a strain model has the slopes of the captured map, less those at rest"
    * technique("face.wrinkle-model")) {
    const TemporaryFolder folder;
    write_skin(folder.file("skin.glb"));
    write_normals(folder.file("narrow.png"), 128 + 56, 128 - 28);
    write_normals(folder.file("rest.png"), 128, 128 - 28);
    write_text(
        folder.file("poses.json"),
        R"({"face": "skin.glb", "rest": "rest.png", "size": 8, "degree": 1,
            "poses": [{"image": "narrow.png", "shapes": [{"name": "narrow"}]}]})");
    const ProgramRun run =
        run_limn(folder, {"bake", "strain_model", folder.file("poses.json"), "-o", "skin.exr"});
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
    const auto model = read_exr(folder.file("skin.exr"));
    REQUIRE(model.ok());
    REQUIRE(model->width == 8);
    REQUIRE(model->height == 4 * 8);
    const auto at = [&](const char* channel, std::size_t tile) {
        return find_channel(*model, channel)->values[8 * 8 * tile + 27];
    };
    CHECK(std::abs(at("R", 0) + 0.3f) < 1e-3f);  // the least strain along the tangent
    CHECK(std::abs(at("G", 0)) < 1e-3f);
    // Where that is all, the slope is less the first coefficient: -(56, 0) / 112.
    CHECK(std::abs(at("R", 2) - 0.5f) < 2e-3f);
    CHECK(std::abs(at("G", 2)) < 2e-3f);
    const auto loaded = load_image(folder.file("skin.exr"), false);  // as a level does
    REQUIRE(loaded.ok());
    CHECK(loaded->format == PixelFormat::Rgba16F);
}

TEST_CASE("bake: a strain model with wrong shapes, maps or faces is refused by name") {
    const TemporaryFolder folder;
    write_skin(folder.file("skin.glb"));
    write_normals(folder.file("a.png"), 128, 128);
    const auto says = [&](const char* poses, const char* expected) {
        write_text(folder.file("poses.json"), poses);
        const ProgramRun run =
            run_limn(folder, {"bake", "strain_model", folder.file("poses.json"), "-o", "a.exr"});
        CAPTURE(run.err);
        CHECK(run.exit_code == 1);
        CHECK(count_lines(run.err) == 1);
        CHECK(run.err.find(expected) != std::string::npos);
        CHECK_FALSE(std::filesystem::exists(folder.file("a.exr")));
    };
    says(R"({"face": "skin.glb"})", "poses.json: found 0 poses, expected at least 1");
    says(
        R"({"face": "skin.glb", "poses": [{"image": "a.png", "shapes": [{"name": "narrov"}]}]})",
        "found the shape \"narrov\", expected a morph target of the face");
    says(
        R"({"face": "skin.glb", "poses": [{"image": "b.png", "shapes": [{"name": "narrow"}]}]})",
        "b.png: ");
    says(R"({"face": "no.glb", "poses": [{"image": "a.png"}]})", "no.glb");
    says(
        R"({"face": "skin.glb", "uv_set": 1, "poses": [{"image": "a.png"}]})",
        "skin.glb: found no texture coordinates 1, expected those of the maps");
    says(R"({"face": "skin.glb", "size": 0, "poses": [{"image": "a.png"}]})", "size");
}

}  // namespace limn::bake_command_test
