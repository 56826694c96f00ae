#include "content/load/files/png_check.h"
#include "content/load/files/png_file.h"
#include "tests/content/gltf_spoiled.h"

#include <filesystem>
#include <utility>
#include <vector>

namespace limn::gltf_bad_image_test {

using namespace limn::test;

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
        check_square(scene, expected, mentions(expected, "textures: ") ? 3 : 1);
        CHECK(scene->materials[0].normal_texture.image.index == kNoAsset);
        CHECK(scene->materials[1].emission_texture.image.index == kNoAsset);
    }
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
        CHECK_MESSAGE(mentions(scene->warnings.back(), expected), scene->warnings.back());
        CHECK(mentions(scene->warnings.back(), "; materials are without it"));
        CHECK(scene->images.empty());
        CHECK(scene->materials[0].base_color_texture.image.index == kNoAsset);
        const Result<GltfScene> strict = load_gltf(folder.file("square.glb"), {}, {.strict = true});
        REQUIRE_FALSE(strict.ok());
        CHECK(mentions(strict.error().message, expected));
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
    CHECK(mentions(scene->warnings[0], "images[1].uri: \"b.png\": no such file"));
    REQUIRE(scene->images.size() == 2);
    const Material& material = scene->materials[0];
    CHECK(scene->images[material.base_color_texture.image.index].name == "a.png");
    CHECK(scene->images[material.occlusion_texture.image.index].name == "c.png");
    CHECK(material.normal_texture.image.index == kNoAsset);
    CHECK(material.emission_texture.image.index == kNoAsset);
}

}  // namespace limn::gltf_bad_image_test
