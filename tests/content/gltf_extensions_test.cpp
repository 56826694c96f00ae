#include "content/bake/block_image.h"
#include "content/load/files/dds_file.h"
#include "content/load/gltf/gltf_load.h"
#include "tests/content/gltf_samples.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

namespace limn::gltf_extensions_test {

using namespace limn::test;

// Each extension against the equal file without it.

namespace {

Result<GltfScene> parse_square(const std::string& json, std::vector<std::byte> binary) {
    return parse_gltf(make_glb(json, std::move(binary)), "square.glb", "");
}

/// The square with further members at its top level.
Result<GltfScene> parse_with(const std::string& members) {
    return parse_square(
        replace_once(kSquareJson, R"("scene": 0)", R"("scene": 0, )" + members), square_binary());
}

bool warns_of(const GltfScene& scene, const std::string& text) {
    return std::ranges::any_of(
        scene.warnings, [&](const std::string& line) { return line.find(text) != line.npos; });
}

}  // namespace

TEST_CASE("gltf extensions: all required ones that are unknown are named, and what helps") {
    const Result<GltfScene> scene = parse_with(
        R"("extensionsRequired": ["KHR_texture_basisu", "KHR_texture_transform",
           "KHR_draco_mesh_compression", "EXT_new"])");
    REQUIRE_FALSE(scene.ok());
    CHECK(
        scene.error().message
        == "square.glb: extensionsRequired: found \"KHR_texture_basisu\" (convert its textures "
           "with `gltf-transform ktxdecompress in.glb out.glb`), \"KHR_draco_mesh_compression\" "
           "(decompress with `gltf-transform copy in.glb out.glb`), \"EXT_new\" (export the model "
           "without it), expected extensions that can be read");
}

TEST_CASE("gltf extensions: what only changes looks is never refused, but named") {
    for (const std::string name :
         {"KHR_materials_diffuse_transmission", "KHR_materials_new", "KHR_xmp_json_ld",
          "MSFT_lod"}) {
        CAPTURE(name);
        const Result<GltfScene> scene = parse_with(R"("extensionsRequired": [")" + name + R"("])");
        REQUIRE(scene.ok());
        CHECK(scene->meshes.size() == 1);
        CHECK(scene->warnings.size() == 1);
        CHECK(warns_of(*scene, "the extension \"" + name + "\" is ignored"));
    }
}

TEST_CASE("gltf extensions: a primitive whose vertices are not in the file costs that primitive") {
    const std::string end = R"("values": {"bufferView": 3}}})";
    const std::string primitive = R"({"attributes": {"POSITION": 0}, "indices": 1, "material": 0})";
    const auto parse = [&](const std::string& first) {
        const std::string json = replace_once(
            replace_once(
                kSquareJson, end, end + R"(, {"componentType": 5126, "count": 4, "type": "VEC3"},
                           {"componentType": 5123, "count": 6, "type": "SCALAR"})"),
            primitive, first + ", " + primitive);
        return parse_square(json, square_binary());
    };
    const std::string draco =
        R"(, "extensions": {"KHR_draco_mesh_compression": {"bufferView": 2, "attributes": {}}})";
    for (const auto& [written, warning] :
         {std::pair<std::string, std::string>{R"({"attributes": {}})", "has no POSITION"},
          {R"({"attributes": {"POSITION": 3}, "indices": 1)" + draco + "}", "positions are not in"},
          {R"({"attributes": {"POSITION": 0}, "indices": 4})", "indices are not in the file"}}) {
        const std::string& spoiled = written;  // a binding cannot be captured
        CAPTURE(spoiled);
        const Result<GltfScene> scene = parse(spoiled);
        REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
        REQUIRE(scene->meshes.size() == 1);
        CHECK(scene->meshes[0].indices.size() == 6);
        CHECK(warns_of(*scene, "meshes[0].primitives[0] is ignored: "));
        CHECK(warns_of(*scene, warning));
    }
}

TEST_CASE("gltf extensions: a texture in WebP is read, and preferred to its fallback") {
    // Lossless: red, green / blue, white of half opacity.
    const std::vector<std::uint8_t> webp = {
        0x52, 0x49, 0x46, 0x46, 0x30, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42, 0x50, 0x56, 0x50,
        0x38, 0x4c, 0x23, 0x00, 0x00, 0x00, 0x2f, 0x01, 0x40, 0x00, 0x10, 0x1f, 0x20, 0x10,
        0x48, 0xde, 0x1f, 0x3a, 0x8d, 0xf9, 0x17, 0x10, 0x14, 0xfc, 0x1f, 0x9d, 0x80, 0xa0,
        0xe8, 0xba, 0xe5, 0x22, 0x66, 0x0f, 0xc2, 0x0d, 0x18, 0x22, 0xfa, 0x1f, 0x02, 0x00};
    const std::vector<std::uint8_t> pixels = {255, 0, 0,   255, 0,   255, 0,   255,
                                              0,   0, 255, 255, 255, 255, 255, 128};
    std::vector<std::byte> binary = square_binary();
    append_values(binary, webp);
    std::string json = replace_once(
        replace_once(
            kSquareJson, R"("byteOffset": 68, "byteLength": 24})",
            R"("byteOffset": 68, "byteLength": 24},
               {"buffer": 0, "byteOffset": 92, "byteLength": 56})"),
        R"("byteLength": 92)", R"("byteLength": 148)");
    json = replace_once(
        json, R"({"name": "paint"}])",
        R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
           "images": [{"uri": "data:,nothing"}, {"bufferView": 4, "mimeType": "image/webp"}],
           "textures": [{"source": 0, "extensions": {"EXT_texture_webp": {"source": 1}}}],
           "extensionsRequired": ["EXT_texture_webp"])");
    for (const std::string fallback : {R"("source": 0, )", ""}) {
        CAPTURE(fallback);
        const Result<GltfScene> scene =
            parse_square(replace_once(json, R"("source": 0, )", fallback), binary);
        REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
        CHECK(scene->warnings.empty());
        REQUIRE(scene->images.size() == 1);
        CHECK(scene->materials[0].base_color_texture.image.index == 0);
        CHECK(scene->images[0].srgb);
        CHECK(scene->images[0].pixels == pixels);
    }
}

TEST_CASE(
    "gltf extensions: a texture in DDS is preferred, and its fallback used if it is of another kind"
    * technique("engine.opt-texture")) {
    ImageData gray;
    gray.width = gray.height = 4;
    gray.pixels.assign(64, 128);
    std::vector<std::byte> dds = encode_dds(encode_blocks(gray, {}));
    const std::size_t size = dds.size();
    for (const bool known : {true, false}) {
        CAPTURE(known);
        if (!known) {
            dds[128] = std::byte{71};  // BC1
        }
        std::vector<std::byte> binary = square_binary();
        append_values(binary, dds);
        std::string json = replace_once(
            replace_once(
                kSquareJson, R"("byteOffset": 68, "byteLength": 24})",
                fmt::format(
                    R"("byteOffset": 68, "byteLength": 24}},
                       {{"buffer": 0, "byteOffset": 92, "byteLength": {}}})",
                    size)),
            R"("byteLength": 92)", fmt::format(R"("byteLength": {})", 92 + size));
        json = replace_once(
            json, R"({"name": "paint"}])",
            R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
               "images": [{"uri": "data:image/png;base64,)"
            R"(iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="},
               {"bufferView": 4}],
               "textures": [{"source": 0, "extensions": {"MSFT_texture_dds": {"source": 1}}}],
               "extensionsUsed": ["MSFT_texture_dds"])");
        const Result<GltfScene> scene = parse_square(json, binary);
        REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
        CHECK(scene->warnings.empty());
        REQUIRE(scene->images.size() == 1);
        CHECK(scene->images[0].width == (known ? 4 : 1));
        CHECK(scene->images[0].format == (known ? PixelFormat::Bc7 : PixelFormat::Rgba8));
        CHECK(scene->images[0].srgb);
    }
}

TEST_CASE("gltf extensions: the thickness of a volume has a texture with its transform") {
    const std::string json = replace_once(
        kSquareJson, R"({"name": "paint"}])",
        R"({"extensions": {"KHR_materials_transmission": {"transmissionFactor": 1},
            "KHR_materials_volume": {"thicknessFactor": 0.2, "thicknessTexture": {"index": 0,
            "texCoord": 1, "extensions": {"KHR_texture_transform": {"scale": [2, 3]}}}}}}],
            "textures": [{"source": 0}], "images": [{"uri": "data:image/png;base64,)"
        R"(iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="}])");
    const Result<GltfScene> scene = parse_square(json, square_binary());
    REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
    const Material& material = scene->materials[0];
    CHECK(material.thickness == 0.2f);
    REQUIRE(material.thickness_texture.image.index == 0);
    CHECK_FALSE(scene->images[0].srgb);
    CHECK(material.thickness_texture.uv_set == 1);
    CHECK(material.thickness_texture.scale == Vec2(2, 3));
}

TEST_CASE("gltf extensions: a material variant is what the file has with those materials") {
    const std::string variants = R"("extensions": {"KHR_materials_variants": {"mappings": [
        {"material": 1, "variants": [0, 2]}, {"material": 2, "variants": [1]}]}})";
    const std::string json = replace_once(
        replace_once(kSquareJson, R"("material": 0)", R"("material": 0, )" + variants),
        R"({"name": "paint"}])",
        R"({"name": "paint"}, {"name": "street"}, {"name": "beach"}], "extensions": {
           "KHR_materials_variants": {"variants": [{"name": "a"}, {"name": "b"}, {"name": "c"}]}},
           "extensionsRequired": ["KHR_materials_variants"])");
    const std::vector<std::byte> bytes = make_glb(json, square_binary());
    const auto material_of = [&](const std::string& variant) {
        const Result<GltfScene> scene = parse_gltf(bytes, "square.glb", "", {}, variant);
        REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
        CHECK(scene->warnings.empty());
        CHECK(scene->variants == std::vector<std::string>{"a", "b", "c"});
        return scene->materials[scene->nodes[1].parts[0].material].name;
    };
    CHECK(material_of("") == "paint");
    CHECK(material_of("a") == "street");
    CHECK(material_of("b") == "beach");
    CHECK(material_of("c") == "street");
    CHECK(
        parse_gltf(bytes, "square.glb", "", {}, "d").error().message
        == "square.glb: found no material variant \"d\", expected one of a, b, c");
    CHECK(
        parse_gltf(square_glb(), "square.glb", "", {}, "d").error().message
        == "square.glb: found no material variant \"d\", expected none, since the file has none");
    const Result<GltfScene> bad =
        parse_square(replace_once(json, "[0, 2]", "[0, 3]"), square_binary());
    REQUIRE(bad.ok());
    CHECK(warns_of(*bad, "mappings[0].variants[1]: found the number 3"));
}

// ---- instances ----------------------------------------------------------------------------------

namespace {

/// The unit square in z = 0 as the first two lists: positions, indices.
Numbers square_numbers() {
    Numbers numbers;
    numbers.add("VEC3", 3, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    numbers.add_typed<std::uint16_t>("SCALAR", 1, 5123, false, {0, 1, 2, 0, 2, 3});
    return numbers;
}

Result<GltfScene> parse_numbers(const Numbers& numbers, const std::string& rest) {
    const std::string json = R"({"asset": {"version": "2.0"}, )" + numbers.json()
                             + R"(, "meshes": [{"primitives": [
            {"attributes": {"POSITION": 0}, "indices": 1}]}], )"
                             + rest + "}";
    return parse_gltf(make_glb(json, numbers.bytes()), "square.glb", "");
}

/// Where the corners of all drawn squares are, in the order of the nodes.
std::vector<Vec3> drawn_corners(const GltfScene& scene) {
    std::vector<Vec3> corners;
    const std::vector<Affine> matrices = find_node_matrices(scene);
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        for (const GltfPart& part : scene.nodes[i].parts) {
            for (const Vec3& corner : scene.meshes[part.mesh].positions) {
                corners.push_back(transform_point(matrices[i], corner));
            }
        }
    }
    return corners;
}

}  // namespace

TEST_CASE("gltf extensions: instances of a mesh are as many nodes with it") {
    const std::string nodes = R"("nodes": [{"children": [1], "translation": [1, 2, 3]},
        {"mesh": 0, "rotation": [0, 0, 0.6, 0.8], "scale": [2, 2, 2]%s}])";
    const auto parse = [&](const Numbers& numbers, const std::string& more) {
        std::string json = nodes;
        Result<GltfScene> scene = parse_numbers(numbers, replace_once(json, "%s", more));
        REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
        CHECK(scene->warnings.empty());
        CHECK(scene->meshes.size() == 1);
        return *std::move(scene);
    };
    const GltfScene plain = parse(
        square_numbers(),
        R"(, "children": [2, 3]}, {"mesh": 0}, {"mesh": 0, "translation": [5, 0, -1],
           "rotation": [1, 0, 0, 0], "scale": [1, 0.5, 2])");
    std::vector<Vec3> expected = drawn_corners(plain);
    REQUIRE(expected.size() == 12);
    expected.erase(expected.begin(), expected.begin() + 4);  // without that of the node itself

    Numbers numbers = square_numbers();
    numbers.add("VEC3", 3, {0, 0, 0, 5, 0, -1});
    numbers.add_typed<std::int8_t>("VEC4", 4, 5120, true, {0, 0, 0, 127, 127, 0, 0, 0});
    numbers.add("VEC3", 3, {1, 1, 1, 1, 0.5f, 2});
    const GltfScene instanced =
        parse(numbers, R"(, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {
            "TRANSLATION": 2, "ROTATION": 3, "SCALE": 4}}})");
    const std::vector<Vec3> found = drawn_corners(instanced);
    REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        CHECK(glm::distance(found[i], expected[i]) < 1e-5f);
    }
    CHECK(instanced.nodes.size() == 4);
    CHECK(instanced.nodes[1].parts.empty());
}

TEST_CASE("gltf extensions: attributes of instances have as many elements each") {
    Numbers numbers = square_numbers();
    numbers.add("VEC3", 3, {0, 0, 0, 5, 0, -1});
    numbers.add("VEC3", 3, {1, 1, 1});
    const Result<GltfScene> scene =
        parse_numbers(numbers, R"("nodes": [{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {
            "attributes": {"TRANSLATION": 2, "SCALE": 3}}}}])");
    REQUIRE_FALSE(scene.ok());
    CHECK(
        scene.error().message
        == "square.glb: nodes[0].extensions.EXT_mesh_gpu_instancing.attributes.SCALE: found 1 "
           "elements, expected 2 as in the attribute before it");
}

// ---- quantized meshes ---------------------------------------------------------------------------

namespace {

/// Values / `scale` as the file has them: rounded integers, or floats.
template <typename T>
std::vector<T> quantized(const std::vector<float>& values, float scale) {
    std::vector<T> result;
    for (const float value : values) {
        result.push_back(static_cast<T>(std::is_integral_v<T> ? std::round(value * scale) : value));
    }
    return result;
}

struct QuantizedSquare {
    std::vector<float> positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    std::vector<float> normals = {0, 0, 1, 0, 0.6f, 0.8f, 0.8f, 0, -0.6f, -1, 0, 0};
    std::vector<float> tangents = {1, 0, 0, 1, 1, 0, 0, -1, 0, 1, 0, 1, 0, 0, 1, 1};
    std::vector<float> uvs = {0, 0, 1, 0, 0.5f, 0.25f, 0, 1};
    std::vector<float> moves = {0, 0, 0.5f, 0, 0, -0.5f, 0, 0, 0, 0, 0, 0};
};

/// The square with all of its attributes as T, of `component_type`: normalized, or else in units
/// that the node scales back. T is what `max` of it is 1 of.
template <typename T>
GltfScene load_quantized(int component_type, bool normalized) {
    constexpr bool kFloats = !std::is_integral_v<T>;
    const float max = kFloats ? 1.0f : static_cast<float>(std::numeric_limits<T>::max());
    const float scale = normalized || kFloats ? max : 100.0f;
    using Signed =
        std::conditional_t<kFloats, float, std::make_signed_t<std::conditional_t<kFloats, int, T>>>;
    const float signed_max =
        kFloats ? 1.0f : static_cast<float>(std::numeric_limits<Signed>::max());
    const int signed_type = kFloats ? component_type : component_type & ~1;  // 5121 -> 5120
    const QuantizedSquare square;
    Numbers numbers;
    const auto add = [&](const char* type, std::size_t width, const std::vector<float>& values) {
        numbers.add_typed(
            type, width, component_type, normalized && !kFloats, quantized<T>(values, scale));
    };
    const auto add_signed = [&](const char* type, std::size_t width,
                                const std::vector<float>& values, float one, bool is_normalized) {
        numbers.add_typed(
            type, width, signed_type, is_normalized && !kFloats, quantized<Signed>(values, one));
    };
    add("VEC3", 3, square.positions);
    numbers.add_typed<std::uint16_t>("SCALAR", 1, 5123, false, {0, 1, 2, 0, 2, 3});
    add_signed("VEC3", 3, square.normals, signed_max, true);
    add_signed("VEC4", 4, square.tangents, signed_max, true);
    numbers.add_typed("VEC2", 2, component_type, !kFloats, quantized<T>(square.uvs, max));
    const float signed_scale = normalized ? signed_max : scale;
    add_signed("VEC3", 3, square.moves, signed_scale, normalized);
    const std::string json =
        R"({"asset": {"version": "2.0"}, "extensionsRequired": ["KHR_mesh_quantization"], )"
        + numbers.json() + R"(, "meshes": [{"primitives": [{"attributes": {"POSITION": 0,
            "NORMAL": 2, "TANGENT": 3, "TEXCOORD_0": 4}, "indices": 1,
            "targets": [{"POSITION": 5}]}]}], "nodes": [{"mesh": 0, "scale": [)"
        + fmt::format("{0}, {0}, {0}", normalized || kFloats ? 1.0f : 1 / scale) + "]}]}";
    Result<GltfScene> scene = parse_gltf(make_glb(json, numbers.bytes()), "square.glb", "");
    REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
    CHECK(scene->warnings.empty());
    return *std::move(scene);
}

template <typename T>
float largest_distance(const std::vector<T>& a, const std::vector<T>& b, float scale = 1) {
    REQUIRE(a.size() == b.size());
    float largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        largest = std::max(largest, glm::distance(scale * a[i], b[i]));
    }
    return largest;
}

}  // namespace

TEST_CASE("gltf extensions: quantized attributes of every type are those of the plain mesh") {
    const GltfScene plain = load_quantized<float>(5126, false);
    const MeshData& expected = plain.meshes[0];
    const auto check = [&](const GltfScene& scene, float step) {
        CAPTURE(step);
        const MeshData& mesh = scene.meshes[0];
        const float scale = scene.nodes[0].transform.scale.x;
        CHECK(largest_distance(drawn_corners(scene), drawn_corners(plain)) < 1e-5f);
        CHECK(largest_distance(mesh.normals, expected.normals) < 2 * step);
        CHECK(largest_distance(mesh.tangents, expected.tangents) < 2 * step);
        CHECK(largest_distance(mesh.uvs, expected.uvs) < 2 * step);
        REQUIRE(mesh.morphs.size() == 1);
        CHECK(mesh.morphs[0].vertices == expected.morphs[0].vertices);
        CHECK(
            largest_distance(mesh.morphs[0].positions, expected.morphs[0].positions, scale)
            < 2 * step);
    };
    constexpr float kByte = 1.0f / 127;
    constexpr float kShort = 1.0f / 32767;
    for (const bool normalized : {false, true}) {
        CAPTURE(normalized);
        check(load_quantized<std::int8_t>(5120, normalized), kByte);
        check(load_quantized<std::uint8_t>(5121, normalized), kByte);
        check(load_quantized<std::int16_t>(5122, normalized), kShort);
        check(load_quantized<std::uint16_t>(5123, normalized), kShort);
    }
}

}  // namespace limn::gltf_extensions_test
