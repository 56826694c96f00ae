#include "bench/oracles/skin_light_oracle.h"
#include "bench/quality/quality_scene.h"
#include "content/make/models/shapes.h"
#include "ecs/components/light.h"
#include "ecs/components/rendering.h"
#include "ecs/components/shadow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <vector>

// Light in skin: diffusion on a partly lit plane, and transmission through a slab.

namespace limn::skin_quality {
namespace {

using glm::dvec3;

constexpr int kSide = 256;     ///< of the images [px]
constexpr float kLarger = 40;  ///< scale relative to real skin, so that shadows end at pixels
constexpr Vec3 kFreePath = kLarger * Vec3(3.67e-3f, 1.37e-3f, 0.68e-3f);
constexpr float kFewRings = 0.2f;  ///< factor of free paths at which the last ring covers 22 px
constexpr float kFewestRings = 0.107f;  ///< the same, 12 px
constexpr double kHalf = 0.5;           ///< half extent of the compared part of the plane [m]
const char* const kChannels[3] = {"red", "green", "blue"};

Material skin(const Vec3& free_path = kFreePath) {
    return {
        .shading = ShadingModel::Subsurface,
        .base_color = {0.55f, 0.34f, 0.26f, 1},
        .roughness = 0.9f,
        .specular = {0, 0, 0},
        .scatter = free_path,
        .gloss = 0};
}

dvec3 scales_of(const Material& material) {
    return oracle::diffusion_scales(dvec3(Vec3(material.base_color)), dvec3(material.scatter));
}

/// A strip of light on a plane, between two casters out of view.
void populate_plane(QualityScene& scene, const Material& material, float from, float to) {
    scene.world.insert_resource(Rendering{.infinite_viewer = true});
    const MeshId plane = scene.add(make_box({.size = {8, 8, 0.01f}}));
    scene.world.add(
        scene.place(plane, scene.add(material), placed_at({0, 0, -0.005f})), NoShadow{});
    constexpr float kHeight = 20;
    constexpr float kFar = 30;
    for (const auto& [left, right] : {std::pair(-kFar, from), std::pair(to, kFar)}) {
        if (right > left) {
            scene.place(
                scene.add(make_box({.size = {right - left, 40, 1e-4f}})), scene.add(Material{}),
                placed_at({0.5f * (left + right) + kHeight, 0, kHeight}));
        }
    }
    scene.world.add(
        scene.add_light(
            DirectionalLight{.illuminance = kPi * std::numbers::sqrt2_v<float>},
            look_at({0, 0, 0}, {-1, 0, -1})),
        Shadow{.method = ShadowMethod::Volume});
}

struct Compared {
    dvec3 errors = dvec3(0);  ///< largest per channel, relative to the color of the lit plane
    QualityImage image;
};

/// Viewed along the normal: compares the image with the albedo times `expected(x, d)`.
Compared compare(
    HeadlessRenderer& headless, QualityScene& scene, const Material& material,
    const std::function<double(double, double)>& expected) {
    const gpu::FloatImage found =
        scene.radiance(headless, quality_view({0, 0, 1}, {0, 0, 0}, kSide, kSide, radians(90.0f)));
    const dvec3 d = scales_of(material);
    gpu::FloatImage exact{.width = kSide, .height = kSide, .channels = 3, .pixels = {}};
    Compared result;
    std::vector<float> row;
    for (int x = 0; x < kSide; ++x) {
        const double position = 2 * (x + 0.5) / kSide - 1;
        for (int c = 0; c < 3; ++c) {
            const auto albedo = static_cast<double>(material.base_color[c]);
            const double light = expected(position, d[c]);
            row.push_back(static_cast<float>(albedo * light));
            const auto drawn = static_cast<double>(found.at(x, kSide / 2, c));
            if (std::abs(position) < kHalf) {
                result.errors[c] = std::max(result.errors[c], std::abs(drawn / albedo - light));
            }
        }
    }
    for (int y = 0; y < kSide; ++y) {
        exact.pixels.insert(exact.pixels.end(), row.begin(), row.end());
    }
    result.image.effect = displayed(found);
    result.image.oracle = displayed(exact);
    return result;
}

void report(QualityReport& to, const char* title, Compared compared) {
    for (int c = 0; c < 3; ++c) {
        to.at_most(
            fmt::format("{}, {}: largest difference", title, kChannels[c]),
            100 * compared.errors[c], 1, "%");
    }
    compared.image.title = title;
    to.images.push_back(std::move(compared.image));
}

Status measure_skin(HeadlessRenderer& headless, QualityReport& to) {
    const Material material = skin();
    constexpr float kWidth = 8.0f / kSide;
    {
        QualityScene scene;
        populate_plane(scene, material, 0, 30);
        report(to, "edge of light", compare(headless, scene, material, oracle::diffused_edge));
    }
    // Farther away, where fewer rings are summed.
    for (const auto& [title, factor] :
         {std::pair("edge of light, far", kFewRings),
          std::pair("edge of light, farther", kFewestRings)}) {
        QualityScene scene;
        const Material small = skin(factor * kFreePath);
        populate_plane(scene, small, 0, 30);
        report(to, title, compare(headless, scene, small, oracle::diffused_edge));
    }
    {
        QualityScene scene;
        populate_plane(scene, material, -0.5f * kWidth, 0.5f * kWidth);
        report(to, "thin line of light", compare(headless, scene, material, [](double x, double d) {
                   return oracle::diffused_strip(x, static_cast<double>(kWidth), d);
               }));
    }
    {
        QualityScene scene;
        populate_plane(scene, material, -30, 30);
        report(to, "even light", compare(headless, scene, material, [](double, double) {
                   return 1.0;
               }));
    }
    for (const float thickness : {0.01f, 0.03f, 0.08f}) {
        QualityScene scene;
        scene.world.insert_resource(Rendering{.infinite_viewer = true});
        scene.place(
            scene.add(make_box({.size = {2, 2, thickness}})), scene.add(material),
            placed_at({0, 0, -0.5f * thickness}));
        scene.world.add(
            scene.add_light(DirectionalLight{.illuminance = kPi}, look_at({0, 0, 0}, {0, 0, 1})),
            Shadow{.method = ShadowMethod::Map, .resolution = 1024});
        const gpu::FloatImage found =
            scene.radiance(headless, quality_view({0, 0, 0.8f}, {0, 0, 0}, 65, 65, radians(90.0f)));
        const dvec3 d = scales_of(material);
        for (int c = 0; c < 3; ++c) {
            const double expected = static_cast<double>(material.base_color[c])
                                    * oracle::transmitted(static_cast<double>(thickness), d[c]);
            to.at_most(
                fmt::format(
                    "light through a slab {:.2f} mm thick, {}", 1000 * thickness / kLarger,
                    kChannels[c]),
                percent_error(static_cast<double>(found.at(32, 32, c)), expected), 0.2, "%");
        }
    }
    return Done{};
}

const RegisterQuality kRegistered(
    "skin", "the diffusion profile of Christensen and Burley, integrated in double precision",
    measure_skin);

}  // namespace
}  // namespace limn::skin_quality
