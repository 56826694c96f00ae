#include "bench/oracles/light_oracle.h"
#include "bench/oracles/pbr_oracle.h"
#include "bench/quality/quality_scene.h"
#include "ecs/components/light.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

namespace limn::bump_quality {
namespace {

using oracle::DVec3;

const DirectionalLight kSun = {.color = {1, 0.95f, 0.9f}, .illuminance = 1};
constexpr Vec3 kSunAxis = {0.5f, 0, -0.866f};

constexpr int kWidth = 48;  ///< of the images [px]
constexpr int kHeight = 32;
constexpr int kSamples = 32;    ///< of the oracle in a row of a pixel
constexpr int kTexels = 128;    ///< of the normal map in a meter
constexpr float kSlant = 0.5f;  ///< of the ridges to the tangent [rad]

/// A sum of waves in one direction.
double waves(double u, double v, int right, int down) {
    double sum = 0;
    for (int k = 5; k <= 14; ++k) {  // whole numbers of waves in the map
        sum += std::cos(2 * std::numbers::pi * k * (right * u + down * v) + 2.4 * k * k);
    }
    return sum;
}

/// Slanted ridges, with some unevenness along them.
ImageData ridges() {
    ImageData image = {
        .name = "ridges",
        .width = kTexels,
        .height = kTexels,
        .format = PixelFormat::Rgba8,
        .pixels = {}};
    for (int y = 0; y < kTexels; ++y) {
        for (int x = 0; x < kTexels; ++x) {
            const double u = (x + 0.5) / kTexels;
            const double v = (y + 0.5) / kTexels;
            const double ridge = 0.14 * waves(u, v, 2, 1);  // the slope, v goes down
            const double uneven = 0.03 * waves(u, v, -1, 2);
            const Vec3 n = glm::normalize(Vec3(
                ridge * std::cos(kSlant) - uneven * std::sin(kSlant),
                -ridge * std::sin(kSlant) - uneven * std::cos(kSlant), 1));
            for (int c = 0; c < 3; ++c) {
                image.pixels.push_back(static_cast<std::uint8_t>(127.5f * n[c] + 128.0f));
            }
            image.pixels.push_back(255);
        }
    }
    return image;
}

/// A material of the wall, with what the oracle needs of it.
class WallOracle {
  public:
    explicit WallOracle(const Material& material) : material_(material), map_(ridges()) {
        for (int i = 0; i <= kLobes; ++i) {
            const double n_v = std::max(static_cast<double>(i) / kLobes, 1e-3);
            lobes_.push_back(oracle::directional_albedo(n_v, material.roughness, 512));
        }
    }

    [[nodiscard]] DVec3 radiance(const DVec3& point, const DVec3& to_camera) const {
        const DVec3 normal = normal_at(point);
        const oracle::Arriving light = oracle::arrive(kSun, DVec3(kSunAxis));
        if (material_.shading == ShadingModel::Blinn) {
            const oracle::ClassicMaterial coefficients = {
                .ambient = DVec3(0),
                .diffuse = DVec3(material_.base_color),
                .specular = DVec3(material_.specular),
                .shininess = material_.shininess};
            return oracle::blinn(coefficients, DVec3(0), std::array{light}, normal, to_camera);
        }
        const oracle::PbrMaterial metal = {
            .albedo = DVec3(material_.base_color),
            .metalness = material_.metalness,
            .roughness = material_.roughness};
        const double n_v = std::clamp(glm::dot(normal, to_camera), 0.0, 1.0);
        const auto lobe = lobes_[static_cast<std::size_t>(n_v * kLobes + 0.5)];
        return std::numbers::pi * light.color
               * oracle::reflect_pbr(metal, lobe, normal, to_camera, light.to_light);
    }

  private:
    static constexpr int kLobes = 256;

    [[nodiscard]] DVec3 texel(int x, int y) const {
        const auto wrap = [](int i) { return static_cast<std::size_t>(i & (kTexels - 1)); };
        const std::uint8_t* at = map_.pixels.data() + 4 * (wrap(y) * kTexels + wrap(x));
        return DVec3(at[0], at[1], at[2]) / 127.5 - 1.0;
    }
    /// Filtered bilinearly.
    [[nodiscard]] DVec3 normal_at(const DVec3& point) const {
        const double x = point.x * kTexels - 0.5;
        const double y = -point.y * kTexels - 0.5;
        const int left = static_cast<int>(std::floor(x));
        const int top = static_cast<int>(std::floor(y));
        const DVec3 upper = glm::mix(texel(left, top), texel(left + 1, top), x - left);
        const DVec3 lower = glm::mix(texel(left, top + 1), texel(left + 1, top + 1), x - left);
        return glm::normalize(glm::mix(upper, lower, y - top));
    }

    Material material_;
    ImageData map_;
    std::vector<oracle::DirectionalAlbedo> lobes_;
};

gpu::FloatImage expected_wall(const Material& material, const RenderView& view) {
    gpu::FloatImage image{.width = kWidth, .height = kHeight, .channels = 3, .pixels = {}};
    const WallOracle wall(material);
    const DVec3 eye = eye_of(view);
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            DVec3 sum(0);
            for (int i = 0; i < kSamples * kSamples; ++i) {
                // A pixel's own coordinates are those of its center.
                const double right = (i % kSamples + 0.5) / kSamples - 0.5;
                const double down = (i / kSamples + 0.5) / kSamples - 0.5;
                const DVec3 ray = pixel_ray(view, x + right, y + down);
                sum += wall.radiance(eye - ray * (eye.z / ray.z), -glm::normalize(ray));
            }
            for (int c = 0; c < 3; ++c) {
                image.pixels.push_back(static_cast<float>(sum[c] / (kSamples * kSamples)));
            }
        }
    }
    return image;
}

/// Root of the mean square of the differences, of that of `expected` [%].
double relative_error(const gpu::FloatImage& found, const gpu::FloatImage& expected) {
    double error = 0;
    double all = 0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            for (int c = 0; c < 3; ++c) {
                const double e = expected.at(x, y, c);
                error += square(found.at(x, y, c) - e);
                all += square(e);
            }
        }
    }
    return 100 * std::sqrt(error / all);
}

/// From aside, mirroring the sun.
RenderView view_of_wall(float distance) {
    return quality_view(
        Vec3(0.5f, 0, 0.866f) * distance, {0, 0, 0}, kWidth, kHeight, radians(20.0f));
}

gpu::FloatImage
wall(HeadlessRenderer& headless, Material material, NormalMips mips, float distance) {
    QualityScene scene;
    material.normal_texture.image = scene.add(ridges());
    material.normal_texture.scale = Vec2(8 * distance);  // the map repeats every meter
    material.normal_mips = mips;
    scene.place(
        scene.add(quality_square()), scene.add(material), placed_at({0, 0, 0}, 4 * distance));
    scene.add_light(kSun, look_at({0, 0, 0}, kSunAxis));
    return scene.radiance(headless, view_of_wall(distance));
}

struct Surface {
    const char* name;
    Material material;
    double most_toksvig;  ///< error at most [%]
    double most_lean;
};

Status measure_bumps(HeadlessRenderer& headless, QualityReport& report) {
    const Surface surfaces[] = {
        {"metal",
         {.base_color = {0.9f, 0.75f, 0.5f, 1}, .metalness = 1, .roughness = 0.25f},
         65,
         60},
        {"Blinn",
         {.shading = ShadingModel::Blinn,
          .base_color = {0.3f, 0.25f, 0.2f, 1},
          .specular = {0.7f, 0.7f, 0.7f},
          .shininess = 60},
         22,
         22}};
    for (const Surface& surface : surfaces) {
        for (const float distance : {3.0f, 8.0f, 20.0f}) {
            const gpu::FloatImage expected =
                expected_wall(surface.material, view_of_wall(distance));
            const auto measure = [&](const char* name, NormalMips mips) {
                const gpu::FloatImage found = wall(headless, surface.material, mips, distance);
                const std::string title =
                    fmt::format("{} at {} m, {}", surface.name, distance, name);
                report.images.push_back({title, displayed(found), displayed(expected)});
                return relative_error(found, expected);
            };
            const auto row = [&](const char* name) {
                return fmt::format("{} at {} m: error of {}", surface.name, distance, name);
            };
            report.inform(row("plain"), measure("plain", NormalMips::Plain), "%");
            report.at_most(
                row("toksvig"), measure("toksvig", NormalMips::Toksvig), surface.most_toksvig, "%");
            report.at_most(row("lean"), measure("lean", NormalMips::Lean), surface.most_lean, "%");
        }
    }
    return Done{};
}

const RegisterQuality kRegistered(
    "bump", "bumpy walls in double precision, at 1024 points of each pixel", measure_bumps);

}  // namespace
}  // namespace limn::bump_quality
