#include "content/load/files/atomic_file.h"
#include "content/load/files/png_check.h"
#include "content/load/files/png_file.h"
#include "content/load/gltf/gltf_load.h"
#include "tests/content/gltf_samples.h"
#include "tests/support.h"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

namespace limn::gltf_bad_input_test {

using namespace limn::test;

namespace {

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// One edit of the square and what the message must say.
struct Spoiled {
    std::string from;
    std::string to;
    std::string expected;
};

void check_refused(const Result<GltfScene>& scene, const std::string& expected) {
    CAPTURE(expected);
    REQUIRE_FALSE(scene.ok());
    const std::string& message = scene.error().message;
    CAPTURE(message);
    CHECK(contains(message, expected));
    CHECK(contains(message, "square."));  // the file
    CHECK_FALSE(contains(message, "\n"));
    CHECK(message.size() < 600);
}

void check_all_refused(const std::vector<Spoiled>& cases) {
    for (const Spoiled& spoiled : cases) {
        CAPTURE(spoiled.to);
        const std::string json = replace_once(kSquareJson, spoiled.from, spoiled.to);
        check_refused(
            parse_gltf(make_glb(json, square_binary()), "square.glb", ""), spoiled.expected);
    }
}

/// The square as a .gltf in `folder`, with `uri` for its buffer.
std::string write_gltf(const TemporaryFolder& folder, const std::string& uri) {
    const std::string json = replace_once(
        kSquareJson, R"({"byteLength": 92})", R"({"byteLength": 92, "uri": ")" + uri + "\"}");
    REQUIRE(write_file(folder.file("square.gltf"), json).ok());
    return folder.file("square.gltf");
}

/// The square with a base color from the image `uri`.
std::string textured_json(const std::string& image) {
    return replace_once(
        kSquareJson, R"({"name": "paint"}])",
        R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
           "textures": [{"source": 0}], "images": [)"
            + image + "]");
}

/// What is drawn of the square, with a warning for each edit.
void check_square(const Result<GltfScene>& scene, const std::string& expected, std::size_t count) {
    REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
    REQUIRE(scene->meshes.size() == 1);
    CHECK(scene->meshes[0].positions.size() == 4);
    CHECK(scene->meshes[0].normals[0] == Vec3(0, 0, 1));
    CHECK(scene->nodes.size() == 2);
    REQUIRE(!scene->warnings.empty());
    CHECK_MESSAGE(scene->warnings.size() == count, scene->warnings[0]);
    CHECK_MESSAGE(contains(scene->warnings[0], "square.glb: " + expected), scene->warnings[0]);
    CHECK_FALSE(contains(scene->warnings[0], "\n"));
}

void check_all_drawn(const std::vector<Spoiled>& cases, std::size_t count = 1) {
    for (const Spoiled& spoiled : cases) {
        CAPTURE(spoiled.to);
        const std::string json = replace_once(kSquareJson, spoiled.from, spoiled.to);
        check_square(
            parse_gltf(make_glb(json, square_binary()), "square.glb", ""), spoiled.expected, count);
    }
}

}  // namespace

TEST_CASE("gltf: the square that the other tests spoil is fine") {
    const Result<GltfScene> scene = parse_gltf(square_glb(), "square.glb", "");
    REQUIRE(scene.ok());
    CHECK(scene->nodes.size() == 2);
    CHECK(scene->warnings.empty());
}

TEST_CASE("gltf: a bad part of a material, camera or light costs that part") {
    check_all_drawn({
        {R"("name": "paint")", R"("name": 7)",
         "materials[0].name: found the number 7, expected a string; it is left out"},
        {R"("name": "paint")", R"("pbrMetallicRoughness": {"metallicFactor": 2})",
         "materials[0].pbrMetallicRoughness.metallicFactor: found the number 2, expected a number "
         "from 0 to 1; it is clamped"},
        {R"("name": "paint")", R"("pbrMetallicRoughness": {"baseColorFactor": [0, 1.5, 0, 1]})",
         "materials[0].pbrMetallicRoughness.baseColorFactor[1]: found the number 1.5, expected a "
         "number from 0 to 1; it is clamped"},
        {R"("name": "paint")", R"("pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1]})",
         "materials[0].pbrMetallicRoughness.baseColorFactor: found an array of 3, expected 4 "
         "numbers from 0 to 1; it is left out"},
        {R"("name": "paint")", R"("pbrMetallicRoughness": [])",
         "materials[0].pbrMetallicRoughness: found an array of 0, expected an object; it is left"},
        {R"("name": "paint")", R"("alphaMode": "GLASS")",
         "materials[0].alphaMode: found the string \"GLASS\", expected one of OPAQUE MASK BLEND"},
        {R"("name": "paint")", R"("extensions": {"KHR_materials_ior": {"ior": "glass"}})",
         "materials[0].extensions.KHR_materials_ior.ior: found the string \"glass\""},
        {R"("name": "paint")", R"("normalTexture": {"index": 0})",
         "materials[0].normalTexture.index: found the number 0, expected no index, since there are "
         "no textures; materials[0].normalTexture is left out"},
        {R"("name": "paint")", R"("normalTexture": {})",
         "materials[0].normalTexture.index: found nothing, expected no index, since there are no "
         "textures; materials[0].normalTexture is left out"},
        {R"("material": 0)", R"("material": 1)",
         "meshes[0].primitives[0].material: found the number 1, expected an index below 1; it is "
         "left out"},
        {R"([{"name": "paint"}])", R"([7])",
         "materials[0]: found the number 7, expected an object; it is left out"},
        {R"("mesh": 0)", R"("mesh": 0, "camera": 0)",
         "nodes[1].camera: found the number 0, expected no index, since there are no cameras"},
        {R"("mesh": 0)", R"("mesh": 0, "extensions": {"KHR_lights_punctual": {"light": 0}})",
         "nodes[1].extensions.KHR_lights_punctual.light: found the number 0, expected no index, "
         "since there are no extensions.KHR_lights_punctual.lights; "
         "nodes[1].extensions.KHR_lights_punctual is left out"},
        {R"("mesh": 0, "translation": [1, 2, 3]})",
         R"("mesh": 0, "camera": 0}], "cameras": [{"type": "perspective"})",
         "cameras[0].perspective: found nothing, expected an object; cameras[0] is left out"},
        {R"("mesh": 0, "translation": [1, 2, 3]})",
         R"("mesh": 0, "camera": 0}], "cameras": [{"type": "perspective",
            "perspective": {"yfov": 0, "znear": 1}})",
         "cameras[0].perspective.yfov: found the number 0, expected a number from 1e-06 to "
         "3.1415928; cameras[0] is left out"},
        {R"("mesh": 0, "translation": [1, 2, 3]})",
         R"("mesh": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}}],
            "extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot"}]}}, "x": [{})",
         "extensions.KHR_lights_punctual.lights[0].spot: found nothing, expected an object; "
         "extensions.KHR_lights_punctual.lights[0] is left out"},
    });
}

TEST_CASE("gltf: a texture whose image or sampler is bad costs that, in all materials") {
    const auto with = [](const std::string& textures) {
        return Spoiled{
            R"({"name": "paint"}])",
            R"({"normalTexture": {"index": 0}}, {"emissiveTexture": {"index": 0}}], )" + textures,
            ""};
    };
    const std::pair<std::string, std::string> cases[] = {
        {R"("textures": [{"source": 5}])",
         "textures[0].source: found the number 5, expected no index, since there are no images; "
         "textures[0] is left out"},
        {R"("textures": [{"source": 0}], "images": [{"bufferView": 11}])",
         "images[0].bufferView: found the number 11, expected an index below 4; images[0] is left "
         "out"},
        {R"("textures": 7)", "textures: found the number 7, expected an array; it is left out"},
    };
    for (const auto& [members, expected] : cases) {
        const auto& textures = members;  // a binding cannot be captured
        const Spoiled spoiled = with(textures);
        const std::string json = replace_once(kSquareJson, spoiled.from, spoiled.to);
        const Result<GltfScene> scene =
            parse_gltf(make_glb(json, square_binary()), "square.glb", "");
        CAPTURE(textures);
        check_square(scene, expected, contains(expected, "textures: ") ? 3 : 1);
        CHECK(scene->materials[0].normal_texture.image.index == kNoAsset);
        CHECK(scene->materials[1].emission_texture.image.index == kNoAsset);
    }
}

TEST_CASE("gltf: empty lists and bad parts that nothing needs are left out") {
    const std::string end = R"("values": {"bufferView": 3}}})";
    const std::string triangle = R"("indices": 1, "material": 0}]})";
    check_all_drawn({
        {R"("scene": 0)", R"("scene": 0, "animations": [{"channels": [], "samplers": []}])",
         "animations[0].channels: found an array of 0, expected an array of at least 1; "
         "animations[0] is left out"},
        {R"("scene": 0)", R"("scene": 0, "animations": [{}])",
         "animations[0].channels: found nothing"},
        {R"("scene": 0)", R"("scene": 0, "animations": 7)", "animations: found the number 7"},
        {R"("scene": 0)", R"("scene": 0, "extensionsUsed": 7)", "extensionsUsed: found"},
        {R"("scene": 0)", R"("scene": 0, "skins": [{"joints": []}])",
         "skins[0].joints: found an array of 0, expected an array of at least 1; skins[0] is left"},
        {R"("scene": 0)", R"("scene": 0, "skins": [{"joints": [9]}])",
         "skins[0].joints[0]: found the number 9, expected an index below 2; skins[0] is left out"},
        {R"("mesh": 0, "translation": [1, 2, 3]})",
         R"("mesh": 0, "skin": 0}], "skins": [{"joints": []})",
         "skins[0].joints: found an array of 0"},
        {R"("mesh": 0)", R"("mesh": 0, "skin": 4)", "nodes[1].skin: found the number 4"},
        {triangle, triangle + R"(, {"primitives": []})",
         "meshes[1].primitives: found an array of 0, expected an array of at least 1; it is left"},
        {triangle, triangle + ", {}", "meshes[1].primitives: found nothing"},
        {triangle, triangle + R"(, {"primitives": [{"attributes": {"POSITION": 99}}]})",
         "meshes[1].primitives[0].attributes.POSITION: found the number 99, expected an index "
         "below 3; meshes[1] is left out"},
        {triangle, triangle + R"(, {"primitives": [{"attributes": {"POSITION": 1}}]})",
         "meshes[1].primitives[0].attributes.POSITION: accessors[1].type: found 1 components"},
        {R"("translation": [1, 2, 3]})", R"("translation": [1, 2, 3]}, {"mesh": 7})",
         "nodes[2].mesh: found the number 7, expected an index below 1; nodes[2] is left out"},
        {R"([{"nodes": [0]}])", R"([{"nodes": [0]}, {"nodes": [8]}])",
         "scenes[1].nodes[0]: found the number 8, expected an index below 2; scenes[1] is left"},
        {end, end + R"(, {"componentType": 5126, "count": 0, "type": "VEC3"})",
         "accessors[3].count: found 0, expected at least 1"},
        {end, end + R"(, {"bufferView": 50, "componentType": 5126, "count": 1, "type": "VEC3"})",
         "accessors[3].bufferView: found the number 50"},
        {R"("byteOffset": 68, "byteLength": 24})",
         R"("byteOffset": 68, "byteLength": 24}, {"buffer": 0, "byteLength": 93})",
         "bufferViews[4]: found 93 bytes from byte 0, expected to stay within the 92 of "
         "buffers[0]; "
         "it is left out"},
        {R"("byteOffset": 68, "byteLength": 24})",
         R"("byteOffset": 68, "byteLength": 24}, {"buffer": 3, "byteLength": 1})",
         "bufferViews[4].buffer: found the number 3"},
    });
}

TEST_CASE("gltf: a bad attribute counts as missing, a bad position does not") {
    check_all_drawn({
        {R"({"POSITION": 0})", R"({"POSITION": 0, "NORMAL": 1})",
         "meshes[0].primitives[0].attributes.NORMAL: accessors[1].type: found 1 components per "
         "element, expected 3; it is left out"},
        {R"({"POSITION": 0})", R"({"POSITION": 0, "NORMAL": 9})",
         "meshes[0].primitives[0].attributes.NORMAL: found the number 9, expected an index below "
         "3; it is left out"},
        {R"({"POSITION": 0})", R"({"POSITION": 0, "TANGENT": "x"})",
         "meshes[0].primitives[0].attributes.TANGENT: found the string"},
        {R"({"POSITION": 0})", R"({"POSITION": 0, "TEXCOORD_0": 0})",
         "meshes[0].primitives[0].attributes.TEXCOORD_0: accessors[0].type"},
        {R"("indices": 1)", R"("indices": 1, "targets": [{"POSITION": 1}])",
         "meshes[0].primitives[0].targets[0].POSITION: accessors[1].type"},
        {R"("indices": 1)", R"("indices": 1, "targets": [{"POSITION": 33}])",
         "meshes[0].primitives[0].targets[0].POSITION: found the number 33"},
    });
}

TEST_CASE("gltf: a primitive without vertices, indices or whole triangles is told and not drawn") {
    const std::pair<std::string, std::string> cases[] = {
        {R"({"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
        {"bufferView": 1)",
         R"({"bufferView": 0, "componentType": 5126, "count": 0, "type": "VEC3"},
        {"bufferView": 1)"},
        {R"("componentType": 5123, "count": 6)", R"("componentType": 5123, "count": 0)"},
        {R"("primitives": [
        {"attributes": {"POSITION": 0}, "indices": 1, "material": 0}])",
         R"("primitives": [])"},
    };
    for (const auto& [from, edited] : cases) {
        const auto& to = edited;  // a binding cannot be captured
        CAPTURE(to);
        const std::string json = replace_once(kSquareJson, from, to);
        const Result<GltfScene> scene =
            parse_gltf(make_glb(json, square_binary()), "square.glb", "");
        REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
        CHECK(scene->meshes.empty());
        CHECK(!scene->warnings.empty());
    }
    const std::string json = replace_once(
        kSquareJson, R"("componentType": 5123, "count": 6)",
        R"("componentType": 5123, "count": 5)");
    const Result<GltfScene> scene = parse_gltf(make_glb(json, square_binary()), "square.glb", "");
    REQUIRE(scene.ok());
    CHECK(scene->meshes[0].indices.size() == 3);
    CHECK(contains(scene->warnings[0], "found 5 indices, expected a multiple of 3"));
}

TEST_CASE("gltf: a root that is there twice or has a parent is drawn once") {
    check_all_drawn({
        {R"([{"nodes": [0]}])", R"([{"nodes": [0, 0]}])",
         "scenes[0].nodes: found node 0, which is listed already, expected each root once"},
        {R"([{"nodes": [0]}])", R"([{"nodes": [0, 1]}])",
         "scenes[0].nodes: found node 1, which is listed already, expected each root once"},
        {R"([{"nodes": [0]}])", R"([{"nodes": [1, 0]}])",
         "scenes[0].nodes: found node 1, which has a parent, expected each root once"},
        {R"("children": [1])", R"("children": [1, 1])",
         "nodes[0].children: found node 1 twice, expected it once"},
    });
    // Its parent is not in the scene: it is a root.
    const std::string json =
        replace_once(kSquareJson, R"([{"nodes": [0]}])", R"([{"nodes": [1]}])");
    const Result<GltfScene> scene = parse_gltf(make_glb(json, square_binary()), "square.glb", "");
    REQUIRE(scene.ok());
    REQUIRE(scene->nodes.size() == 1);
    CHECK(scene->nodes[0].parent == -1);
    CHECK(scene->nodes[0].parts.size() == 1);
    CHECK(scene->warnings.size() == 1);
}

TEST_CASE("gltf: factors and matrices that are off by rounding are as meant, without a warning") {
    const std::string json = replace_once(
        replace_once(
            kSquareJson, R"("name": "paint")",
            R"("pbrMetallicRoughness": {"baseColorFactor": [1.0000001, 0.5, -0.000001, 1],
               "metallicFactor": 1.000001, "roughnessFactor": -0.000001},
               "emissiveFactor": [1.000001, 0, 0], "occlusionTexture": {"index": 0, "strength": 1.000009}}],
               "textures": [{}], "x": [{)"),
        R"("translation": [1, 2, 3])",
        R"("matrix": [1,0,0,0.000001, 0,1,0,0, 0,0,1,0, 1,2,3,1.000001])");
    const Result<GltfScene> scene = parse_gltf(make_glb(json, square_binary()), "square.glb", "");
    REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
    REQUIRE(scene->warnings.size() == 1);
    CHECK(contains(scene->warnings[0], "textures[0] has no image"));
    const Material& material = scene->materials[0];
    CHECK(material.base_color == Vec4(1, 0.5f, 0, 1));
    CHECK(material.metalness == 1);
    CHECK(material.roughness == 0);
    CHECK(material.occlusion_strength == 1);
    CHECK(scene->nodes[1].transform.position == Vec3(1, 2, 3));
}

TEST_CASE("gltf: an emissive factor above 1 is used as it is, with a warning") {
    const std::string json =
        replace_once(kSquareJson, R"("name": "paint")", R"("emissiveFactor": [0, 1.5, 0.75])");
    const Result<GltfScene> scene = parse_gltf(make_glb(json, square_binary()), "square.glb", "");
    check_square(
        scene, "materials[0].emissiveFactor: found 1.5, expected at most 1; it is used as it is",
        1);
    CHECK(scene->materials[0].emission == Vec3(0, 1.5f, 0.75f));
}

TEST_CASE("gltf: a rotation of length 0 is none") {
    check_all_drawn(
        {{R"("translation": [1, 2, 3])", R"("rotation": [0, 0, 0, 0])",
          "nodes[1].rotation: found a quaternion of length 0, expected 1"}});
}

TEST_CASE("gltf: the reports of factors, empty lists and images show what they should") {
    const auto load = [](const std::string& file, std::vector<std::string> warnings) {
        const std::optional<std::string> path = shared_report(file);
        if (!path) {
            return GltfScene{};
        }
        CAPTURE(file);
        const Result<GltfScene> scene = load_gltf(*path);
        REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
        REQUIRE(scene->warnings.size() == warnings.size());
        for (std::size_t i = 0; i < warnings.size(); ++i) {
            CHECK_MESSAGE(contains(scene->warnings[i], warnings[i]), scene->warnings[i]);
        }
        CHECK(scene->meshes.size() == 1);
        CHECK(scene->meshes[0].indices.size() == 6);
        CHECK(scene->nodes.size() == 2);
        CHECK(scene->clips.empty());
        CHECK(load_gltf(*path, {}, {.strict = true}).ok() == warnings.empty());
        return *scene;
    };
    if (!shared_report("02-factor-above-one")) {
        return;
    }
    CHECK(
        load("02-factor-above-one/emissive.gltf", {"materials[0].emissiveFactor: found 1.5"})
            .materials[0]
            .emission
        == Vec3(1.5f, 0.75f, 0));
    CHECK(
        load("02-factor-above-one/emissive-one.gltf", {}).materials[0].emission
        == Vec3(1, 0.5f, 0));
    const Material rounded = load("02-factor-above-one/rounded.gltf", {}).materials[0];
    CHECK(rounded.base_color == Vec4(1, 0.5f, 0.25f, 1));
    CHECK(rounded.roughness == 1);

    load("03-empty-arrays/plain.gltf", {});
    load("03-empty-arrays/empty-lists.gltf", {});
    load("03-empty-arrays/count-zero.gltf", {"accessors[4].count: found 0"});
    load("03-empty-arrays/no-channels.gltf", {"animations[0].channels: found an array of 0"});
    load("03-empty-arrays/no-joints.gltf", {"skins[0].joints: found an array of 0"});
    load("03-empty-arrays/no-primitives.gltf", {"meshes[1].primitives: found an array of 0"});

    const std::string folder = "12-missing-texture/";
    for (const auto& [file, warning] : std::vector<std::pair<std::string, std::string>>{
             {"missing.gltf", "images[0].uri: \"not_here.png\": no such file"},
             {"cut.gltf", "images[0] (cut.png): "},
             {"empty.gltf", "images[0] (empty.png): found an empty file"},
             {"ktx2.gltf", "images[0] (ktx2.png): found 92 bytes in an unknown format"},
             {"dotdot.gltf", "found \"..\" in \"../12-missing-texture/ok.png\""}}) {
        const GltfScene scene = load(folder + file, {warning});
        CHECK(scene.images.empty());
        CHECK(scene.materials[0].base_color_texture.image.index == kNoAsset);
    }
    const GltfScene good = load(folder + "ok.gltf", {});
    const GltfScene slash = load(folder + "slash.gltf", {});
    const GltfScene backslash =
        load(folder + "backslash.gltf", {"images[0].uri: found \".\\\\ok.png\""});
    for (const GltfScene* scene : {&good, &slash, &backslash}) {
        REQUIRE(scene->images.size() == 1);
        CHECK(scene->images[0].pixels == good.images[0].pixels);
    }
}

TEST_CASE("gltf: what is no file of glTF is refused") {
    const TemporaryFolder folder;
    CHECK(contains(load_gltf(folder.file("no.glb")).error().message, "no such file"));
    CHECK(contains(load_gltf(folder.path()).error().message, "found a folder"));
    REQUIRE(write_file(folder.file("square.glb"), std::string()).ok());
    check_refused(load_gltf(folder.file("square.glb")), "empty file");
    REQUIRE(write_file(folder.file("square.gltf"), std::string("[1, 2")).ok());
    check_refused(load_gltf(folder.file("square.gltf")), "square.gltf:1:");
    REQUIRE(write_file(folder.file("square.gltf"), std::string("[]")).ok());
    check_refused(load_gltf(folder.file("square.gltf")), "expected an object");
    REQUIRE(write_file(folder.file("square.gltf"), std::string("{}")).ok());
    check_refused(load_gltf(folder.file("square.gltf")), "asset");
    check_refused(load_gltf("/dev/null/square.glb"), "cannot be read");
}

TEST_CASE("gltf: a GLB cut short anywhere is refused") {
    const std::vector<std::byte> glb = square_glb();
    for (std::size_t size = 0; size < glb.size(); ++size) {
        CHECK_FALSE(parse_gltf(std::span(glb).first(size), "square.glb", "").ok());
    }
}

TEST_CASE("gltf: a GLB whose lengths disagree is refused") {
    const std::vector<std::byte> good = square_glb();
    const auto with = [&good](std::size_t at, std::uint32_t value) {
        std::vector<std::byte> bad = good;
        std::memcpy(bad.data() + at, &value, 4);
        return bad;
    };
    const auto size = static_cast<std::uint32_t>(good.size());
    check_refused(parse_gltf(with(8, size - 4), "square.glb", ""), "left in the file");
    check_refused(parse_gltf(with(8, size + 4), "square.glb", ""), "as in the GLB header");
    check_refused(parse_gltf(with(4, 1), "square.glb", ""), "version 1");
    check_refused(parse_gltf(with(12, 0xffffffffu), "square.glb", ""), "a GLB chunk of 4294967295");
    check_refused(parse_gltf(with(12, 12), "square.glb", ""), "square.glb");
    check_refused(
        parse_gltf(with(16, 0x12345678), "square.glb", ""), "expected JSON as the first chunk");
}

TEST_CASE("gltf: every change of one byte loads or is refused, and no more") {
    const std::vector<std::byte> good = square_glb();
    for (std::size_t i = 0; i < good.size(); ++i) {
        for (const unsigned flip : {0x01u, 0x10u, 0x80u}) {
            std::vector<std::byte> bad = good;
            bad[i] ^= static_cast<std::byte>(flip);
            const Result<GltfScene> scene = parse_gltf(bad, "square.glb", "");
            if (!scene) {
                CHECK_FALSE(contains(scene.error().message, "\n"));
            }
        }
    }
}

TEST_CASE("gltf: values that are drawn and of a wrong type or range are refused") {
    check_all_refused({
        {R"("version": "2.0")", R"("version": "1.0")",
         "asset.version: found \"1.0\", expected 2.x"},
        {R"("version": "2.0")", R"("version": 2)",
         "asset.version: found the number 2, expected a string"},
        {R"("asset": {"version": "2.0"},)", "", "asset: found nothing, expected an object"},
        {R"("translation": [1, 2, 3])", R"("translation": [1, 2, 1e40])", "nodes[1].translation"},
        {R"("translation": [1, 2, 3])", R"("translation": [1, 2])", "nodes[1].translation"},
        {R"("translation": [1, 2, 3])", R"("matrix": [1,0,0,1, 0,1,0,0, 0,0,1,0, 0,0,0,1])",
         "nodes[1].matrix"},
        {R"("mesh": 0)", R"("mesh": 1)",
         "nodes[1].mesh: found the number 1, expected an index below 1"},
        {R"("mesh": 0)", R"("mesh": -1)", "nodes[1].mesh"},
        {R"("mesh": 0)", R"("mesh": 0.5)", "nodes[1].mesh"},
        {R"("mesh": 0)", R"("mesh": 99999999999999999999)", "nodes[1].mesh"},
        {R"("mesh": 0)", R"("mesh": 4294967296)", "nodes[1].mesh"},
        {R"("scene": 0)", R"("scene": 3)", "scene: found the number 3"},
        {R"("material": 0)", R"("mode": 7)", "meshes[0].primitives[0].mode"},
        {R"("scene": 0)", R"("extensionsRequired": ["KHR_draco_mesh_compression"])",
         "extensionsRequired: found \"KHR_draco_mesh_compression\" (decompress with "
         "`gltf-transform copy in.glb out.glb`), expected"},
    });
}

TEST_CASE("gltf: an accessor that is drawn and out of bounds is refused") {
    const std::string view = R"({"buffer": 0, "byteOffset": 0, "byteLength": 48})";
    const std::string accessor =
        R"({"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"})";
    check_all_refused({
        {R"("byteLength": 92)", R"("byteLength": 1000)",
         "buffers[0].byteLength: found 1000, expected at most the 92"},
        {view, R"({"buffer": 0, "byteOffset": 80, "byteLength": 48})",
         "bufferViews[0]: found 48 bytes from byte 80"},
        {view, R"({"buffer": 0, "byteOffset": 9007199254740991, "byteLength": 48})",
         "bufferViews[0]"},
        {view, R"({"buffer": 0, "byteOffset": 18446744073709551600, "byteLength": 48})",
         "bufferViews[0].byteOffset"},
        {view, R"({"buffer": 1, "byteOffset": 0, "byteLength": 48})", "bufferViews[0].buffer"},
        {view, R"({"buffer": 0, "byteOffset": 0, "byteLength": 0})", "bufferViews[0].byteLength"},
        {view, R"({"buffer": 0, "byteLength": 48, "byteStride": 8})", "found a stride of 8"},
        {view, R"({"buffer": 0, "byteLength": 48, "byteStride": 16})",
         "elements that end at byte 60, expected to stay within the 48"},
        {accessor, R"({"bufferView": 0, "componentType": 5126, "count": 5, "type": "VEC3"})",
         "found 5 elements that end at byte 60"},
        {accessor,
         R"({"bufferView": 0, "componentType": 5126, "count": 4294967295, "type": "VEC3"})",
         "accessors[0]"},
        {accessor, R"({"bufferView": 0, "componentType": 5126, "count": 89478485, "type": "VEC3"})",
         "accessors[0]: found 89478485 elements"},
        {accessor,
         R"({"bufferView": 0, "byteOffset": 4, "componentType": 5126, "count": 4, "type": "VEC3"})",
         "end at byte 52"},
        {accessor,
         R"({"bufferView": 0, "byteOffset": 9007199254740990, "componentType": 5126, "count": 4, "type": "VEC3"})",
         "accessors[0]"},
        {accessor, R"({"bufferView": 7, "componentType": 5126, "count": 4, "type": "VEC3"})",
         "accessors[0].bufferView"},
        {accessor, R"({"bufferView": 0, "componentType": 5124, "count": 4, "type": "VEC3"})",
         "accessors[0].componentType: found the number 5124"},
        {accessor, R"({"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC7"})",
         "accessors[0].type: found the string \"VEC7\""},
        {accessor, R"({"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC2"})",
         "found 2 components per element, expected 3"},
        {accessor, R"({"componentType": 5126, "count": 80000000, "type": "VEC3",
             "sparse": {"count": 1, "indices": {"bufferView": 2, "componentType": 5121},
                        "values": {"bufferView": 3}}})",
         "without a bufferView"},
        {R"("indices": 1)", R"("indices": 0)", "meshes[0].primitives[0].indices: accessors[0]"},
        {R"("indices": 1)", R"("indices": 9)", "meshes[0].primitives[0].indices"},
        {R"({"POSITION": 0})", R"({"POSITION": 9})", "meshes[0].primitives[0].attributes.POSITION"},
    });
}

TEST_CASE("gltf: abused sparse accessors are refused") {
    const std::string uses_sparse =
        replace_once(kSquareJson, R"({"POSITION": 0})", R"({"POSITION": 2})");
    const std::string indices = R"({"bufferView": 2, "componentType": 5121})";
    const auto refused = [&](const std::string& from, const std::string& to,
                             const std::string& expected) {
        CAPTURE(to);
        check_refused(
            parse_gltf(
                make_glb(replace_once(uses_sparse, from, to), square_binary()), "square.glb", ""),
            expected);
    };
    REQUIRE(parse_gltf(make_glb(uses_sparse, square_binary()), "square.glb", "").ok());
    refused(
        R"("sparse": {"count": 2)", R"("sparse": {"count": 5)",
        "sparse.count: found 5, expected at most 4");
    refused(
        R"("sparse": {"count": 2)", R"("sparse": {"count": 3)", "sparse.indices: found 3 elements");
    refused(R"("sparse": {"count": 2)", R"("sparse": {"count": -2)", "sparse.count");
    refused(R"("sparse": {"count": 2, )", R"("sparse": {)", "sparse.count: found nothing");
    refused(indices, R"({"bufferView": 2, "componentType": 5123})", "sparse.indices");
    refused(indices, R"({"bufferView": 2, "componentType": 5122})", "sparse.indices.componentType");
    refused(
        indices, R"({"bufferView": 2, "byteOffset": 1, "componentType": 5121})", "end at byte 3");
    refused(
        indices, R"({"bufferView": 2, "byteOffset": 2147483647, "componentType": 5121})",
        "sparse.indices");
    refused(indices, R"({"bufferView": 8, "componentType": 5121})", "sparse.indices.bufferView");
    refused(R"({"bufferView": 3})", R"({"bufferView": 1})", "sparse.values");
    refused(R"({"bufferView": 3})", R"({"bufferView": 3, "byteOffset": 4})", "sparse.values");

    const auto with_indices = [&](std::uint8_t a, std::uint8_t b) {
        std::vector<std::byte> binary = square_binary();
        binary[64] = std::byte{a};
        binary[65] = std::byte{b};
        return parse_gltf(make_glb(uses_sparse, binary), "square.glb", "");
    };
    check_refused(with_indices(1, 4), "sparse.indices: found 4 at 1, expected an index below 4");
    check_refused(with_indices(3, 1), "expected increasing indices");
    check_refused(with_indices(2, 2), "expected increasing indices");
}

TEST_CASE("gltf: an index past the vertices is refused") {
    std::vector<std::byte> binary = square_binary();
    binary[48 + 2 * 4] = std::byte{4};
    check_refused(
        parse_gltf(make_glb(kSquareJson, binary), "square.glb", ""),
        "meshes[0].primitives[0].indices: found 4 at 4, expected an index below the 4 vertices");
}

TEST_CASE("gltf: a position that is absurd is refused, and harmless where nothing uses it") {
    std::vector<std::byte> binary = square_binary();
    const float far = 1e30f;
    std::memcpy(&binary[12], &far, 4);
    check_refused(
        parse_gltf(make_glb(kSquareJson, binary), "square.glb", ""),
        "meshes[0].primitives[0].attributes.POSITION: found 1e+30 in element 1");
    std::memset(&binary[48], 0, 6);  // the first triangle
    const Result<GltfScene> scene = parse_gltf(make_glb(kSquareJson, binary), "square.glb", "");
    REQUIRE(scene.ok());
    CHECK(scene->meshes[0].bounds.max == Vec3(1, 1, 0));
}

TEST_CASE("gltf: a position that is not finite costs the triangles that use it") {
    for (const float bad : {std::nanf(""), INFINITY, -INFINITY}) {
        std::vector<std::byte> binary = square_binary();
        std::memcpy(&binary[12], &bad, 4);
        const Result<GltfScene> scene = parse_gltf(make_glb(kSquareJson, binary), "square.glb", "");
        REQUIRE(scene.ok());
        REQUIRE(scene->warnings.size() == 1);
        CHECK(contains(
            scene->warnings[0],
            "square.glb: meshes[0].primitives[0].attributes.POSITION: found ("));
        CHECK(contains(scene->warnings[0], "in element 1, expected finite numbers"));
        CHECK(scene->meshes[0].indices.size() == 3);
        CHECK(scene->meshes[0].positions.size() == 3);
        CHECK(scene->meshes[0].bounds.max == Vec3(1, 1, 0));

        std::memset(&binary[48], 0, 6);  // now nothing uses it
        const Result<GltfScene> unused =
            parse_gltf(make_glb(kSquareJson, binary), "square.glb", "");
        REQUIRE(unused.ok());
        CHECK(unused->warnings.empty());
        CHECK(unused->meshes[0].bounds.max == Vec3(1, 1, 0));
    }
}

TEST_CASE("gltf: points and lines at positions that are not finite are left out") {
    // Of 0 1 2 0 2 3 without what has 1: points of 8 triangles, lines of 6.
    for (const auto& [mode, triangles] : {std::pair("0", 5 * 8), std::pair("3", 3 * 6)}) {
        const float bad = std::nanf("");
        std::vector<std::byte> binary = square_binary();
        std::memcpy(&binary[12], &bad, 4);
        const std::string json =
            replace_once(kSquareJson, R"("material": 0)", std::string(R"("mode": )") + mode);
        const Result<GltfScene> scene = parse_gltf(make_glb(json, binary), "square.glb", "");
        REQUIRE(scene.ok());
        REQUIRE(scene->warnings.size() == 1);
        CHECK(is_finite(scene->meshes[0].bounds.max));
        CHECK(scene->meshes[0].indices.size() == static_cast<std::size_t>(3 * triangles));
    }
}

TEST_CASE("gltf: node graphs that are no trees are refused") {
    check_all_refused({
        {R"({"name": "leaf",)", R"({"children": [0],)", "is its own ancestor"},
        {R"("children": [1])", R"("children": [0])", "is its own ancestor"},
        {R"("translation": [1, 2, 3]})", R"("translation": [1, 2, 3]}, {"children": [1]})",
         "nodes[2].children: found node 1, which is a child of nodes[0] already"},
        {R"("children": [1])", R"("children": [2])", "nodes[0].children[0]: found the number 2"},
    });
    // A cycle off to the side of the scene is refused as well.
    const std::string loop = replace_once(
        kSquareJson, R"("translation": [1, 2, 3]})",
        R"("translation": [1, 2, 3]}, {"children": [3]}, {"children": [2]})");
    check_refused(
        parse_gltf(make_glb(loop, square_binary()), "square.glb", ""), "nodes[2].children");
}

TEST_CASE("gltf: a very deep node graph is refused without a recursion") {
    std::string nodes;
    for (int i = 0; i < 100'000; ++i) {
        nodes += R"({"children": [)" + std::to_string(i + 1) + "]},";
    }
    const std::string json = R"({"asset": {"version": "2.0"}, "nodes": [)" + nodes
                             + R"({}], "scenes": [{"nodes": [0]}]})";
    check_refused(
        parse_gltf(std::as_bytes(std::span(json)), "square.gltf", ""),
        "found a hierarchy deeper than 256 nodes");
    const std::string brackets =
        R"({"asset": {"version": "2.0"}, "extras": )" + std::string(100'000, '[');
    CHECK_FALSE(parse_gltf(std::as_bytes(std::span(brackets)), "square.gltf", "").ok());
}

TEST_CASE("gltf: a file may name only files under its own folder") {
    const TemporaryFolder outside;
    REQUIRE(write_file(outside.file("secret.bin"), square_binary()).ok());
    const TemporaryFolder folder;
    REQUIRE(write_file(folder.file("good name.bin"), square_binary()).ok());
    std::filesystem::create_directory(folder.file("sub"));
    std::filesystem::create_symlink(outside.file("secret.bin"), folder.file("link.bin"));

    CHECK(load_gltf(write_gltf(folder, "good%20name.bin")).ok());
    const std::string name = std::filesystem::path(folder.path()).filename().string();
    const std::pair<std::string, std::string> cases[] = {
        {"../" + std::filesystem::path(outside.path()).filename().string() + "/secret.bin",
         "\\\"..\\\""},
        {"sub/../../" + name + "/good%20name.bin", ".."},
        {"%2e%2e/secret.bin", ".."},
        {outside.file("secret.bin"), "an absolute path"},
        {"%2Fetc/passwd", "an absolute path"},
        {"\\\\\\\\server\\\\share", "an absolute path"},
        {"http://example.com/a.bin", "a scheme"},
        {"https://example.com/a.bin", "a scheme"},
        {"file:///etc/passwd", "a scheme"},
        {"c:/a.bin", "a scheme or a drive"},
        {"link.bin", "a link out of the file's folder"},
        {"missing.bin", "no such file"},
        {"sub", "found a folder"},
        {"", "an empty URI"},
        {"%zz", "two hexadecimal digits"},
        {"a%00b", "square.gltf"},
        {"data:application/octet-stream;base64,????", "not base64"},
        {"data:application/octet-stream", "expected a comma"},
        {"data:application/octet-stream,abc", "expected at most the 3 bytes"},
        {"data:application/octet-stream,a%4", "two hexadecimal digits"},
        {"data:application/octet-stream;base64,AAAA", "expected at most the 3 bytes"},
    };
    for (const auto& tried : cases) {  // clang 14 captures no structured bindings
        const std::string& uri = tried.first;
        const std::string& expected = tried.second;
        CAPTURE(uri);
        const std::string plain = expected == "\\\"..\\\"" ? "found \"..\" in" : expected;
        check_refused(load_gltf(write_gltf(folder, uri)), plain);
    }
    check_refused(
        parse_gltf(read_file(write_gltf(folder, "good%20name.bin")).value(), "square.gltf", ""),
        "expected no references to other files");
}

TEST_CASE("gltf: a buffer without bytes is refused") {
    const std::string json = kSquareJson;
    check_refused(
        parse_gltf(std::as_bytes(std::span(json)), "square.gltf", ""),
        "accessors[0]: found bufferViews[0] in a buffer without data");
    check_refused(
        parse_gltf(make_glb(json, {}), "square.glb", ""),
        "accessors[0]: found bufferViews[0] in a buffer without data");
}

TEST_CASE("gltf: an image that is missing, corrupt or too large costs the textures of it") {
    const TemporaryFolder folder;
    std::vector<std::uint8_t> pixels(8 * 8 * 3, 99);
    REQUIRE(write_png(folder.file("good.png"), 8, 8, 3, pixels).ok());
    std::vector<std::byte> wide = read_file(folder.file("good.png")).value();
    const unsigned char width[4] = {0x00, 0x01, 0x86, 0xa0};
    std::memcpy(&wide[16], width, 4);
    const std::uint32_t crc = crc32_of(std::span(wide).subspan(12, 17));
    for (std::size_t i = 0; i < 4; ++i) {
        wide[29 + i] = static_cast<std::byte>(crc >> (24 - 8 * i));
    }
    REQUIRE(write_file(folder.file("wide.png"), wide).ok());
    std::vector<std::byte> corrupt = read_file(folder.file("good.png")).value();
    corrupt[corrupt.size() / 2] ^= std::byte{0x20};
    REQUIRE(write_file(folder.file("corrupt.png"), corrupt).ok());
    REQUIRE(write_file(folder.file("text.png"), std::string("not a picture")).ok());

    std::filesystem::create_directory(folder.file("sub"));
    REQUIRE(write_file(folder.file("empty.png"), std::string()).ok());
    REQUIRE(write_png(folder.file("sub/good.png"), 8, 8, 3, pixels).ok());

    const auto load = [&folder](const std::string& image) {
        REQUIRE(
            write_file(folder.file("square.glb"), make_glb(textured_json(image), square_binary()))
                .ok());
        return load_gltf(folder.file("square.glb"));
    };
    const std::pair<std::string, std::string> bad[] = {
        {R"({"uri": "missing.png"})", "images[0].uri: \"missing.png\": no such file"},
        {R"({"uri": "corrupt.png"})", "images[0] (corrupt.png): corrupt PNG"},
        {R"({"uri": "empty.png"})", "images[0] (empty.png): found an empty file"},
        {R"({"uri": "wide.png"})", "found 100000 x 8 pixels"},
        {R"({"uri": "text.png"})", "unknown format"},
        {R"({"uri": "../good.png"})", "expected a path under"},
        {R"({"uri": "..\\..\\good.png"})", "expected a path under"},
        {R"({"uri": "\\good.png"})", "an absolute path"},
        {R"({"uri": "http://example.com/a.png"})", "a scheme"},
        {R"({"uri": "data:image/png;base64,????"})", "not base64"},
        {R"({"bufferView": 0})", "unknown format"},
        {R"({"bufferView": 0, "uri": "good.png"})", "found both"},
        {R"({})", "found neither"},
    };
    for (const auto& [members, expected] : bad) {
        const auto& image = members;  // a binding cannot be captured
        const Result<GltfScene> scene = load(image);
        REQUIRE_MESSAGE(scene.ok(), image);
        REQUIRE(!scene->warnings.empty());
        CHECK_MESSAGE(contains(scene->warnings.back(), expected), scene->warnings.back());
        CHECK(contains(scene->warnings.back(), "; materials are without it"));
        CHECK(scene->images.empty());
        CHECK(scene->materials[0].base_color_texture.image.index == kNoAsset);
        const Result<GltfScene> strict = load_gltf(folder.file("square.glb"), {}, {.strict = true});
        REQUIRE_FALSE(strict.ok());
        CHECK(contains(strict.error().message, expected));
    }
    for (const auto& [members, warnings] : std::vector<std::pair<std::string, std::size_t>>{
             {R"({"uri": "good.png"})", 0},
             {R"({"uri": "sub\\good.png"})", 1},
             {R"({"uri": "sub%5Cgood.png"})", 1}}) {
        const auto& image = members;  // a binding cannot be captured
        const Result<GltfScene> scene = load(image);
        REQUIRE_MESSAGE(scene.ok(), image);
        CHECK(scene->warnings.size() == warnings);
        CHECK(scene->images.size() == 1);
        CHECK(scene->materials[0].base_color_texture.image.index == 0);
    }
}

TEST_CASE("gltf: of an image that is missing the other images keep their numbers") {
    const TemporaryFolder folder;
    REQUIRE(write_png(folder.file("a.png"), 1, 1, 3, std::vector<std::uint8_t>{1, 2, 3}).ok());
    REQUIRE(write_png(folder.file("c.png"), 1, 1, 3, std::vector<std::uint8_t>{4, 5, 6}).ok());
    const std::string json = replace_once(
        kSquareJson, R"({"name": "paint"}])",
        R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
            "normalTexture": {"index": 1}, "occlusionTexture": {"index": 2},
            "emissiveTexture": {"index": 1}}],
           "textures": [{"source": 0}, {"source": 1}, {"source": 2}],
           "images": [{"uri": "a.png"}, {"uri": "b.png"}, {"uri": "c.png"}])");
    const Result<GltfScene> scene =
        parse_gltf(make_glb(json, square_binary()), "square.glb", folder.path());
    REQUIRE(scene.ok());
    REQUIRE(scene->warnings.size() == 1);
    CHECK(contains(scene->warnings[0], "images[1].uri: \"b.png\": no such file"));
    REQUIRE(scene->images.size() == 2);
    const Material& material = scene->materials[0];
    CHECK(scene->images[material.base_color_texture.image.index].name == "a.png");
    CHECK(scene->images[material.occlusion_texture.image.index].name == "c.png");
    CHECK(material.normal_texture.image.index == kNoAsset);
    CHECK(material.emission_texture.image.index == kNoAsset);
}

TEST_CASE("gltf: what one file may cost is bounded") {
    GltfLimits limits;
    limits.max_values = 17;  // the positions are 12 numbers and the indices 6
    check_refused(
        parse_gltf(square_glb(), "square.glb", "", limits),
        "expected at most 17 in the whole file");
    limits.max_values = 18;
    CHECK(parse_gltf(square_glb(), "square.glb", "", limits).ok());
    limits.max_bytes = 100;
    check_refused(parse_gltf(square_glb(), "square.glb", "", limits), "expected at most 100");

    const TemporaryFolder folder;
    std::vector<std::uint8_t> pixels(8 * 8 * 3, 99);
    REQUIRE(write_png(folder.file("good.png"), 8, 8, 3, pixels).ok());
    limits = {};
    limits.max_pixels = 63;
    const Result<GltfScene> scene = parse_gltf(
        make_glb(textured_json(R"({"uri": "good.png"})"), square_binary()), "square.glb",
        folder.path(), limits);
    REQUIRE(scene.ok());
    REQUIRE(scene->warnings.size() == 1);
    CHECK(contains(scene->warnings[0], "found 8 x 8 pixels"));
    CHECK(scene->images.empty());
}

TEST_CASE("gltf: wrong components in extras.limn are refused at their place") {
    const auto refused = [](const std::string& extras, const std::string& expected) {
        CAPTURE(extras);
        const std::string json = replace_once(
            kSquareJson, R"("translation": [1, 2, 3])", R"("extras": {"limn": )" + extras + "}");
        check_refused(parse_gltf(make_glb(json, square_binary()), "square.glb", ""), expected);
    };
    refused("7", "nodes[1].extras.limn: found the number 7, expected an object");
    refused(R"({"no_such_thing": {}})", "nodes[1].extras.limn: found \"no_such_thing\"");
    refused(R"("{")", "nodes[1].extras.limn");
}

}  // namespace limn::gltf_bad_input_test
