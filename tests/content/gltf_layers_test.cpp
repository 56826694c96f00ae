#include "content/load/gltf/gltf_write.h"
#include "tests/content/gltf_spoiled.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace limn::gltf_layers_test {

using namespace limn::test;

namespace {

/// The material of the square with these members.
Result<GltfScene> painted(const std::string& members) {
    const std::string json =
        replace_once(kSquareJson, R"([{"name": "paint"}])", "[{" + members + "}]");
    return parse_gltf(make_glb(json, square_binary()), "square.glb", "");
}

/// Of a pixel.
const std::string kImage =
    R"("data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==")";

const std::string kEveryFactor = R"("extensions": {
    "KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.25},
    "KHR_materials_sheen": {"sheenColorFactor": [0.1, 0.2, 0.3], "sheenRoughnessFactor": 0.4},
    "KHR_materials_specular": {"specularFactor": 0.75, "specularColorFactor": [1, 2, 3]},
    "KHR_materials_anisotropy": {"anisotropyStrength": 0.6, "anisotropyRotation": -1.5},
    "KHR_materials_iridescence": {"iridescenceFactor": 0.9, "iridescenceIor": 1.75,
        "iridescenceThicknessMinimum": 150, "iridescenceThicknessMaximum": 650},
    "KHR_materials_ior": {"ior": 1.75},
    "KHR_materials_dispersion": {"dispersion": 0.5},
    "KHR_materials_volume": {"thicknessFactor": 0.25, "attenuationDistance": 2,
        "attenuationColor": [0.5, 1, 1]},
    "KHR_materials_transmission": {"transmissionFactor": 0.5}})";

void check_every_factor(const Material& m) {
    CHECK(m.clearcoat == 0.5f);
    CHECK(m.clearcoat_roughness == 0.25f);
    CHECK(m.sheen == Vec3(0.1f, 0.2f, 0.3f));
    CHECK(m.sheen_roughness == 0.4f);
    CHECK(m.specular_weight == 0.75f);
    CHECK(m.specular_tint == Vec3(1, 2, 3));
    CHECK(m.anisotropy == 0.6f);
    CHECK(m.anisotropy_rotation == -1.5f);
    CHECK(m.iridescence == 0.9f);
    CHECK(m.iridescence_index == 1.75f);
    CHECK(m.iridescence_thickness == Vec2(150, 650));
    CHECK(m.refractive_index == 1.75f);
    CHECK(m.dispersion == 0.5f);
    CHECK(m.thickness == 0.25f);
    CHECK(m.attenuation_color == Vec3(0.5f, 1, 1));
    CHECK(m.attenuation_distance == 2);
    CHECK(m.transmission == 0.5f);
}

}  // namespace

TEST_CASE(
    "gltf layers: factors of all extensions are read, and written again"
    * technique("shade.clear-coat, shade.sheen, shade.dielectric-specular, "
                "shade.anisotropic-specular, shade.thin-film, shade.dispersion")) {
    const Result<GltfScene> scene = painted(kEveryFactor);
    REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
    CHECK(scene->warnings.empty());
    check_every_factor(scene->materials[0]);
    const Result<std::vector<std::byte>> bytes = write_glb(*scene);
    REQUIRE(bytes.ok());
    const Result<GltfScene> read = parse_gltf(*bytes, "written.glb", "");
    REQUIRE_MESSAGE(read.ok(), (read ? "" : read.error().message));
    CHECK(read->warnings.empty());
    check_every_factor(read->materials[0]);
}

TEST_CASE("gltf layers: without members an extension has the defaults of its specification") {
    const Result<GltfScene> scene = painted(R"("extensions": {
        "KHR_materials_clearcoat": {}, "KHR_materials_sheen": {}, "KHR_materials_specular": {},
        "KHR_materials_anisotropy": {}, "KHR_materials_iridescence": {},
        "KHR_materials_dispersion": {}})");
    REQUIRE(scene.ok());
    CHECK(scene->warnings.empty());
    const Material& m = scene->materials[0];
    CHECK(m.clearcoat == 0);
    CHECK(m.clearcoat_roughness == 0);
    CHECK(m.sheen == Vec3(0));
    CHECK(m.sheen_roughness == 0);
    CHECK(m.specular_weight == 1);
    CHECK(m.specular_tint == Vec3(1));
    CHECK(m.anisotropy == 0);
    CHECK(m.anisotropy_rotation == 0);
    CHECK(m.iridescence == 0);
    CHECK(m.iridescence_index == 1.3f);
    CHECK(m.iridescence_thickness == Vec2(100, 400));
    CHECK(m.dispersion == 0);
}

TEST_CASE("gltf layers: colors are sRGB, other maps are data, each with its transform") {
    const std::pair<const char*, std::pair<const char*, TextureSlot Material::*>> maps[] = {
        {"clearcoat", {"clearcoatTexture", &Material::clearcoat_texture}},
        {"clearcoat", {"clearcoatRoughnessTexture", &Material::clearcoat_roughness_texture}},
        {"clearcoat", {"clearcoatNormalTexture", &Material::clearcoat_normal_texture}},
        {"sheen", {"sheenColorTexture", &Material::sheen_texture}},
        {"sheen", {"sheenRoughnessTexture", &Material::sheen_roughness_texture}},
        {"specular", {"specularTexture", &Material::specular_weight_texture}},
        {"specular", {"specularColorTexture", &Material::specular_tint_texture}},
        {"anisotropy", {"anisotropyTexture", &Material::anisotropy_texture}},
        {"iridescence", {"iridescenceTexture", &Material::iridescence_texture}},
        {"iridescence", {"iridescenceThicknessTexture", &Material::iridescence_thickness_texture}},
        {"transmission", {"transmissionTexture", &Material::transmission_texture}}};
    for (const auto& [extension, map] : maps) {
        const std::string member = map.first;
        CAPTURE(member);
        std::string json = replace_once(
            kSquareJson, R"([{"name": "paint"}])",
            R"([{"extensions": {"KHR_materials_)" + std::string(extension) + R"(": {)"
                + (extension == std::string("transmission") ? R"("transmissionFactor": 1, )" : "")
                + "\"" + member
                + R"(": {"index": 0, "texCoord": 1, "extensions": {"KHR_texture_transform":
                {"scale": [2, 3]}}}}}}], "textures": [{"source": 0}], "images": [{"uri": )"
                + kImage + "}]");
        const Result<GltfScene> scene =
            parse_gltf(make_glb(json, square_binary()), "square.glb", "");
        REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
        CHECK(scene->warnings.empty());
        REQUIRE(scene->images.size() == 1);
        CHECK(scene->images[0].srgb == (member.find("ColorTexture") != member.npos));
        const auto bytes = write_glb(*scene);
        REQUIRE(bytes.ok());
        const Result<GltfScene> written = parse_gltf(*bytes, "written.glb", "");
        REQUIRE(written.ok());
        CHECK(written->warnings.empty());
        for (const GltfScene* const read : {&*scene, &*written}) {
            const TextureSlot& slot = read->materials[0].*map.second;
            CHECK(slot.image.index == 0);
            CHECK(slot.uv_set == 1);
            CHECK(slot.scale == Vec2(2, 3));
        }
    }
}

TEST_CASE("gltf layers: the strength of the clear coat's normal map is read, and written again") {
    const std::string json = replace_once(
        kSquareJson, R"([{"name": "paint"}])",
        R"([{"extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1,
        "clearcoatNormalTexture": {"index": 0, "scale": -0.5}}}}],
        "textures": [{"source": 0}], "images": [{"uri": )"
            + std::string(kImage) + "}]");
    const Result<GltfScene> scene = parse_gltf(make_glb(json, square_binary()), "square.glb", "");
    REQUIRE(scene.ok());
    CHECK(scene->warnings.empty());
    CHECK(scene->materials[0].clearcoat_normal_scale == -0.5f);
    const auto bytes = write_glb(*scene);
    REQUIRE(bytes.ok());
    const Result<GltfScene> written = parse_gltf(*bytes, "written.glb", "");
    REQUIRE(written.ok());
    CHECK(written->materials[0].clearcoat_normal_scale == -0.5f);
}

TEST_CASE("gltf layers: a bad part costs that part") {
    const std::string from = R"("name": "paint")";
    const std::string at = "materials[0].extensions.KHR_materials_";
    check_all_drawn({
        {from, R"("extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 2}})",
         at
             + "clearcoat.clearcoatFactor: found the number 2, expected a number from 0 to 1; it "
               "is "
               "clamped"},
        {from, R"("extensions": {"KHR_materials_clearcoat": 7})",
         at + "clearcoat: found the number 7, expected an object; it is left out"},
        {from, R"("extensions": {"KHR_materials_sheen": {"sheenColorFactor": [1, 1]}})",
         at
             + "sheen.sheenColorFactor: found an array of 2, expected 3 numbers from 0 to 1; it is "
               "left out"},
        {from, R"("extensions": {"KHR_materials_specular": {"specularColorFactor": [1, -1, 1]}})",
         at + "specular.specularColorFactor[1]: found the number -1"},
        {from, R"("extensions": {"KHR_materials_anisotropy": {"anisotropyRotation": "x"}})",
         at + "anisotropy.anisotropyRotation: found the string \"x\""},
        {from, R"("extensions": {"KHR_materials_iridescence": {"iridescenceIor": 0.5}})",
         at
             + "iridescence.iridescenceIor: found the number 0.5, expected a number from 1 to 5; "
               "it "
               "is clamped"},
        {from, R"("extensions": {"KHR_materials_dispersion": {"dispersion": -1}})",
         at + "dispersion.dispersion: found the number -1"},
        {from, R"("extensions": {"KHR_materials_clearcoat": {"clearcoatTexture": {"index": 0}}})",
         at + "clearcoat.clearcoatTexture.index: found the number 0, expected no index"},
    });
    const Result<GltfScene> scene = painted(
        R"("extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": [], "clearcoatRoughnessFactor": 0.5},
            "KHR_materials_sheen": {"sheenRoughnessFactor": 0.25}})");
    REQUIRE(scene.ok());
    CHECK(scene->materials[0].clearcoat == 0);
    CHECK(scene->materials[0].clearcoat_roughness == 0.5f);
    CHECK(scene->materials[0].sheen_roughness == 0.25f);
}

TEST_CASE("gltf layers: the index 0 of an opaque material stands for full reflectance head on") {
    const Result<GltfScene> scene = painted(
        R"("extensions": {"KHR_materials_ior": {"ior": 0},
            "KHR_materials_specular": {"specularColorFactor": [0.5, 0.25, 1]}})");
    REQUIRE(scene.ok());
    const Material& m = scene->materials[0];
    const float head_on = square((m.refractive_index - 1) / (m.refractive_index + 1));
    CHECK(head_on * m.specular_tint.x == near(0.5));
    CHECK(head_on * m.specular_tint.z == near(1));
}

}  // namespace limn::gltf_layers_test
