#include "content/load/gltf/gltf_load.h"
#include "tests/content/gltf_samples.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace limn::gltf_rare_test {

using namespace limn::test;

// Valid files that exporters seldom write.

namespace {

Result<GltfScene> load_edited(const std::string& from, const std::string& to) {
    const std::string json = replace_once(kSquareJson, from, to);
    return parse_gltf(make_glb(json, square_binary()), "square.glb", "");
}

/// The square is there, with one warning that contains `expected`; none if that is empty.
void check_square(const Result<GltfScene>& scene, const std::string& expected) {
    REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
    REQUIRE(scene->meshes.size() == 1);
    CHECK(scene->meshes[0].positions.size() == 4);
    REQUIRE(scene->warnings.size() == (expected.empty() ? 0 : 1));
    if (!expected.empty()) {
        CAPTURE(scene->warnings[0]);
        CHECK(scene->warnings[0].find(expected) != std::string::npos);
    }
}

constexpr const char* kPaint = R"({"name": "paint"}])";

}  // namespace

TEST_CASE("gltf: integers may have an exponent or a fraction of zero, others are refused") {
    check_square(load_edited(R"("material": 0)", R"("material": 0e0)"), "");
    check_square(load_edited(R"("byteLength": 92)", R"("byteLength": 9.2e1)"), "");
    CHECK_FALSE(load_edited(R"("mesh": 0)", R"("mesh": 0.5)").ok());
    CHECK_FALSE(load_edited(R"("mesh": 0)", R"("mesh": -1)").ok());
    CHECK_FALSE(load_edited(R"("byteLength": 92)", R"("byteLength": 1e300)").ok());
}

TEST_CASE("gltf: bytes after a GLB are ignored with a warning") {
    for (const std::size_t more : {std::size_t{1}, std::size_t{5}, std::size_t{400}}) {
        std::vector<std::byte> bytes = square_glb();
        bytes.resize(bytes.size() + more, std::byte{7});
        check_square(
            parse_gltf(bytes, "square.glb", ""), std::to_string(more) + " bytes after the GLB");
    }
}

TEST_CASE("gltf: each extension that is ignored is named once") {
    check_square(load_edited(R"("scene": 0)", R"("extensionsUsed": ["KHR_materials_unlit"])"), "");
    check_square(
        load_edited(
            R"("scene": 0)",
            R"("extensionsUsed": ["KHR_materials_new", "KHR_materials_new", "KHR_lights_punctual"])"),
        "square.glb: the extension \"KHR_materials_new\" is ignored");
    // Also one that the file has, but does not list; not what an application put into extras.
    check_square(
        load_edited(R"("scene": 0)", R"("scene": 0, "extensions": {"EXT_other": {}},
                "extras": {"extensions": {"MY_own": {}}})"),
        "square.glb: the extension \"EXT_other\" is ignored");
}

TEST_CASE("gltf: data URIs may be percent-encoded text") {
    std::string uri = "data:application/octet-stream,";
    for (const std::byte byte : square_binary()) {
        constexpr const char* kDigits = "0123456789abcdef";
        uri += '%';
        uri += kDigits[std::to_integer<unsigned>(byte) >> 4];
        uri += kDigits[std::to_integer<unsigned>(byte) & 15];
    }
    const std::string json = replace_once(
        kSquareJson, R"({"byteLength": 92})", R"({"byteLength": 92, "uri": ")" + uri + "\"}");
    check_square(parse_gltf(std::as_bytes(std::span(json)), "square.gltf", ""), "");
}

TEST_CASE("gltf: a buffer without data may be there if nothing reads it") {
    check_square(
        load_edited(R"({"byteLength": 92})", R"({"byteLength": 92}, {"byteLength": 4000000000})"),
        "buffers[1]: it has no data");
}

TEST_CASE("gltf: types that glTF does not have may be there if nothing reads them") {
    const std::string end = R"("values": {"bufferView": 3}}})";
    check_square(
        load_edited(end, end + R"(, {"componentType": 5126, "count": 1, "type": "MAT5"})"),
        "accessors[3].type: found the string \"MAT5\"");
    check_square(
        load_edited(end, end + R"(, {"componentType": 5124, "count": 1, "type": "VEC2"})"),
        "accessors[3].componentType: found the number 5124");
}

TEST_CASE("gltf: a light of unknown type shines nothing, with a warning") {
    const auto with_light = [](const char* type) {
        const std::string json = replace_once(
            replace_once(
                kSquareJson, R"("mesh": 0)",
                R"("mesh": 0, "extensions": {"KHR_lights_punctual": {"light": 0}})"),
            kPaint,
            std::string(kPaint)
                + R"(, "extensions": {"KHR_lights_punctual": {"lights": [{"type": ")" + type
                + R"("}]}})");
        return parse_gltf(make_glb(json, square_binary()), "square.glb", "");
    };
    const Result<GltfScene> area = with_light("area");
    check_square(area, "lights[0] is ignored: its type is \"area\"");
    check_square(with_light("point"), "");
}

TEST_CASE("gltf: cameras of any field of view and any height leave the file readable") {
    const auto with_camera = [](const std::string& camera) {
        const std::string json = replace_once(
            replace_once(kSquareJson, R"("mesh": 0)", R"("mesh": 0, "camera": 0)"), kPaint,
            std::string(kPaint) + R"(, "cameras": [)" + camera + "]");
        return parse_gltf(make_glb(json, square_binary()), "square.glb", "");
    };
    const auto perspective = [&](const char* yfov) {
        return with_camera(
            std::string(R"({"type": "perspective", "perspective": {"znear": 0.1, "yfov": )") + yfov
            + "}}");
    };
    check_square(perspective("1"), "");
    check_square(perspective("3.1415926"), "yfov: found 3.141592");
    check_square(perspective("0.0001"), "yfov: found 0.0001");
    check_square(perspective("3.2"), "yfov: found the number 3.2");
    check_square(perspective("0"), "yfov: found the number 0");
    check_square(
        with_camera(
            R"({"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 0, "znear": 0, "zfar": 1}})"),
        "cameras[0].orthographic.ymag: found 0, shown as 0.0001");
    check_square(
        with_camera(R"({"type": "perspective"})"), "cameras[0].perspective: found nothing");
}

TEST_CASE("gltf: points, lines, strips and fans become triangles") {
    // Four points of 8 triangles; two, four and three lines of 6; one triangle and a vertex too
    // many; strip and fan.
    constexpr std::size_t kIndices[] = {4 * 24, 2 * 18, 4 * 18, 3 * 18, 3, 6, 6};
    for (const int mode : {0, 1, 2, 3, 4, 5, 6}) {
        CAPTURE(mode);
        const Result<GltfScene> scene =
            load_edited(R"("indices": 1)", R"("mode": )" + std::to_string(mode));
        REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
        CHECK(scene->warnings.size() == (mode == 4 ? 1 : 0));
        REQUIRE(scene->meshes.size() == 1);
        CHECK(scene->meshes[0].indices.size() == kIndices[mode]);
    }
}

}  // namespace limn::gltf_rare_test
