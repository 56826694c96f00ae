#include "bench/oracles/layers_oracle.h"
#include "bench/oracles/light_oracle.h"
#include "bench/quality/quality_scene.h"
#include "ecs/components/light.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace limn::materials_quality {
namespace {

using oracle::DVec3;

constexpr int kSide = 128;  ///< of the images [px]

// The plate lies in z = 0; the camera at (0, 0, 1) with a field of view of 90 degrees sees exactly
// the plate.
const DVec3 kEye = {0, 0, 1};
const DVec3 kNormal = {0, 0, 1};
constexpr Vec3 kLampPosition = {0.45f, 0.35f, 0.6f};
const PointLight kLamp = {.color = {1, 0.9f, 0.8f}, .intensity = 0.8f, .radius = 3};

struct Sample {
    const char* name;
    Material material;
};

std::array<Sample, 7> samples() {
    // The G-buffer rounds roughness to 10 bits, which 0.6 hardly changes.
    Material paint = {.base_color = {0.5f, 0.03f, 0.02f, 1}, .roughness = 0.6f};
    Material metal = {.base_color = {0.9f, 0.8f, 0.6f, 1}, .metalness = 1, .roughness = 0.3f};
    std::array<Sample, 7> all = {
        {{"clear coat", paint},
         {"sheen", paint},
         {"specular weight", paint},
         {"specular tint", paint},
         {"anisotropy", metal},
         {"iridescence", {.base_color = {0.02f, 0.02f, 0.02f, 1}, .roughness = 0.3f}},
         {"all of them", metal}}};
    all[0].material.clearcoat = 1;
    all[0].material.clearcoat_roughness = 0.12f;
    all[1].material.sheen = {0.9f, 0.5f, 0.7f};
    all[1].material.sheen_roughness = 0.4f;
    all[2].material.specular_weight = 0.2f;
    all[3].material.specular_tint = {0.2f, 2, 4};
    all[4].material.anisotropy = 0.8f;
    all[4].material.anisotropy_rotation = 0.5f;
    all[5].material.iridescence = 1;
    all[5].material.iridescence_index = 1.8f;
    Material& every = all[6].material;
    every.metalness = 0.5f;
    every.clearcoat = 0.7f;
    every.clearcoat_roughness = 0.2f;
    every.sheen = {0.2f, 0.3f, 0.4f};
    every.sheen_roughness = 0.5f;
    every.specular_weight = 0.8f;
    every.specular_tint = {1, 2, 1};
    every.anisotropy = 0.5f;
    every.iridescence = 0.6f;
    return all;
}

oracle::LayeredMaterial oracle_of(const Material& m) {
    const double turn = m.anisotropy_rotation;
    return {
        .albedo = DVec3(m.base_color),
        .metalness = m.metalness,
        .roughness = m.roughness,
        .specular_weight = m.specular_weight,
        .specular_tint = DVec3(m.specular_tint),
        .coat = m.clearcoat,
        .coat_roughness = m.clearcoat_roughness,
        .sheen = DVec3(m.sheen),
        .sheen_roughness = m.sheen_roughness,
        .anisotropy = m.anisotropy,
        .along = {std::cos(turn), std::sin(turn), 0},
        .iridescence = m.iridescence,
        .film_index = m.iridescence_index,
        .film_thickness = m.iridescence_thickness.y};
}

/// sheen_albedo() by the cosine, from a table.
class SheenTable {
  public:
    explicit SheenTable(const oracle::LayeredMaterial& material) {
        for (int i = 0; i <= kSteps && material.sheen != DVec3(0); ++i) {
            const double cosine = std::max(static_cast<double>(i) / kSteps, 1e-3);
            albedos_.push_back(oracle::sheen_albedo(cosine, material.sheen_roughness, 256));
        }
    }
    [[nodiscard]] double at(double cosine) const {
        if (albedos_.empty()) {
            return 0;
        }
        const double position = std::clamp(cosine, 0.0, 1.0) * kSteps;
        const auto below = std::min(static_cast<std::size_t>(position), albedos_.size() - 2);
        return std::lerp(
            albedos_[below], albedos_[below + 1], position - static_cast<double>(below));
    }

  private:
    static constexpr int kSteps = 128;
    std::vector<double> albedos_;
};

gpu::FloatImage oracle_image(const oracle::LayeredMaterial& material) {
    gpu::FloatImage image{.width = kSide, .height = kSide, .channels = 3, .pixels = {}};
    const auto to_plate = [](int i) { return 2 * (i + 0.5) / kSide - 1; };
    const SheenTable sheen(material);
    oracle::LayeredMaterial without_sheen = material;
    without_sheen.sheen = DVec3(0);
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const DVec3 point = {to_plate(x), -to_plate(y), 0};
            const DVec3 to_camera = glm::normalize(kEye - point);
            const oracle::Arriving light =
                oracle::arrive(kLamp, DVec3(kLampPosition), point, kNormal);
            oracle::LayerAlbedos albedos = oracle::layer_albedos(without_sheen, to_camera.z, 1024);
            albedos.sheen = sheen.at(to_camera.z);
            const DVec3 color = std::numbers::pi * light.color
                                * oracle::reflect_layers(
                                    material, albedos, sheen.at(light.to_light.z), kNormal, kNormal,
                                    to_camera, light.to_light);
            for (int c = 0; c < 3; ++c) {
                image.pixels.push_back(static_cast<float>(color[c]));
            }
        }
    }
    return image;
}

/// The brightest color of a white surface in a white furnace, by the sum over all directions.
double furnace_of(oracle::LayeredMaterial material) {
    material.albedo = DVec3(1);
    double largest = 0;
    for (const double n_v : {0.2, 0.6, 0.95}) {
        const DVec3 sum = oracle::layers_furnace(material, n_v, 96);
        largest = std::max({largest, sum.x, sum.y, sum.z});
    }
    return largest;
}

Status measure_materials(HeadlessRenderer& headless, QualityReport& report) {
    const RenderView view = quality_view({0, 0, 1}, {0, 0, 0}, kSide, kSide, radians(90.0f));
    const bool half_floats = headless.device->caps().profile == gpu::Profile::Gpu;
    for (const Sample& sample : samples()) {
        QualityScene scene;
        scene.place(scene.add(quality_square()), scene.add(sample.material), placed_at({0, 0, 0}));
        scene.add_light(kLamp, placed_at(kLampPosition));
        const gpu::FloatImage found = scene.radiance(headless, view);
        const oracle::LayeredMaterial material = oracle_of(sample.material);
        const gpu::FloatImage expected = oracle_image(material);
        report.at_most(
            fmt::format("{}: largest difference, of the brightest", sample.name),
            largest_relative_error(found, expected), 4e-3 + (half_floats ? 1.0 / 2048 : 0));
        report.at_most(
            fmt::format("{}: light returned of a white furnace", sample.name), furnace_of(material),
            1.03);
        report.images.push_back({sample.name, displayed(found), displayed(expected)});
    }
    return Done{};
}

const RegisterQuality kRegistered(
    "materials", "glTF's material extensions in double precision, at each pixel's surface point",
    measure_materials);

}  // namespace
}  // namespace limn::materials_quality
