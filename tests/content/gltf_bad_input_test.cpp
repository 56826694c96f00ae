#include "content/load/files/png_file.h"
#include "tests/content/gltf_spoiled.h"

#include <vector>

namespace limn::gltf_bad_input_test {

using namespace limn::test;

TEST_CASE("gltf: what is no file of glTF is refused") {
    const TemporaryFolder folder;
    CHECK(mentions(load_gltf(folder.file("no.glb")).error().message, "no such file"));
    CHECK(mentions(load_gltf(folder.path()).error().message, "found a folder"));
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
                CHECK_FALSE(mentions(scene.error().message, "\n"));
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

TEST_CASE("gltf: a buffer without bytes is refused") {
    const std::string json = kSquareJson;
    check_refused(
        parse_gltf(std::as_bytes(std::span(json)), "square.gltf", ""),
        "accessors[0]: found bufferViews[0] in a buffer without data");
    check_refused(
        parse_gltf(make_glb(json, {}), "square.glb", ""),
        "accessors[0]: found bufferViews[0] in a buffer without data");
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
    CHECK(mentions(scene->warnings[0], "found 8 x 8 pixels"));
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
