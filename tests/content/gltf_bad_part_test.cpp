#include "tests/content/gltf_spoiled.h"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace limn::gltf_bad_part_test {

using namespace limn::test;

TEST_CASE("gltf: the square that the other tests spoil is fine") {
    const Result<GltfScene> scene = parse_gltf(square_glb(), "square.glb", "");
    REQUIRE(scene.ok());
    CHECK(scene->nodes.size() == 2);
    CHECK(scene->warnings.empty());
}

TEST_CASE("gltf: bad fields in extras.limn of a material cost these, and the rest is drawn") {
    const std::pair<const char*, const char*> cases[] = {
        {R"({"detail": "deep"})", "materials[0].extras.limn.detail: found the string \"deep\""},
        {R"({"relief_depth": -1})",
         "materials[0].extras.limn.relief_depth: found the number -1, expected a number 0 .. 1000 "
         "m; drawn without"},
        {"7", "materials[0].extras.limn: found the number 7, expected an object with fields of a "
              "material; drawn without"},
        {R"({"relief_texture": {"index": 0}})",
         "materials[0]: extras.limn.relief_texture: found no index of a texture"},
        {R"({"relief_texture": 1e30})",
         "materials[0]: extras.limn.relief_texture: found no index of a texture"}};
    for (const auto& [extras, expected] : cases) {
        const std::string json = replace_once(
            kSquareJson, R"("name": "paint")",
            R"("doubleSided": true, "extras": {"limn": )" + std::string(extras) + "}");
        const auto scene = parse_gltf(make_glb(json, square_binary()), "square.glb", "");
        REQUIRE(scene.ok());
        REQUIRE(scene->warnings.size() == 1);
        CHECK_MESSAGE(mentions(scene->warnings[0], expected), scene->warnings[0]);
        CHECK(scene->materials[0].double_sided);
        CHECK(scene->materials[0].detail == SurfaceDetail::Normal);
    }
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
    CHECK(mentions(scene->warnings[0], "found 5 indices, expected a multiple of 3"));
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
    CHECK(mentions(scene->warnings[0], "textures[0] has no image"));
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
            CHECK_MESSAGE(mentions(scene->warnings[i], warnings[i]), scene->warnings[i]);
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

TEST_CASE("gltf: a position that is not finite costs the triangles that use it") {
    for (const float bad : {std::nanf(""), INFINITY, -INFINITY}) {
        std::vector<std::byte> binary = square_binary();
        std::memcpy(&binary[12], &bad, 4);
        const Result<GltfScene> scene = parse_gltf(make_glb(kSquareJson, binary), "square.glb", "");
        REQUIRE(scene.ok());
        REQUIRE(scene->warnings.size() == 1);
        CHECK(mentions(
            scene->warnings[0],
            "square.glb: meshes[0].primitives[0].attributes.POSITION: found ("));
        CHECK(mentions(scene->warnings[0], "in element 1, expected finite numbers"));
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

}  // namespace limn::gltf_bad_part_test
