#include "bench/oracles/light_oracle.h"
#include "bench/oracles/pbr_oracle.h"
#include "bench/quality/quality_scene.h"
#include "ecs/components/light.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace limn::surfaces_quality {
namespace {

using oracle::DVec3;

constexpr int kSide = 128;  ///< of the images [px]

// The plate lies in z = 0; the camera at (0, 0, 1) with a field of view of 90 degrees sees exactly
// the plate.
const DVec3 kEye = {0, 0, 1};
const DVec3 kNormal = {0, 0, 1};
constexpr Vec3 kLampPosition = {0.5f, 0.4f, 0.6f};
constexpr Vec3 kSpotPosition = {-0.5f, -0.4f, 0.9f};
const PointLight kLamp = {.color = {1, 0.8f, 0.6f}, .intensity = 0.8f, .radius = 3};
const SpotLight kSpot = {.color = {0.4f, 0.6f, 1}, .intensity = 1.2f, .radius = 4};

struct Plate {
    const char* name;
    Material material;
};

std::array<Plate, 6> plates() {
    return {{
        {"matte",
         {.shading = ShadingModel::Blinn,
          .base_color = {0.8f, 0.7f, 0.6f, 1},
          .specular = {0, 0, 0}}},
        {"Blinn",
         {.shading = ShadingModel::Blinn,
          .base_color = {0.3f, 0.5f, 0.4f, 1},
          .specular = {0.4f, 0.4f, 0.4f},
          .shininess = 40}},
        {"Phong",
         {.shading = ShadingModel::Phong,
          .base_color = {0.5f, 0.3f, 0.4f, 1},
          .specular = {0.4f, 0.4f, 0.4f},
          .shininess = 40}},
        {"skin",
         {.shading = ShadingModel::Skin,
          .base_color = {0.7f, 0.45f, 0.35f, 1},
          .specular = {0.2f, 0.2f, 0.2f},
          .shininess = 20}},
        {"skin, wide rim",
         {.shading = ShadingModel::Skin,
          .base_color = {0.7f, 0.45f, 0.35f, 1},
          .specular = {0.2f, 0.2f, 0.2f},
          .shininess = 20,
          .wide_rim = true}},
        {"metal, roughness 0.35",
         {.base_color = {0.95f, 0.7f, 0.4f, 1}, .metalness = 1, .roughness = 0.35f}},
    }};
}

DVec3 classic(const Material& material, const DVec3& point) {
    const std::array<oracle::Arriving, 2> lights = {
        oracle::arrive(kLamp, DVec3(kLampPosition), point, kNormal),
        oracle::arrive(kSpot, DVec3(kSpotPosition), DVec3(0, 0, -1), point, kNormal)};
    const oracle::ClassicMaterial coefficients = {
        .ambient = DVec3(0),
        .diffuse = DVec3(material.base_color),
        .specular = DVec3(material.specular),
        .shininess = material.shininess};
    const DVec3 to_camera = glm::normalize(kEye - point);
    if (material.shading == ShadingModel::Phong) {
        return oracle::phong(coefficients, DVec3(0), lights, kNormal, to_camera);
    }
    if (material.shading == ShadingModel::Skin) {
        return oracle::skin(
            coefficients, DVec3(material.skin_color), material.wide_rim, lights, kNormal,
            to_camera);
    }
    return oracle::blinn(coefficients, DVec3(0), lights, kNormal, to_camera);
}

DVec3 metal_rough(const Material& material, const DVec3& point) {
    const DVec3 to_camera = glm::normalize(kEye - point);
    const oracle::PbrMaterial pbr = {
        .albedo = DVec3(material.base_color),
        .metalness = material.metalness,
        .roughness = material.roughness};
    const oracle::DirectionalAlbedo lobe =
        oracle::directional_albedo(glm::dot(kNormal, to_camera), pbr.roughness, 1024);
    DVec3 sum(0);
    for (const oracle::Arriving& light :
         {oracle::arrive(kLamp, DVec3(kLampPosition), point, kNormal),
          oracle::arrive(kSpot, DVec3(kSpotPosition), DVec3(0, 0, -1), point, kNormal)}) {
        sum += std::numbers::pi * light.color
               * oracle::reflect_pbr(pbr, lobe, kNormal, to_camera, light.to_light);
    }
    return sum;
}

gpu::FloatImage oracle_image(const Material& material) {
    gpu::FloatImage image{.width = kSide, .height = kSide, .channels = 3, .pixels = {}};
    const auto to_plate = [](int i) { return 2 * (i + 0.5) / kSide - 1; };
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const DVec3 point = {to_plate(x), -to_plate(y), 0};
            const DVec3 color = material.shading == ShadingModel::Pbr ? metal_rough(material, point)
                                                                      : classic(material, point);
            for (int c = 0; c < 3; ++c) {
                image.pixels.push_back(static_cast<float>(color[c]));
            }
        }
    }
    return image;
}

Status measure_surfaces(HeadlessRenderer& headless, QualityReport& report) {
    const RenderView view = quality_view({0, 0, 1}, {0, 0, 0}, kSide, kSide, radians(90.0f));
    const bool half_floats = headless.device->caps().profile == gpu::Profile::Gpu;
    const double rounding = half_floats ? 1.0 / 2048 : 0;
    for (const Plate& plate : plates()) {
        QualityScene scene;
        scene.place(scene.add(quality_square()), scene.add(plate.material), placed_at({0, 0, 0}));
        scene.add_light(kLamp, placed_at(kLampPosition));
        scene.add_light(kSpot, placed_at(kSpotPosition));  // along -z
        const gpu::FloatImage found = scene.radiance(headless, view);
        const gpu::FloatImage expected = oracle_image(plate.material);
        report.at_most(
            fmt::format("{}: largest difference, of the brightest", plate.name),
            largest_relative_error(
                found, expected),  // The metal's directional albedo comes from a 64 x 64 table.
            (plate.material.shading == ShadingModel::Pbr ? 2e-3 : 1e-3) + rounding);
        report.images.push_back({plate.name, displayed(found), displayed(expected)});
    }
    return Done{};
}

const RegisterQuality kRegistered(
    "surfaces", "the reflection models in double precision, at each pixel's surface point",
    measure_surfaces);

}  // namespace
}  // namespace limn::surfaces_quality
