#include "bench/oracles/layers_oracle.h"
#include "bench/oracles/light_oracle.h"
#include "content/load/files/png_file.h"
#include "content/load/gltf/gltf_load.h"
#include "tests/content/gltf_samples.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

// Extensions of glTF materials, from a file to pixels, against their formulas in double precision:
// a ball whose right half has the extension and whose left half has it taken away by a texture.

namespace limn::test::gltf_materials_test {
namespace {

using oracle::DVec3;
using oracle::LayeredMaterial;
using TexelBytes = std::array<std::uint8_t, 4>;

constexpr int kSide = 64;  ///< of the images [px]
const DVec3 kEye = {0, 0, 3.2};
constexpr Vec3 kLamp = {0.8f, 1.3f, 2.4f};
const PointLight kLight = {.color = {1, 0.9f, 0.8f}, .intensity = 12, .radius = 0};

struct ExtendedBall {
    std::string name;
    std::string extension;  ///< JSON; textures 0, 1 ...
    std::vector<std::pair<TexelBytes, TexelBytes>>
        textures;  ///< texels of the right and of the left half
    LayeredMaterial right;
    LayeredMaterial left;
    std::string base = R"("baseColorFactor": [0.5, 0.2, 0.1, 1], "metallicFactor": 0,
        "roughnessFactor": 0.6)";
};

double decoded(int byte) {  // of sRGB
    const double x = byte / 255.0;
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

std::vector<ExtendedBall> extended_balls() {
    const LayeredMaterial cloth = {.albedo = {0.5, 0.2, 0.1}, .roughness = 0.6};
    LayeredMaterial velvet = cloth;
    velvet.sheen = DVec3(0.9, 0.8, 0.6) * DVec3(decoded(255), decoded(188), decoded(255));
    velvet.sheen_roughness = 0.8 * 128 / 255;
    LayeredMaterial lacquer = cloth;
    lacquer.specular_weight = 0.9 * 204 / 255;
    lacquer.specular_tint = DVec3(1, 3, 2) * DVec3(decoded(255), decoded(188), decoded(120));
    LayeredMaterial dull = cloth;
    dull.specular_weight = 0;
    LayeredMaterial steel = {.albedo = {0.5, 0.2, 0.1}, .metalness = 1, .roughness = 0.4};
    LayeredMaterial brushed = steel;
    brushed.anisotropy = 0.9 * 204 / 255;
    return {
        {"sheen",
         R"("KHR_materials_sheen": {"sheenColorFactor": [0.9, 0.8, 0.6],
            "sheenRoughnessFactor": 0.8, "sheenColorTexture": {"index": 0},
            "sheenRoughnessTexture": {"index": 1}})",
         {{{255, 188, 255, 255}, {0, 0, 0, 255}}, {{0, 0, 0, 128}, {0, 0, 0, 128}}},
         velvet,
         cloth},
        {"specular",
         R"("KHR_materials_specular": {"specularFactor": 0.9, "specularColorFactor": [1, 3, 2],
            "specularTexture": {"index": 0}, "specularColorTexture": {"index": 1}})",
         {{{9, 9, 9, 204}, {9, 9, 9, 0}}, {{255, 188, 120, 255}, {255, 188, 120, 255}}},
         lacquer,
         dull},
        {"anisotropy",  // along the bitangent: (0, 1) is a quarter turn from the tangent
         R"("KHR_materials_anisotropy": {"anisotropyStrength": 0.9,
            "anisotropyTexture": {"index": 0}})",
         {{{128, 255, 204, 255}, {128, 255, 0, 255}}},
         brushed,
         steel,
         R"("baseColorFactor": [0.5, 0.2, 0.1, 1], "metallicFactor": 1, "roughnessFactor": 0.4)"}};
}

DVec3 tangent_at(const DVec3& point) {  // east
    return glm::normalize(DVec3(point.z, 0, -point.x));
}

/// A unit ball; u runs east from the meridian of +z, v from pole to pole.
void add_ball(Numbers& numbers) {
    constexpr int kRings = 64;
    constexpr int kSectors = 128;
    std::vector<float> positions;
    std::vector<float> tangents;
    std::vector<float> uvs;
    std::vector<std::uint32_t> indices;
    for (int r = 0; r <= kRings; ++r) {
        for (int s = 0; s <= kSectors; ++s) {
            const float polar = kPi * static_cast<float>(r) / kRings;
            const float around = 2 * kPi * static_cast<float>(s) / kSectors;
            positions.insert(
                positions.end(), {std::sin(polar) * std::sin(around), std::cos(polar),
                                  std::sin(polar) * std::cos(around)});
            tangents.insert(tangents.end(), {std::cos(around), 0, -std::sin(around), 1});
            uvs.insert(
                uvs.end(), {static_cast<float>(s) / kSectors, static_cast<float>(r) / kRings});
            if (r < kRings && s < kSectors) {
                const auto a = static_cast<std::uint32_t>(r * (kSectors + 1) + s);
                const std::uint32_t b = a + kSectors + 1;
                indices.insert(indices.end(), {a, b, b + 1, a, b + 1, a + 1});
            }
        }
    }
    numbers.add("VEC3", 3, positions);
    numbers.add("VEC3", 3, positions);  // normals
    numbers.add("VEC4", 4, tangents);
    numbers.add("VEC2", 2, uvs);
    numbers.add_typed("SCALAR", 1, 5125, false, indices);
}

/// The file of a ball; without its extension if `plain`.
std::vector<std::byte> ball_glb(const ExtendedBall& ball, bool plain) {
    Numbers numbers;
    add_ball(numbers);
    std::string images;
    std::string textures;
    for (std::size_t i = 0; i < ball.textures.size(); ++i) {
        std::vector<std::uint8_t> pixels;
        for (const TexelBytes& texel : {ball.textures[i].first, ball.textures[i].second}) {
            pixels.insert(pixels.end(), texel.begin(), texel.end());
        }
        numbers.add_typed("SCALAR", 1, 5121, false, png_bytes(2, 1, 4, pixels).value());
        images += fmt::format(
            R"({}{{"bufferView": {}, "mimeType": "image/png"}})", i > 0 ? ", " : "", 5 + i);
        textures += fmt::format(R"({}{{"source": {}, "sampler": 0}})", i > 0 ? ", " : "", i);
    }
    return make_glb(
        fmt::format(
            R"({{"asset": {{"version": "2.0"}}, {}, "images": [{}], "textures": [{}],
            "samplers": [{{"magFilter": 9728, "minFilter": 9728}}],
            "materials": [{{"pbrMetallicRoughness": {{{}}}, "extensions": {{{}}}}}],
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "NORMAL": 1, "TANGENT": 2,
                "TEXCOORD_0": 3}}, "indices": 4, "material": 0}}]}}],
            "nodes": [{{"mesh": 0}}], "scenes": [{{"nodes": [0]}}], "scene": 0}})",
            numbers.json(), images, textures, ball.base, plain ? "" : ball.extension),
        numbers.bytes());
}

gpu::FloatImage picture_of(const std::vector<std::byte>& glb) {
    Result<GltfScene> loaded = parse_gltf(glb, "ball.glb", "");
    REQUIRE_MESSAGE(loaded.ok(), (loaded ? "" : loaded.error().message));
    CHECK(loaded->warnings.empty());
    Scene scene;
    for (ImageData& image : loaded->images) {
        scene.add(std::move(image));
    }
    const MaterialId material = scene.add(loaded->materials[0]);
    scene.place(scene.add(std::move(loaded->meshes[0])), material, at({0, 0, 0}));
    scene.shine(kLight, at(kLamp));
    return scene.radiance(scene.look(Vec3(kEye), {0, 0, 0}, kSide, kSide));
}

/// Radiance of a point of the ball.
DVec3 expected_at(LayeredMaterial material, const DVec3& point) {
    const DVec3 to_camera = glm::normalize(kEye - point);
    const oracle::Arriving light = oracle::arrive(kLight, DVec3(kLamp), point, point);
    material.along = glm::cross(point, tangent_at(point));  // the bitangent
    const oracle::LayerAlbedos albedos =
        oracle::layer_albedos(material, glm::dot(point, to_camera), 512);
    const double n_l = glm::dot(point, light.to_light);
    const double sheen_light = material.sheen == DVec3(0) || n_l <= 0
                                   ? 0
                                   : oracle::sheen_albedo(n_l, material.sheen_roughness, 64);
    return std::numbers::pi * light.color
           * oracle::reflect_layers(
               material, albedos, sheen_light, point, point, to_camera, light.to_light);
}

struct BallErrors {
    double right = 0;  ///< largest difference
    double left = 0;
    double brightest = 0;
    double effect = 0;  ///< largest difference of the extension from the material without it
};

/// Compares the picture at every third pixel that is on the ball, away from its rim, its terminator
/// and the borders of the halves.
BallErrors compare(const gpu::FloatImage& image, const ExtendedBall& ball) {
    const RenderView view = Scene().look(Vec3(kEye), {0, 0, 0}, kSide, kSide);
    BallErrors errors;
    for (int y = 1; y < kSide; y += 3) {
        for (int x = 1; x < kSide; x += 3) {
            const double right = (2 * (x + 0.5) / kSide - 1) * static_cast<double>(view.tangent.x);
            const double up = (1 - 2 * (y + 0.5) / kSide) * static_cast<double>(view.tangent.y);
            const DVec3 ray = glm::normalize(DVec3(right, up, -1));
            const double middle = -glm::dot(kEye, ray);
            const double inside = 1 - (glm::dot(kEye, kEye) - middle * middle);
            if (inside < 0.03) {
                continue;
            }
            const DVec3 point = kEye + (middle - std::sqrt(inside)) * ray;
            const DVec3 to_light = glm::normalize(DVec3(kLamp) - point);
            if (glm::dot(point, to_light) < 0.05 || std::abs(point.x) < 0.05) {
                continue;
            }
            const bool on_right = point.x > 0;  // u < 1/2
            const DVec3 want = expected_at(on_right ? ball.right : ball.left, point);
            const DVec3 without = expected_at(ball.left, point);
            for (int c = 0; c < 3; ++c) {
                const double error = std::abs(want[c] - static_cast<double>(image.at(x, y, c)));
                double& largest = on_right ? errors.right : errors.left;
                largest = std::max(largest, error);
                errors.brightest = std::max(errors.brightest, want[c]);
                errors.effect = std::max(errors.effect, std::abs(want[c] - without[c]));
            }
        }
    }
    return errors;
}

}  // namespace

TEST_CASE_FIXTURE(
    RenderTest,
    "gltf materials: a ball with each extension, and without it, is that of the formulas"
        * technique("shade.sheen, shade.dielectric-specular, shade.anisotropic-specular")) {
    for (const ExtendedBall& ball : extended_balls()) {
        CAPTURE(ball.name);
        const BallErrors errors = compare(picture_of(ball_glb(ball, false)), ball);
        CAPTURE(errors.brightest);
        CHECK(errors.effect > 0.05 * errors.brightest);
        // Facets are within 6e-4 of the ball; metal's highlights are steep.
        CHECK(errors.right < 0.02 * errors.brightest);
        CHECK(errors.left < 0.02 * errors.brightest);
    }
}

TEST_CASE_FIXTURE(
    RenderTest, "gltf materials: where its texture takes an extension away, it is as absent"
                    * technique("shade.sheen, shade.anisotropic-specular")) {
    for (const ExtendedBall& ball : extended_balls()) {
        if (ball.name == "specular") {
            continue;  // absent means a weight of 1
        }
        CAPTURE(ball.name);
        const gpu::FloatImage with = picture_of(ball_glb(ball, false));
        const gpu::FloatImage without = picture_of(ball_glb(ball, true));
        const float brightest = *std::max_element(without.pixels.begin(), without.pixels.end());
        float left = 0;
        float right = 0;
        for (int y = 0; y < kSide; ++y) {
            for (int x = 0; x < kSide; ++x) {
                float& largest = x < kSide / 2 - 1 ? left : right;
                largest = std::max(largest, std::abs(with.at(x, y, 1) - without.at(x, y, 1)));
            }
        }
        CHECK(left < 0.01f * brightest);
        CHECK(right > 0.03f * brightest);
    }
}

}  // namespace limn::test::gltf_materials_test
