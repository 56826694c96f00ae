#include "content/load/files/png_file.h"
#include "content/load/gltf/gltf_glossiness.h"
#include "content/load/gltf/gltf_load.h"
#include "ecs/base/srgb.h"
#include "tests/content/gltf_samples.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace limn::gltf_glossiness_test {

using namespace limn::test;

// KHR_materials_pbrSpecularGlossiness against what it means in metallic-roughness.

namespace {

/// The square with one glossy material; `images` are PNGs, which its textures have by number.
GltfScene
load_glossy(const std::string& extension, const std::vector<std::vector<std::uint8_t>>& images) {
    std::vector<std::byte> binary = square_binary();
    std::string views = R"("byteOffset": 68, "byteLength": 24})";
    std::string list;
    std::string textures;
    for (std::size_t i = 0; i < images.size(); ++i) {
        views += fmt::format(
            R"(,{{"buffer": 0, "byteOffset": {}, "byteLength": {}}})", binary.size(),
            images[i].size());
        list += fmt::format(R"({}{{"bufferView": {}}})", i > 0 ? "," : "", 4 + i);
        textures += fmt::format(R"({}{{"source": {}}})", i > 0 ? "," : "", i);
        append_values(binary, images[i]);
    }
    std::string json = replace_once(
        replace_once(kSquareJson, R"("byteOffset": 68, "byteLength": 24})", views),
        R"("byteLength": 92)", fmt::format(R"("byteLength": {})", binary.size()));
    json = replace_once(
        json, R"({"name": "paint"}])",
        R"({"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 1, 1]},
            "extensions": {"KHR_materials_pbrSpecularGlossiness": )"
            + extension + R"(}}], "extensionsRequired": ["KHR_materials_pbrSpecularGlossiness"])"
            + (images.empty()
                   ? ""
                   : R"(, "images": [)" + list + R"(], "textures": [)" + textures + "]"));
    Result<GltfScene> scene = parse_gltf(make_glb(json, binary), "square.glb", "");
    REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
    CHECK(scene->warnings.empty());
    return *std::move(scene);
}

bool near(float a, float b, float tolerance) {
    return std::abs(a - b) <= tolerance;
}

Vec3 linear(const std::uint8_t* texel) {
    return {
        linear_from_srgb(static_cast<float>(texel[0]) / 255),
        linear_from_srgb(static_cast<float>(texel[1]) / 255),
        linear_from_srgb(static_cast<float>(texel[2]) / 255)};
}

}  // namespace

TEST_CASE("gltf glossiness: dielectrics, metals and gray mixtures are found again") {
    const Vec3 red = {0.7f, 0.1f, 0.05f};
    const Vec3 gold = {1.0f, 0.71f, 0.29f};
    const MetallicRoughness plastic = metallic_from_specular(red, Vec3(0.04f), 0.3f);
    CHECK(plastic.metalness == 0);
    CHECK(plastic.roughness == 0.7f);
    CHECK(glm::distance(plastic.base_color, red) < 1e-6f);
    const MetallicRoughness metal = metallic_from_specular(Vec3(0), gold, 1);
    CHECK(near(metal.metalness, 1, 1e-5f));
    CHECK(glm::distance(metal.base_color, gold) < 1e-4f);
    // The inverse of gray: specular = mix(0.04, base, m), diffuse has the rest.
    for (const float base : {0.1f, 0.5f, 0.9f}) {
        for (const float m : {0.0f, 0.2f, 0.5f, 0.8f}) {
            CAPTURE(base);
            CAPTURE(m);
            const float specular = 0.04f * (1 - m) + base * m;
            const float diffuse = base * 0.96f * (1 - m) / (1 - specular);
            const MetallicRoughness found =
                metallic_from_specular(Vec3(diffuse), Vec3(specular), 0.5f);
            CHECK(near(found.metalness, m, 1e-4f));
            CHECK(near(found.base_color.x, base, 1e-3f));
        }
    }
}

TEST_CASE("gltf glossiness: factors alone make the material that says the same") {
    const GltfScene scene = load_glossy(
        R"({"diffuseFactor": [0.2, 0.4, 0.6, 0.5], "specularFactor": [0.04, 0.04, 0.04],
            "glossinessFactor": 0.25})",
        {});
    const Material& material = scene.materials[0];
    CHECK(glm::distance(material.base_color, Vec4(0.2f, 0.4f, 0.6f, 0.5f)) < 1e-6f);
    CHECK(material.metalness == 0);
    CHECK(material.roughness == 0.75f);
    const GltfScene mirror = load_glossy(R"({"diffuseFactor": [0, 0, 0, 1]})", {});
    CHECK(near(mirror.materials[0].metalness, 1, 1e-5f));
    CHECK(mirror.materials[0].roughness == 0);
    CHECK(glm::distance(Vec3(mirror.materials[0].base_color), Vec3(1)) < 1e-4f);
}

TEST_CASE("gltf glossiness: textures are converted texel by texel into new images") {
    const std::vector<std::uint8_t> diffuse = {200, 100, 50, 255, 0, 0, 0, 128};
    const std::vector<std::uint8_t> gloss = {56, 56, 56, 204, 255, 219, 145, 51};
    const std::string factors = R"({"glossinessFactor": 0.5, "diffuseFactor": [0.5, 1, 1, 1])";
    const auto png = [](const std::vector<std::uint8_t>& pixels) {
        return png_bytes(2, 1, 4, pixels).value();
    };
    const GltfScene scene = load_glossy(
        factors + R"(, "diffuseTexture": {"index": 0}, "specularGlossinessTexture": {"index": 1}})",
        {png(diffuse), png(gloss)});
    const Material& material = scene.materials[0];
    REQUIRE(scene.images.size() == 2);  // those of the file are gone
    CHECK(material.base_color == Vec4(1));
    CHECK(material.metalness == 1);
    CHECK(material.roughness == 1);
    const ImageData& color = scene.images[material.base_color_texture.image.index];
    const ImageData& surface = scene.images[material.metal_rough_texture.image.index];
    CHECK(color.srgb);
    CHECK_FALSE(surface.srgb);
    for (std::size_t texel = 0; texel < 2; ++texel) {
        const std::size_t at = 4 * texel;
        const MetallicRoughness expected = metallic_from_specular(
            Vec3(0.5f, 1, 1) * linear(&diffuse[at]), linear(&gloss[at]),
            0.5f * static_cast<float>(gloss[at + 3]) / 255);
        CHECK(glm::distance(linear(&color.pixels[at]), expected.base_color) < 0.01f);
        CHECK(color.pixels[at + 3] == diffuse[at + 3]);
        CHECK(near(static_cast<float>(surface.pixels[at + 1]) / 255, expected.roughness, 0.003f));
        CHECK(near(static_cast<float>(surface.pixels[at + 2]) / 255, expected.metalness, 0.003f));
    }
    CHECK(surface.pixels[2] < 5);     // plastic
    CHECK(surface.pixels[6] > 250);   // gold
    CHECK(surface.pixels[1] == 153);  // 1 - 0.5 * 204 / 255
}

TEST_CASE("gltf glossiness: one texture of the two is enough") {
    const std::vector<std::uint8_t> white = {255, 255, 255, 255};
    const GltfScene scene = load_glossy(
        R"({"diffuseFactor": [0, 0, 0, 1], "specularGlossinessTexture": {"index": 0}})",
        {png_bytes(1, 1, 4, white).value()});
    REQUIRE(scene.images.size() == 2);
    CHECK(scene.images[0].pixels == white);
    CHECK(scene.images[1].pixels == std::vector<std::uint8_t>{255, 0, 255, 255});
}

}  // namespace limn::gltf_glossiness_test
