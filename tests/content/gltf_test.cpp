#include "content/bake/tangents.h"
#include "content/load/files/atomic_file.h"
#include "content/load/files/png_file.h"
#include "content/load/gltf/gltf_load.h"
#include "content/load/gltf/gltf_spawn.h"
#include "ecs/components/all.h"
#include "ecs/components/name.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"
#include "tests/content/gltf_samples.h"
#include "tests/near.h"
#include "tests/support.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn::gltf_test {

using namespace limn::test;

namespace {

bool near(const Vec3& a, const Vec3& b, float tolerance = 1e-5f) {
    return glm::length(a - b) <= tolerance;
}

/// The square with some edits, each of a text that is there once.
struct Edit {
    std::string from;
    std::string to;
};

GltfScene
load_square(const std::vector<Edit>& edits, std::vector<std::byte> binary = square_binary()) {
    std::string json = kSquareJson;
    for (const Edit& edit : edits) {
        const std::string before = json;
        json = replace_once(json, edit.from, edit.to);
        REQUIRE((json != before || edit.from == edit.to));
    }
    Result<GltfScene> scene = parse_gltf(make_glb(json, std::move(binary)), "square.glb", "");
    CAPTURE(scene.ok() ? "" : scene.error().message);
    REQUIRE(scene.ok());
    return std::move(*scene);
}

const std::string kAccessorsEnd = R"("values": {"bufferView": 3}}})";
const std::string kViewsEnd = R"({"buffer": 0, "byteOffset": 68, "byteLength": 24})";
const std::string kAttributes = R"({"POSITION": 0})";

/// The square with one more attribute, whose bytes are `values`, and its material replaced.
template <typename T>
GltfScene load_with_attribute(
    const std::string& name, const std::vector<T>& values, int component_type,
    const std::string& type, bool normalized, const std::string& material = R"("name": "paint")") {
    std::vector<std::byte> binary = square_binary();
    append_values(binary, values);
    const std::size_t size = values.size() * sizeof(T);
    const std::string total = std::to_string(binary.size());
    return load_square(
        {{"\"byteLength\": 92", "\"byteLength\": " + total},
         {kViewsEnd, kViewsEnd + R"(, {"buffer": 0, "byteOffset": 92, "byteLength": )"
                         + std::to_string(size) + "}"},
         {kAccessorsEnd, kAccessorsEnd + R"(, {"bufferView": 4, "count": 4, "componentType": )"
                             + std::to_string(component_type) + R"(, "type": ")" + type
                             + R"(", "normalized": )" + (normalized ? "true}" : "false}")},
         {kAttributes, R"({"POSITION": 0, ")" + name + R"(": 3})"},
         {R"("name": "paint")", material}},
        std::move(binary));
}

/// Every triangle faces where its normals point, tangents are unit and perpendicular.
void check_mesh(const MeshData& mesh) {
    REQUIRE(mesh.normals.size() == mesh.positions.size());
    REQUIRE(mesh.tangents.size() == mesh.positions.size());
    REQUIRE(mesh.uvs.size() == mesh.positions.size());
    std::size_t wrong = 0;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        wrong += std::abs(glm::length(mesh.normals[v]) - 1) > 1e-3f;
        wrong += std::abs(glm::length(Vec3(mesh.tangents[v])) - 1) > 1e-3f;
        wrong += std::abs(mesh.tangents[v].w) != 1.0f;
    }
    CHECK(wrong == 0);
}

}  // namespace

TEST_CASE("gltf: a node graph arrives with names, parents and transforms") {
    const GltfScene scene = load_square({});
    REQUIRE(scene.nodes.size() == 2);
    CHECK(scene.name == "square");
    CHECK(scene.nodes[0].name == "root");
    CHECK(scene.nodes[0].parent == -1);
    CHECK(scene.nodes[1].parent == 0);
    CHECK(scene.nodes[1].transform.position == Vec3(1, 2, 3));
    REQUIRE(scene.nodes[1].parts.size() == 1);
    REQUIRE(scene.meshes.size() == 1);
    CHECK(scene.materials.size() == 1);
    CHECK(scene.meshes[0].indices == std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3});
    check_mesh(scene.meshes[0]);
    const Bounds bounds = find_bounds(scene);
    CHECK(near(bounds.min, {1, 2, 3}));
    CHECK(near(bounds.max, {2, 3, 3}));
}

TEST_CASE("gltf: a matrix becomes position, rotation and scale, mirrored ones too") {
    // Columns: x -> 2z, y -> 3y, z -> x, moved by (5, 6, 7): rotation, scale and a mirror.
    const GltfScene scene = load_square(
        {{R"("translation": [1, 2, 3])", R"("matrix": [0,0,2,0, 0,3,0,0, 1,0,0,0, 5,6,7,1])"}});
    const Transform& t = scene.nodes[1].transform;
    const Affine matrix = affine_from(t.position, t.rotation, t.scale);
    CHECK(near(transform_point(matrix, {0, 0, 0}), {5, 6, 7}));
    CHECK(near(transform_vector(matrix, {1, 0, 0}), {0, 0, 2}));
    CHECK(near(transform_vector(matrix, {0, 1, 0}), {0, 3, 0}));
    CHECK(near(transform_vector(matrix, {0, 0, 1}), {1, 0, 0}));
    CHECK(scene.warnings.empty());
    const GltfScene sheared = load_square(
        {{R"("translation": [1, 2, 3])", R"("matrix": [1,0,0,0, 1,1,0,0, 0,0,1,0, 0,0,0,1])"}});
    CHECK(sheared.warnings.size() == 1);
}

TEST_CASE("gltf: a scale of zero keeps an inverse") {
    const GltfScene scene = load_square({{R"("translation": [1, 2, 3])", R"("scale": [0, 1, 0])"}});
    CHECK(scene.nodes[1].transform.scale.x != 0);
    CHECK(scene.nodes[1].transform.scale.z != 0);
}

TEST_CASE("gltf: indices of every type and none give the same triangles") {
    const std::string view = R"({"buffer": 0, "byteOffset": 48, "byteLength": 12})";
    const std::string accessor =
        R"({"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"})";
    const std::vector<std::uint32_t> expected = {0, 1, 2, 0, 2, 3};
    const auto with = [&](auto zero, const std::string& type) {
        using T = decltype(zero);
        std::vector<std::byte> binary = square_binary();
        const std::size_t at = binary.size();
        append_values<T>(binary, {0, 1, 2, 0, 2, 3});
        return load_square(
            {{"\"byteLength\": 92", "\"byteLength\": " + std::to_string(binary.size())},
             {view, R"({"buffer": 0, "byteOffset": )" + std::to_string(at) + R"(, "byteLength": )"
                        + std::to_string(6 * sizeof(T)) + "}"},
             {accessor, replace_once(accessor, "5123", type)}},
            binary);
    };
    CHECK(with(std::uint8_t{}, "5121").meshes[0].indices == expected);
    CHECK(with(std::uint16_t{}, "5123").meshes[0].indices == expected);
    CHECK(with(std::uint32_t{}, "5125").meshes[0].indices == expected);

    // Without indices the four vertices are no whole triangles, but a fan.
    const GltfScene fan = load_square({{R"("indices": 1)", R"("mode": 6)"}});
    CHECK(fan.meshes[0].indices == expected);
}

TEST_CASE("gltf: strips keep the winding of their first triangle") {
    // A strip 0 1 3 2: triangles 0 1 3 and, turned, 1 2 3.
    std::vector<std::byte> binary = square_binary();
    const std::uint16_t strip[6] = {0, 1, 3, 2, 2, 2};
    std::memcpy(&binary[48], strip, sizeof(strip));
    const GltfScene scene =
        load_square({{R"("indices": 1)", R"("indices": 1, "mode": 5)"}}, binary);
    const MeshData& mesh = scene.meshes[0];
    REQUIRE(mesh.indices.size() == 6);  // the joining triangles are gone
    for (std::size_t i = 0; i < 6; i += 3) {
        const Vec3& a = mesh.positions[mesh.indices[i]];
        const Vec3& b = mesh.positions[mesh.indices[i + 1]];
        const Vec3& c = mesh.positions[mesh.indices[i + 2]];
        CHECK(glm::cross(b - a, c - a).z == test::near(1));
    }
}

TEST_CASE("gltf: vertices that no triangle names are dropped") {
    std::vector<std::byte> binary = square_binary();
    const std::uint16_t one_triangle[6] = {1, 2, 3, 3, 2, 1};
    std::memcpy(&binary[48], one_triangle, sizeof(one_triangle));
    const GltfScene scene = load_square({}, binary);
    CHECK(near(scene.meshes[0].bounds.max, {1, 1, 0}));
    for (const Vec3& p : scene.meshes[0].positions) {
        CHECK_FALSE(p == Vec3(0));
    }
}

TEST_CASE("gltf: sparse elements replace those of the view, and zeros without one") {
    const GltfScene over = load_square({{kAttributes, R"({"POSITION": 2})"}});
    const std::vector<Vec3>& p = over.meshes[0].positions;
    REQUIRE(p.size() == 4);
    CHECK(p[0] == Vec3(0, 0, 0));
    CHECK(p[1] == Vec3(2, 0, 0));
    CHECK(p[2] == Vec3(1, 1, 0));
    CHECK(p[3] == Vec3(0, 2, 0));

    const GltfScene zeros = load_square(
        {{kAttributes, R"({"POSITION": 2})"},
         {"{\"bufferView\": 0, \"componentType\": 5126, \"count\": 4, \"type\": \"VEC3\",\n        "
          " \"sparse\"",
          R"({"componentType": 5126, "count": 4, "type": "VEC3", "sparse")"}});
    const Bounds& bounds = zeros.meshes[0].bounds;
    CHECK(near(bounds.max, {2, 2, 0}));
    CHECK(near(bounds.min, {0, 0, 0}));
}

TEST_CASE("gltf: normalized integers are 0 .. 1 or -1 .. 1, others keep their value") {
    const auto colors = [](const GltfScene& scene) { return scene.meshes.at(0).colors; };
    const GltfScene bytes = load_with_attribute<std::uint8_t>(
        "COLOR_0", {255, 0, 51, 255, 0, 0, 0, 0, 255, 255, 255, 255, 1, 2, 3, 4}, 5121, "VEC4",
        true);
    CHECK(glm::length(colors(bytes)[0] - Vec4(1, 0, 0.2f, 1)) < 1e-6f);
    const GltfScene shorts = load_with_attribute<std::uint16_t>(
        "COLOR_0", {65535, 0, 13107, 0, 0, 0, 65535, 65535, 65535, 0, 0, 0}, 5123, "VEC3", true);
    CHECK(glm::length(colors(shorts)[0] - Vec4(1, 0, 0.2f, 1)) < 1e-6f);
    CHECK(colors(shorts)[2] == Vec4(1));
    const GltfScene floats = load_with_attribute<float>(
        "COLOR_0", {2, 0, 0.5f, 0, 0, 0, 1, 1, 1, 0, 0, 0}, 5126, "VEC3", false);
    CHECK(colors(floats)[0] == Vec4(2, 0, 0.5f, 1));
    const GltfScene normals = load_with_attribute<std::int8_t>(
        "NORMAL", {0, 0, 127, 0, 0, 127, 0, 0, -128, 127, 0, 0}, 5120, "VEC3", true);
    CHECK(normals.meshes[0].normals[0] == Vec3(0, 0, 1));
    CHECK(normals.meshes[0].normals[2] == Vec3(0, 0, -1));
    const GltfScene uvs =
        load_with_attribute<float>("TEXCOORD_1", {0, 0, 1, 0, 1, 1, 0, 1}, 5126, "VEC2", false);
    CHECK(uvs.meshes[0].uvs1[2] == Vec2(1, 1));
    CHECK(uvs.meshes[0].uvs[2] == Vec2(0, 0));
}

TEST_CASE("gltf: a normal of no length becomes one of length 1") {
    const GltfScene scene =
        load_with_attribute<float>("NORMAL", std::vector<float>(12, 0.0f), 5126, "VEC3", false);
    check_mesh(scene.meshes[0]);
    for (const Vec3& normal : scene.meshes[0].normals) {
        CHECK(normal == Vec3(0, 0, 1));  // as if there were none
    }
}

TEST_CASE("gltf: a bad normal becomes that of the triangles about it, the others stay") {
    for (const float bad : {0.0f, std::nanf(""), INFINITY}) {
        const GltfScene scene = load_with_attribute<float>(
            "NORMAL", {0, 0, -2, bad, bad, bad, 0, 1, 0, 1, 0, 0}, 5126, "VEC3", false);
        check_mesh(scene.meshes[0]);
        CHECK(
            scene.meshes[0].normals
            == std::vector<Vec3>{{0, 0, -1}, {0, 0, 1}, {0, 1, 0}, {1, 0, 0}});
        REQUIRE(scene.warnings.size() == 1);
        CHECK(
            scene.warnings[0].find("square.glb: meshes[0].primitives[0].attributes.NORMAL: found ")
            == 0);
        CHECK(scene.warnings[0].find(" in element 1, expected ") != std::string::npos);
    }
}

TEST_CASE("gltf: bad tangents are recomputed, bad texture coordinates are 0, bad colors white") {
    const GltfScene plain = load_square({});
    for (const float bad : {0.0f, std::nanf("")}) {
        const GltfScene scene = load_with_attribute<float>(
            "TANGENT", {0, 1, 0, 1, bad, bad, bad, 1, 0, 1, 0, 1, 0, 1, 0, 1}, 5126, "VEC4", false);
        check_mesh(scene.meshes[0]);
        CHECK(scene.warnings.size() == 1);
        CHECK(scene.meshes[0].tangents == plain.meshes[0].tangents);
    }
    const float nan = std::nanf("");
    const GltfScene uvs =
        load_with_attribute<float>("TEXCOORD_0", {0, 0, 1, nan, 1, 1, 0, 1}, 5126, "VEC2", false);
    CHECK(uvs.warnings.size() == 1);
    CHECK(uvs.meshes[0].uvs == std::vector<Vec2>{{0, 0}, {0, 0}, {1, 1}, {0, 1}});
    const GltfScene colors = load_with_attribute<float>(
        "COLOR_0", {0, 0, 0, nan, 0, 0, 1, 0, 0, 0, 1, 0}, 5126, "VEC3", false);
    CHECK(colors.warnings.size() == 1);
    CHECK(
        colors.meshes[0].colors
        == std::vector<Vec4>{{0, 0, 0, 1}, {1, 1, 1, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}});
}

TEST_CASE("gltf: materials have the defaults of the specification and what the extensions say") {
    const Material plain = load_square({}).materials[0];
    CHECK(plain.name == "paint");
    CHECK(plain.base_color == Vec4(1));
    CHECK(plain.metalness == 1);
    CHECK(plain.roughness == 1);
    CHECK(plain.emission == Vec3(0));
    CHECK(plain.base_color_texture.image.index == kNoAsset);

    const Material lamp = load_square({{R"({"name": "paint"})", R"({"emissiveFactor": [1, 0.5, 0],
        "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true,
        "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0, "roughnessFactor": 0.5},
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 8}, "KHR_materials_unlit": {}}})"}})
                              .materials[0];
    CHECK(lamp.emission == Vec3(8, 4, 0));
    CHECK(lamp.alpha_mode == AlphaMode::Mask);
    CHECK(lamp.alpha_cutoff == 0.25f);
    CHECK(lamp.double_sided);
    CHECK(lamp.base_color == Vec4(0.1f, 0.2f, 0.3f, 0.4f));
    CHECK(lamp.metalness == 0);
    CHECK(lamp.roughness == 0.5f);
    CHECK(lamp.shading == ShadingModel::Unlit);

    const GltfScene bare = load_square({{R"("indices": 1, "material": 0)", R"("indices": 1)"}});
    REQUIRE(bare.materials.size() == 2);
    CHECK(bare.nodes[1].parts[0].material == 1);
    CHECK(bare.materials[1].metalness == 1);
}

TEST_CASE("gltf: clear media have their index, thickness and absorption; opaque ones the index") {
    const auto glass = [](const std::string& extensions) {
        return load_square({{R"({"name": "paint"})", R"({"extensions": {)" + extensions + "}}"}})
            .materials[0];
    };
    const std::string clear = R"("KHR_materials_transmission": {"transmissionFactor": 0.75})";
    const Material sheet = glass(clear);
    CHECK(sheet.transmission == 0.75f);
    CHECK(sheet.refractive_index == 1.5f);
    CHECK(sheet.thickness == 0);
    CHECK(sheet.base_color.w == 1);
    const Material gem =
        glass(clear + R"(, "KHR_materials_ior": {"ior": 2.4}, "KHR_materials_volume":
        {"attenuationColor": [0.5, 0.6, 0.7], "attenuationDistance": 2, "thicknessFactor": 0.1})");
    CHECK(gem.refractive_index == 2.4f);
    CHECK(gem.thickness == 0.1f);
    CHECK(gem.attenuation_color == Vec3(0.5f, 0.6f, 0.7f));
    CHECK(gem.attenuation_distance == 2);
    CHECK(glass(clear + R"(, "KHR_materials_ior": {"ior": 0})").refractive_index == 1);
    CHECK(glass(R"("KHR_materials_transmission": {})").transmission == 0);
    CHECK(glass(R"("KHR_materials_ior": {"ior": 2.4})").refractive_index == 2.4f);
}

TEST_CASE("gltf: tangents follow the texture coordinates of the normal map, also those of its "
          "transform") {
    // The second set has u along +y, the first is missing.
    const auto follows_second = [](const std::string& info) {
        const GltfScene scene = load_with_attribute<float>(
            "TEXCOORD_1", {0, 0, 0, -1, 1, -1, 1, 0}, 5126, "VEC2", false,
            R"("normalTexture": {"index": 0)" + info + R"(}}], "textures": [{}], "samplers": [{)");
        return near(Vec3(scene.meshes[0].tangents[0]), {0, 1, 0});
    };
    const std::string transform = R"(, "extensions": {"KHR_texture_transform": )";
    CHECK(follows_second(R"(, "texCoord": 1)"));
    CHECK(follows_second(R"(, "texCoord": 1)" + transform + R"({"scale": [2, 2]}})"));
    CHECK(follows_second(R"(, "texCoord": 0)" + transform + R"({"texCoord": 1}})"));
    CHECK_FALSE(follows_second(""));
    CHECK_FALSE(follows_second(R"(, "texCoord": 1)" + transform + R"({"texCoord": 0}})"));
}

TEST_CASE("gltf: textures keep wrap, filter, uv set and transform; color and data are apart") {
    const TemporaryFolder folder;
    const std::vector<std::uint8_t> pixels = {10, 20, 30, 40, 50, 60};
    REQUIRE(write_png(folder.file("a.png"), 2, 1, 3, pixels).ok());
    const std::string json = replace_once(kSquareJson, R"({"name": "paint"}])", R"({
        "pbrMetallicRoughness": {
            "baseColorTexture": {"index": 0, "texCoord": 1, "extensions": {"KHR_texture_transform":
                {"offset": [0.5, -1], "scale": [2, 3], "rotation": 0.25}}},
            "metallicRoughnessTexture": {"index": 0}},
        "normalTexture": {"index": 0, "scale": 0.5},
        "occlusionTexture": {"index": 0, "strength": 0.75, "texCoord": 5},
        "emissiveTexture": {"index": 0, "extensions": {"KHR_texture_transform": {"texCoord": 1}}}}],
        "samplers": [{"magFilter": 9728, "minFilter": 9729, "wrapS": 33071, "wrapT": 33648}],
        "textures": [{"source": 0, "sampler": 0}], "images": [{"name": "wood", "uri": "a.png"}, {"uri": "never-read.png"}])");
    const Result<GltfScene> scene =
        parse_gltf(make_glb(json, square_binary()), "square.glb", folder.path());
    CAPTURE(scene.ok() ? "" : scene.error().message);
    REQUIRE(scene.ok());
    const Material& material = scene->materials[0];
    const TextureSlot& color = material.base_color_texture;
    CHECK(color.uv_set == 1);
    CHECK(color.wrap_u == Wrap::Clamp);
    CHECK(color.wrap_v == Wrap::Mirror);
    CHECK(color.nearest);
    CHECK(color.minify == Minify::Linear);
    CHECK(color.offset == Vec2(0.5f, -1));
    CHECK(color.scale == Vec2(2, 3));
    CHECK(color.rotation == 0.25f);
    CHECK(material.emission_texture.uv_set == 1);
    CHECK(material.emission_texture.scale == Vec2(1));
    CHECK(material.normal_scale == 0.5f);
    CHECK(material.occlusion_strength == 0.75f);
    CHECK(material.occlusion_texture.uv_set == 0);
    CHECK(scene->warnings.size() == 1);  // about uv set 5

    REQUIRE(scene->images.size() == 2);
    CHECK(scene->images[color.image.index].srgb);
    CHECK(scene->images[color.image.index].name == "wood");
    CHECK(material.emission_texture.image == color.image);
    CHECK_FALSE(scene->images[material.normal_texture.image.index].srgb);
    CHECK(material.normal_texture.image == material.metal_rough_texture.image);
    const std::vector<std::uint8_t> rgba = {10, 20, 30, 255, 40, 50, 60, 255};
    CHECK(scene->images[0].pixels == rgba);
}

TEST_CASE("gltf: an image in a buffer view and one in a data: URI are read") {
    const TemporaryFolder folder;
    REQUIRE(write_png(folder.file("a.png"), 1, 1, 3, std::vector<std::uint8_t>{1, 2, 3}).ok());
    const std::vector<std::byte> png = read_file(folder.file("a.png")).value();
    std::vector<std::byte> binary = square_binary();
    binary.insert(binary.end(), png.begin(), png.end());
    const GltfScene scene = load_square(
        {{"\"byteLength\": 92", "\"byteLength\": " + std::to_string(binary.size())},
         {kViewsEnd, kViewsEnd + R"(, {"buffer": 0, "byteOffset": 92, "byteLength": )"
                         + std::to_string(png.size()) + "}"},
         {R"({"name": "paint"}])",
          R"({"emissiveTexture": {"index": 0}, "normalTexture": {"index": 1}}], "textures": [{"source": 0}, {"source": 1}],
             "images": [{"bufferView": 4, "mimeType": "image/png"}, {"uri": "data:image/png;base64,)"
          R"(iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="}])"}},
        binary);
    REQUIRE(scene.images.size() == 2);
    CHECK(
        scene.images[scene.materials[0].emission_texture.image.index].pixels
        == std::vector<std::uint8_t>{1, 2, 3, 255});
    CHECK(scene.images[scene.materials[0].normal_texture.image.index].width == 1);
}

TEST_CASE("gltf: cameras and lights arrive in our units") {
    const GltfScene scene = load_square(
        {{R"("scene": 0)", R"("scene": 0, "cameras": [
            {"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.2, "zfar": 100}},
            {"type": "orthographic", "orthographic": {"xmag": 3, "ymag": 2, "znear": 0, "zfar": 1}}],
            "extensions": {"KHR_lights_punctual": {"lights": [
                {"type": "point", "color": [1, 0.5, 0.25], "intensity": 40, "range": 12},
                {"type": "spot", "intensity": 7, "spot": {"innerConeAngle": 0.3, "outerConeAngle": 0.6}},
                {"type": "directional", "intensity": 1000}]}})"},
         {R"("translation": [1, 2, 3]})", R"("translation": [1, 2, 3]},
            {"camera": 0}, {"camera": 1},
            {"extensions": {"KHR_lights_punctual": {"light": 0}}},
            {"extensions": {"KHR_lights_punctual": {"light": 1}}},
            {"extensions": {"KHR_lights_punctual": {"light": 2}}})"},
         {R"([{"nodes": [0]}])", R"([{"nodes": [0, 2, 3, 4, 5, 6]}])"}});
    REQUIRE(scene.nodes.size() == 7);
    CHECK(scene.nodes[2].has_camera);
    CHECK(scene.nodes[2].camera.fov_y == 0.7f);
    CHECK(scene.nodes[2].camera.near == 0.2f);
    CHECK(scene.nodes[2].camera.ortho_height == 0);
    CHECK(scene.nodes[3].has_camera);
    CHECK(scene.nodes[3].camera.ortho_height == 4);
    CHECK(scene.warnings.empty());
    const auto* point = std::get_if<PointLight>(&scene.nodes[4].light);
    REQUIRE(point != nullptr);
    CHECK(point->color == Vec3(1, 0.5f, 0.25f));
    CHECK(point->intensity == 40);
    CHECK(point->radius == 12);
    const auto* spot = std::get_if<SpotLight>(&scene.nodes[5].light);
    REQUIRE(spot != nullptr);
    CHECK(spot->inner_angle == 0.3f);
    CHECK(spot->outer_angle == 0.6f);
    CHECK(spot->radius == 0);
    CHECK(spot->color == Vec3(1));
    const auto* sun = std::get_if<DirectionalLight>(&scene.nodes[6].light);
    REQUIRE(sun != nullptr);
    CHECK(sun->illuminance == 1000);
}

TEST_CASE("gltf: only the nodes of the file's scene come, all roots where there is no scene") {
    const GltfScene none = load_square({{R"([{"nodes": [0]}])", R"([{"name": "empty"}])"}});
    CHECK(none.nodes.empty());
    CHECK(is_empty(find_bounds(none)));
    const GltfScene all =
        load_square({{R"("scenes": [{"nodes": [0]}],)", ""}, {R"("scene": 0)", R"("extras": 1)"}});
    CHECK(all.nodes.size() == 2);
}

TEST_CASE("gltf: a scene spawns as entities with the hierarchy of the file, behind what is there") {
    register_all_components();
    World world;
    Assets& assets = world.insert_resource(Assets{});
    assets.meshes.resize(3);
    assets.materials.resize(2);
    const Entity place = world.create(Transform{});
    const std::vector<Entity> roots = spawn_gltf(world, assets, load_square({}), place).roots;
    REQUIRE(roots.size() == 1);
    CHECK(world.get<const Name>(roots[0]).text == "root");
    CHECK(parent_of(world, roots[0]) == place);
    REQUIRE(children_of(world, roots[0]).size() == 1);
    const Entity leaf = children_of(world, roots[0])[0];
    CHECK(world.get<const Name>(leaf).text == "leaf");
    CHECK(world.get<const Transform>(leaf).position == Vec3(1, 2, 3));
    CHECK(world.get<const MeshInstance>(leaf).mesh.index == 3);
    CHECK(world.get<const MeshInstance>(leaf).material.index == 2);
    CHECK(assets.meshes.size() == 4);
    CHECK(assets.meshes[3].name == "square");
}

TEST_CASE("gltf: the images of a spawned scene stand behind those that were there") {
    World world;
    Assets assets;
    assets.images.resize(4);
    GltfScene scene;
    scene.images.resize(2);
    scene.images[1].name = "bark";
    scene.materials.resize(1);
    scene.materials[0].occlusion_texture.image.index = 1;
    spawn_gltf(world, assets, std::move(scene));
    REQUIRE(assets.images.size() == 6);
    CHECK(assets.images[assets.materials[0].occlusion_texture.image.index].name == "bark");
    CHECK(assets.materials[0].normal_texture.image.index == kNoAsset);
}

TEST_CASE("gltf: a mesh of several primitives spawns a child for each") {
    register_all_components();
    World world;
    Assets assets;
    const std::string primitive = R"({"attributes": {"POSITION": 0}, "indices": 1, "material": 0})";
    const std::vector<Entity> roots =
        spawn_gltf(world, assets, load_square({{primitive, primitive + ", " + primitive}})).roots;
    const Entity leaf = children_of(world, roots[0])[0];
    CHECK_FALSE(world.has<MeshInstance>(leaf));
    CHECK(children_of(world, leaf).size() == 2);
    CHECK(assets.meshes.size() == 2);
}

TEST_CASE("gltf: extras.limn adds our components, and they may name nodes and materials") {
    register_all_components();
    const std::string extras = R"({"spin": {"speed": 2.5}, "orbit_camera": {"target": "root"},
        "mesh_instance": {"mesh": "square", "material": "paint"}})";
    std::string quoted = "\"";
    for (const char c : extras) {
        quoted += c == '"' ? "\\\"" : c == '\n' ? " " : std::string(1, c);
    }
    quoted += '"';
    for (const std::string& form : {extras, quoted}) {
        World world;
        Assets assets;
        assets.meshes.resize(5);
        const std::vector<Entity> roots =
            spawn_gltf(
                world, assets,
                load_square(
                    {{R"("translation": [1, 2, 3])", R"("extras": {"limn": )" + form + "}"}}))
                .roots;
        const Entity leaf = children_of(world, roots[0])[0];
        CHECK(world.get<const Spin>(leaf).speed == 2.5f);
        CHECK(world.get<const OrbitCamera>(leaf).target == roots[0]);
        CHECK(world.get<const MeshInstance>(leaf).mesh.index == 5);
        CHECK(world.get<const MeshInstance>(leaf).material.index == 0);
    }
}

TEST_CASE("gltf: misspelled components and fields are refused with the name that was meant") {
    register_all_components();
    const auto message = [](const std::string& extras) {
        const std::string json = replace_once(
            kSquareJson, R"("translation": [1, 2, 3])", R"("extras": {"limn": )" + extras + "}");
        const Result<GltfScene> scene =
            parse_gltf(make_glb(json, square_binary()), "square.glb", "");
        REQUIRE_FALSE(scene.ok());
        return scene.error().message;
    };
    CHECK(message(R"({"spinn": {}})").find("did you mean spin?") != std::string::npos);
    CHECK(message(R"({"spin": {"sped": 1}})").find("did you mean speed?") != std::string::npos);
    CHECK(
        message(R"({"spin": {"speed": "fast"}})").find("nodes[1].extras.limn.spin")
        != std::string::npos);
    CHECK(message(R"({"spin": {"speed": 1e6}})").find("square.glb") != std::string::npos);
    CHECK(message(R"({"orbit_camera": {"target": "rot"}})").find("root") != std::string::npos);
}

TEST_CASE("gltf: a skinned mesh stands where its joints put the bind pose, not where its node is") {
    const std::optional<std::string> path = shared_asset("gltf/SimpleSkin.gltf");
    if (!path) {
        return;
    }
    const Result<GltfScene> scene = load_gltf(*path);
    REQUIRE(scene.ok());
    const Bounds bounds = find_bounds(*scene);
    CHECK(near(bounds.min, {-0.5f, 0, 0}, 1e-4f));
    CHECK(near(bounds.max, {0.5f, 2, 0}, 1e-4f));
}

TEST_CASE("gltf: FlightHelmet has six textured parts whose tangents agree with generated ones") {
    const std::optional<std::string> path = shared_asset("gltf/FlightHelmet/FlightHelmet.gltf");
    if (!path) {
        return;
    }
    const Result<GltfScene> scene = load_gltf(*path);
    CAPTURE(scene.ok() ? "" : scene.error().message);
    REQUIRE(scene.ok());
    CHECK(scene->meshes.size() == 6);
    CHECK(scene->materials.size() == 6);
    CHECK(scene->images.size() == 15);
    CHECK(scene->warnings.empty());
    for (const MeshData& mesh : scene->meshes) {
        check_mesh(mesh);
        MeshData generated = mesh;
        generate_tangents(generated);
        std::size_t differ = 0;
        for (std::size_t corner = 0; corner < mesh.indices.size(); ++corner) {
            const Vec4& theirs = mesh.tangents[mesh.indices[corner]];
            const Vec4& ours = generated.tangents[generated.indices[corner]];
            differ += glm::dot(Vec3(theirs), Vec3(ours)) < 0.97f || theirs.w != ours.w;
        }
        CHECK(static_cast<double>(differ) < 0.02 * static_cast<double>(mesh.indices.size()));
    }
    for (const Material& material : scene->materials) {
        REQUIRE(material.normal_texture.image.index < scene->images.size());
        CHECK_FALSE(scene->images[material.normal_texture.image.index].srgb);
        CHECK(scene->images[material.base_color_texture.image.index].srgb);
    }
}

TEST_CASE("gltf: CornellBox has its lamp's strength and stands on its floor") {
    const std::optional<std::string> path = shared_asset("gltf/CornellBox.glb");
    if (!path) {
        return;
    }
    const Result<GltfScene> scene = load_gltf(*path);
    REQUIRE(scene.ok());
    CHECK(scene->nodes.size() == 4);
    CHECK(scene->materials[0].emission == Vec3(100));
    CHECK(scene->warnings.empty());
    for (const MeshData& mesh : scene->meshes) {
        check_mesh(mesh);
    }
    const Vec3 size = 2.0f * half_extent(find_bounds(*scene));
    CHECK(size.y == test::near(548.8).epsilon(0.01));
}

TEST_CASE("gltf: Fox stands upright in its bind pose, with normals made for it") {
    const std::optional<std::string> path = shared_asset("gltf/Fox.glb");
    if (!path) {
        return;
    }
    const Result<GltfScene> scene = load_gltf(*path);
    REQUIRE(scene.ok());
    REQUIRE(scene->meshes.size() == 1);
    const MeshData& fox = scene->meshes[0];
    check_mesh(fox);
    const Bounds bounds = find_bounds(*scene);
    CHECK(near(bounds.min, {-12.59f, -0.12f, -88.1f}, 0.05f));
    CHECK(near(bounds.max, {12.59f, 78.91f, 66.62f}, 0.05f));
    CHECK(scene->images.size() == 1);
    // Outwards: the normals near the top point up, those near the feet's soles do not.
    double up = 0;
    for (std::size_t v = 0; v < fox.positions.size(); ++v) {
        up += fox.positions[v].y > 60 ? static_cast<double>(fox.normals[v].y) : 0.0;
    }
    CHECK(up > 0);
    // Smoothed: corners at one point share normals where faces meet at less than the crease angle.
    CHECK(fox.positions.size() >= 1728 / 2);
}

TEST_CASE("gltf: a camera that frames a box sees all of it, and not from far away") {
    for (const Vec3 half : {Vec3(1), Vec3(5, 0.1f, 1), Vec3(0.01f, 2, 0.01f)}) {
        for (const float aspect : {0.5f, 16.0f / 9.0f}) {
            const Vec3 middle(3, -2, 7);
            const float fov_y = radians(40);
            const Transform view =
                frame_bounds({middle - half, middle + half}, fov_y, aspect).camera;
            float fill = 0;
            for (int corner = 0; corner < 8; ++corner) {
                const Vec3 p =
                    middle
                    + half * Vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
                const Vec3 p_vs = glm::inverse(view.rotation) * (p - view.position);
                REQUIRE(p_vs.z < 0);
                const float y = std::abs(p_vs.y / -p_vs.z) / std::tan(0.5f * fov_y);
                const float x = std::abs(p_vs.x / -p_vs.z) / std::tan(0.5f * fov_y) / aspect;
                fill = std::max({fill, x, y});
            }
            CHECK(fill <= 1.0f);
            CHECK(fill >= 0.85f);
        }
    }
}

}  // namespace limn::gltf_test
