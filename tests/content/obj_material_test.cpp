// Material libraries and their images, from the text to the engine's materials.

#include "content/load/files/png_file.h"
#include "content/load/obj/obj_maps.h"
#include "content/load/obj/obj_material.h"
#include "content/load/obj/obj_scene.h"
#include "ecs/components/surface.h"
#include "tests/near.h"
#include "tests/support.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace limn::obj_material_test {

using test::near;

namespace {

ObjLibrary parse_library(const std::string& text) {
    Result<ObjLibrary> library = parse_obj_materials(text, "a.mtl");
    REQUIRE_MESSAGE(library.ok(), (library ? "" : library.error().message));
    return *std::move(library);
}

/// A triangle whose material `m` is in the library a.mtl, unless `mtllib` says otherwise.
struct Model {
    test::TemporaryFolder folder;

    void write(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories(std::filesystem::path(folder.file(name)).parent_path());
        std::ofstream(folder.file(name)) << text;
    }

    /// An image of 2 x 2 texels with these values.
    void write_image(const std::string& name, const std::vector<std::uint8_t>& values) const {
        std::filesystem::create_directories(std::filesystem::path(folder.file(name)).parent_path());
        const int channels = static_cast<int>(values.size()) / 4;
        REQUIRE(write_png(folder.file(name), 2, 2, channels, values).ok());
    }

    [[nodiscard]] GltfScene
    load(const std::string& mtllib = "a.mtl", const std::string& usemtl = "m") const {
        write(
            "a.obj", "mtllib " + mtllib + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl " + usemtl
                         + "\nf 1/1 2/1 3/1\n");
        Result<GltfScene> scene = Error{};
        static_cast<void>(test::messages_of([&] { scene = load_obj_scene(folder.file("a.obj")); }));
        REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
        return *std::move(scene);
    }

    /// The material of a library with one that has these statements.
    [[nodiscard]] Material material(const std::string& statements) const {
        write("a.mtl", "newmtl m\n" + statements);
        const GltfScene scene = load();
        CHECK_MESSAGE(
            scene.warnings.empty(), (scene.warnings.empty() ? "" : scene.warnings.front()));
        return scene.materials[1];
    }
};

const std::vector<std::uint8_t> kRgb = {255, 0, 0, 0, 255, 0, 0, 0, 255, 10, 20, 30};

/// The texels of the image of a slot.
std::vector<std::uint8_t> texels(const GltfScene& scene, const TextureSlot& slot) {
    REQUIRE(slot.image.index < scene.images.size());
    return scene.images[slot.image.index].pixels;
}

}  // namespace

TEST_CASE("obj material: a bad value costs that value, and the others stay") {
    const ObjLibrary library = parse_library(
        "Kd x\nnewmtl a\nKd 1 x 0\nKe 0.5 0 0\nNs nan\nd oops\nnewmtl b\nKd 2 0.5 0\nNs -1\nd -1\n"
        "newmtl c\nKd 0.25\nNs 10 20\nd -halo 0.5\n");
    REQUIRE(library.materials.size() == 3);
    CHECK_FALSE(library.materials[0].diffuse);
    CHECK(library.materials[0].emission == Vec3(0.5f, 0, 0));
    CHECK(library.materials[0].shininess == 0);
    CHECK_FALSE(library.materials[0].opacity);
    CHECK(library.materials[1].diffuse == Vec3(1, 0.5f, 0));
    CHECK(library.materials[2].diffuse == Vec3(0.25f));
    CHECK(library.materials[2].shininess == 10);
    CHECK(library.materials[2].opacity == 0.5f);
    CHECK(
        library.warnings
        == std::vector<std::string>{
            "a.mtl:3: Kd: found \"x\", expected a number of at most 1000000000; the value is left "
            "out",
            "a.mtl:5: Ns: found \"nan\", expected a number of at most 1000000000; the value is "
            "left "
            "out",
            "a.mtl:6: d: found \"oops\", expected 0 to 1; the value is left out",
            "a.mtl:8: Kd: found 2, expected 0 to 1; 1 is used",
            "a.mtl:9: Ns: found -1, expected 0 to 1000; the value is left out",
            "a.mtl:10: d: found -1, expected 0 to 1; the value is left out"});
}

TEST_CASE("obj material: factors above their range by rounding alone leave no warning") {
    const ObjLibrary library = parse_library("newmtl a\nKd 1.000001 1 1\nd 1.000001\n");
    CHECK(library.materials[0].diffuse == Vec3(1));
    CHECK(library.materials[0].opacity == 1.0f);
    CHECK(library.warnings.empty());
}

TEST_CASE("obj material: of opacity and transparency, opacity counts") {
    const ObjLibrary library = parse_library(
        "newmtl a\nTr 0.25\nnewmtl b\nd 1\nTr 1\nnewmtl c\nTr 1\nd 1\nnewmtl e\nd 0.5\nnewmtl f\n");
    CHECK(library.materials[0].opacity == 0.75f);
    CHECK(library.materials[1].opacity == 1.0f);
    CHECK(library.materials[2].opacity == 1.0f);
    CHECK(library.materials[3].opacity == 0.5f);
    CHECK_FALSE(library.materials[4].opacity);
}

TEST_CASE("obj material: a byte order mark, tabs and CR LF leave the same library") {
    for (const char* const text :
         {"newmtl a\nKd 1 0 0", "\xef\xbb\xbfnewmtl a\r\nKd\t1 0 0\r\n", "newmtl a\rKd 1 0 0\r"}) {
        const ObjLibrary library = parse_library(text);
        REQUIRE(library.materials.size() == 1);
        CHECK(library.materials[0].name == "a");
        CHECK(library.materials[0].diffuse == Vec3(1, 0, 0));
    }
}

TEST_CASE("obj material: options of an image are read, others skipped with their arguments") {
    const ObjLibrary library = parse_library(
        "newmtl a\n"
        "map_Kd -s 2 3 1 -o 0.5 0.25 -blendu on -mm 0 1 -texres 512 -clamp on my wood.png\n"
        "map_Bump -bm 0.5 -imfchan r -boost 2 -s 4 bump#1.png\n"
        "map_d -imfchan m -leaf.png\n"
        "map_Ks a.png\nMAP_KE -t 1 1 1 glow.png # all night\nmap_Pr -s 1\n");
    const ObjMaterial& material = library.materials[0];
    CHECK(material.diffuse_map.file == "my wood.png");
    CHECK(material.diffuse_map.scale == Vec2(2, 3));
    CHECK(material.diffuse_map.offset == Vec2(0.5f, 0.25f));
    CHECK(material.diffuse_map.clamp);
    CHECK(material.relief_map.file == "bump#1.png");
    CHECK(material.relief_map.strength == 0.5f);
    CHECK(material.relief_map.scale == Vec2(4, 1));
    CHECK(material.relief_map.channel == ObjChannel::Red);
    CHECK(material.opacity_map.file == "-leaf.png");
    CHECK(material.opacity_map.channel == ObjChannel::Alpha);
    CHECK(material.emission_map.file == "glow.png # all night");
    CHECK(
        library.warnings
        == std::vector<std::string>{
            "a.mtl:5: map_Ks: the image is ignored",
            "a.mtl:7: map_Pr: found no file name, expected one"});
}

TEST_CASE("obj material: a library is found by any name that programs write for it") {
    for (const auto& [file, line] : std::vector<std::pair<std::string, std::string>>{
             {"a.mtl", "a.mtl"},
             {"my house.mtl", "my house.mtl"},
             {"my house.mtl", "my%20house.mtl"},
             {"100%.mtl", "100%.mtl"},
             {"a%20b.mtl", "a%20b.mtl"},
             {"my house.mtl", "\"my house.mtl\""},
             {"a#b.mtl", "a#b.mtl"},
             {"a #1.mtl", "a #1.mtl"},
             {"a.mtl", "a.mtl # by hand"},
             {"a.mtl", "none.mtl a.mtl"},
             {"my house.mtl", "other.mtl my house.mtl"},
             {"sub/a.mtl", "sub\\a.mtl"},
             {"a.mtl", "C:\\models\\a.mtl"},
             {"a.mtl", "../models/a.mtl"},
             {"a.mtl", "A.MTL"}}) {
        const std::string& mtllib = line;  // a binding cannot be captured
        CAPTURE(mtllib);
        const Model model;
        model.write("other.mtl", "newmtl other\nKd 0 0 0\n");
        model.write(file, "newmtl m\nKd 1 0 0\n");
        const GltfScene scene = model.load(mtllib);
        CHECK(scene.materials[1].base_color == Vec4(1, 0, 0, 1));
        const bool misses_one = mtllib.find("none.mtl") == 0;
        CHECK(scene.warnings.size() == (misses_one ? 1 : 0));
    }
}

TEST_CASE("obj material: each missing library is a warning that names it") {
    const Model model;
    const GltfScene scene = model.load("a b.mtl c.mtl");
    REQUIRE(scene.warnings.size() == 2);
    CHECK(scene.warnings[0].find("no such file") != std::string::npos);
    CHECK(scene.warnings[1].find("c.mtl\": no such file") != std::string::npos);
    const GltfScene outside = model.load("../../secret.mtl");
    REQUIRE(outside.warnings.size() == 1);
    CHECK(outside.warnings[0].find("expected a path under the file's own folder") < 200);
}

TEST_CASE("obj material: names have # in them, and comments behind them") {
    const Model model;
    model.write(
        "a.mtl", "newmtl Material #1\nKd 1 0 0\nnewmtl Material #2\nKd 0 1 0\nnewmtl plain # "
                 "old\nKd 0 0 1\n");
    CHECK(model.load("a.mtl", "Material #1").materials[1].base_color == Vec4(1, 0, 0, 1));
    CHECK(model.load("a.mtl", "Material #2").materials[1].base_color == Vec4(0, 1, 0, 1));
    CHECK(model.load("a.mtl", "plain # new").materials[1].base_color == Vec4(0, 0, 1, 1));
    const GltfScene missing = model.load("a.mtl", "none");
    REQUIRE(missing.warnings.size() == 1);
    CHECK(missing.warnings[0].find("usemtl: found \"none\"") != std::string::npos);
}

TEST_CASE("obj material: the color's image is sRGB, scaled and moved from the bottom left") {
    const Model model;
    model.write_image("my wood.png", kRgb);
    const Material material =
        model.material("Kd 0.5 0.5 0.5\nmap_Kd -s 2 4 -o 0.25 0.5 my wood.png\n");
    CHECK(material.base_color == Vec4(0.5f, 0.5f, 0.5f, 1));
    CHECK(material.base_color_texture.scale == Vec2(2, 4));
    // v = 0 of the file is v = 1 here, and both have to become 0.5 from the bottom.
    CHECK(material.base_color_texture.offset == Vec2(0.25f, 1 - 4 - 0.5f));
    CHECK(material.alpha_mode == AlphaMode::Opaque);
    const GltfScene scene = model.load();
    REQUIRE(scene.images.size() == 1);
    CHECK(scene.images[0].srgb);
    CHECK(scene.images[0].pixels[0] == 255);
    // Some programs write black where they write an image.
    CHECK(model.material("Kd 0 0 0\nmap_Kd my wood.png\n").base_color == Vec4(1));
    CHECK(model.material("map_Kd my wood.png\n").base_color == Vec4(1));
}

TEST_CASE("obj material: an image of opacity goes to the alpha of the color") {
    const Model model;
    model.write_image("color.png", kRgb);
    model.write_image("cut.png", {255, 0, 255, 0});
    model.write_image("soft.png", {255, 128, 60, 0});
    model.write_image("both.png", {9, 8, 7, 255, 9, 8, 7, 0, 9, 8, 7, 255, 9, 8, 7, 255});
    CHECK(model.material("map_Kd color.png\nmap_d cut.png\n").alpha_mode == AlphaMode::Mask);
    const GltfScene scene = model.load();
    CHECK(
        texels(scene, scene.materials[1].base_color_texture)
        == std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 0, 0, 0, 255, 255, 10, 20, 30, 0});
    CHECK(model.material("map_d soft.png\n").alpha_mode == AlphaMode::Blend);
    CHECK(model.material("d 0.5\nmap_d cut.png\n").base_color.w == 0.5f);
    CHECK(model.material("map_Kd both.png\nmap_d both.png\n").alpha_mode == AlphaMode::Mask);
    const GltfScene other = model.load();
    CHECK(texels(other, other.materials[1].base_color_texture)[7] == 0);
}

TEST_CASE("obj material: roughness and metalness become one image, of one or of several") {
    const Model model;
    model.write_image("rough.png", {10, 20, 30, 40});
    model.write_image("metal.png", {255, 0, 255, 0});
    model.write_image("packed.png", kRgb);
    const auto packed = [&](const std::string& statements, std::size_t channel) {
        const Material material = model.material(statements);
        CHECK(material.metal_rough_texture.image.index == 0);
        const GltfScene scene = model.load();
        std::vector<int> values;
        for (std::size_t i = channel; i < 16; i += 4) {
            values.push_back(texels(scene, material.metal_rough_texture)[i]);
        }
        return values;
    };
    const std::string two = "map_Pr rough.png\nmap_Pm metal.png\n";
    CHECK(packed(two, 1) == std::vector<int>{10, 20, 30, 40});
    CHECK(packed(two, 2) == std::vector<int>{255, 0, 255, 0});
    CHECK(packed("map_Pm metal.png\n", 1) == std::vector<int>(4, 255));
    const std::string one = "map_Pr packed.png\nmap_Pm packed.png\n";
    CHECK(packed(one, 1) == std::vector<int>{0, 255, 0, 20});
    CHECK(packed(one, 2) == std::vector<int>{0, 0, 255, 30});
    // An image of the exponent: black is as rough as can be, white as Ns.
    const std::vector<int> exponents = packed("Ns 30\nmap_Ns metal.png\n", 1);
    CHECK(exponents == std::vector<int>{128, 255, 128, 255});
    const Material factors = model.material("Pr 0.5\nPm 0\n" + two);
    CHECK(factors.roughness == 0.5f);
    CHECK(factors.metalness == 1);
    const Material plain = model.material("Pr 0.25\nPm 0.75\n");
    CHECK(plain.roughness == 0.25f);
    CHECK(plain.metalness == 0.75f);
}

TEST_CASE("obj material: relief is of normals or of heights, whose slopes face away from them") {
    const Model model;
    model.write_image("normals.png", {128, 128, 255, 128, 128, 255, 128, 128, 255, 128, 128, 255});
    const Material normals = model.material("map_Bump -bm 2 normals.png\n");
    CHECK(normals.normal_scale == 2);
    CHECK(normals.normal_texture.image.index == 0);
    CHECK(model.load().images[0].pixels[2] == 255);
    CHECK_FALSE(model.load().images[0].srgb);
    CHECK(model.material("norm normals.png\nbump none.png\n").normal_scale == 1);

    ImageData heights;
    heights.width = 8;
    heights.height = 8;
    for (int i = 0; i < 64; ++i) {  // a ramp that rises to the right and to the top
        const int value = 20 * (i % 8) + 10 * (7 - i / 8);
        for (const int v : {value, value, value, 255}) {
            heights.pixels.push_back(static_cast<std::uint8_t>(v));
        }
    }
    const ImageData made = normals_of_heights(heights, 10, true);
    const std::uint8_t* const texel = &made.pixels[4 * (3 * 8 + 3)];
    // Slopes of 20 and 10 codes per texel, at 10 times 1 % of 8 texels for 255 codes.
    const double x = 20.0 / 255 * 0.8;
    const double y = 10.0 / 255 * 0.8;
    const double length = std::sqrt(x * x + y * y + 1);
    CHECK(texel[0] == near(127.5 * (1 - x / length)).epsilon(0.01));
    CHECK(texel[1] == near(127.5 * (1 - y / length)).epsilon(0.01));
    CHECK(texel[2] == near(127.5 * (1 + 1 / length)).epsilon(0.01));
}

TEST_CASE("obj material: emission has its image, as bright as Ke says or as white") {
    const Model model;
    model.write_image("glow.png", kRgb);
    CHECK(model.material("Ke 0 0 0\nmap_Ke glow.png\n").emission == Vec3(1));
    const Material bright = model.material("Ke 4 4 4\nmap_Ke glow.png\n");
    CHECK(bright.emission == Vec3(4));
    CHECK(bright.emission_texture.image.index == 0);
    CHECK(model.load().images[0].srgb);
}

TEST_CASE("obj material: a missing or damaged image is a warning, and the material has its color") {
    const Model model;
    model.write("bad.png", "not an image");
    model.write("a.mtl", "newmtl m\nKd 1 0 0\nmap_Kd none.png\nmap_Ke bad.png\n");
    const GltfScene scene = model.load();
    CHECK(scene.materials[1].base_color == Vec4(1, 0, 0, 1));
    CHECK(scene.materials[1].base_color_texture.image.index == kNoAsset);
    CHECK(scene.materials[1].emission == Vec3(0));
    CHECK(scene.images.empty());
    REQUIRE(scene.warnings.size() == 2);
    CHECK(scene.warnings[0].find("a.mtl:3: map_Kd: \"none.png\": no such file") < 80);
    CHECK(scene.warnings[1].find("a.mtl:4: map_Ke: bad.png: found 12 bytes in an unknown") < 80);
}

TEST_CASE("obj material: images stand beside their library or the model, in any case of letters") {
    for (const auto& [file, name] : std::vector<std::pair<std::string, std::string>>{
             {"wood.png", "wood.png"},
             {"lib/wood.png", "wood.png"},
             {"lib/textures/wood.png", "textures\\\\wood.png"},
             {"wood.png", "D:\\work\\wood.png"},
             {"wood.png", "/home/someone/wood.png"},
             {"Wood.PNG", "wood.png"}}) {
        const std::string& named = name;
        CAPTURE(named);
        const Model model;
        model.write_image(file, kRgb);
        model.write("lib/a.mtl", "newmtl m\nmap_Kd " + named + "\n");
        const GltfScene scene = model.load("lib/a.mtl");
        CHECK(scene.images.size() == 1);
        CHECK(scene.warnings.empty());
    }
}

TEST_CASE("obj material: a model's images are limited in all, and shared between materials") {
    const Model model;
    model.write_image("a.png", kRgb);
    model.write_image("b.png", kRgb);
    model.write("a.mtl", "newmtl m\nmap_Kd a.png\nnewmtl n\nmap_Kd a.png\nmap_Ke b.png\n");
    model.write(
        "a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\nusemtl n\nf 1 2 3\n");
    ObjLimits limits;
    const Result<GltfScene> scene = load_obj_scene(model.folder.file("a.obj"), limits);
    REQUIRE(scene.ok());
    CHECK(scene->images.size() == 2);
    limits.max_pixels = 7;
    static_cast<void>(test::messages_of([&] {
        const Result<GltfScene> limited = load_obj_scene(model.folder.file("a.obj"), limits);
        REQUIRE(limited.ok());
        CHECK(limited->images.size() == 1);
        CHECK(limited->warnings.size() == 1);
    }));
}

}  // namespace limn::obj_material_test
