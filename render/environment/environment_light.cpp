#include "render/environment/environment_light.h"

#include "ecs/base/jobs.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>

// Techniques: env.image-based-light
// Source of env.image-based-light: Ramamoorthi and Hanrahan 2001; Karis 2013

namespace limn {
namespace {

/// Soft boxes of the studio, around an object at the origin viewed from +z. By eye.
struct LampSpec {
    Vec3 center;
    Vec2 half_size;  ///< tangents
    float softness;
    Vec3 radiance;
};
constexpr LampSpec kLamps[layout::kStudioLamps] = {
    {{0.75f, 0.62f, 0.60f},
     {0.42f, 0.52f},
     0.10f,
     {8.6f, 8.0f, 7.2f}},  // key: right, high, in front
    {{-0.92f, 0.18f, 0.42f}, {0.30f, 0.75f}, 0.25f, {1.7f, 1.9f, 2.3f}},  // fill: left, tall, cool
    {{-0.70f, 0.45f, -0.72f}, {0.16f, 0.70f}, 0.15f, {9.0f, 9.6f, 11.0f}},  // rim: behind left
    {{0.86f, 0.25f, -0.66f}, {0.12f, 0.80f}, 0.15f, {6.6f, 6.2f, 5.6f}},    // rim: behind right
    {{0.0f, 1.0f, -0.15f}, {0.85f, 0.55f}, 0.20f, {2.4f, 2.4f, 2.5f}},      // ceiling
    {{0.10f, -0.75f, 0.80f},
     {0.90f, 0.25f},
     0.40f,
     {0.35f, 0.33f, 0.30f}},  // bounce from the table
};

float smoothstep(float edge0, float edge1, float x) {
    const float t = std::clamp((x - edge0) / (edge1 - edge0), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

Vec3 rgb(const Vec4& v) {
    return {v.x, v.y, v.z};
}

Vec3 gradient_sky(const layout::EnvironmentBlock& b, const Vec3& d) {
    const Vec3 above =
        glm::mix(rgb(b.zenith), rgb(b.horizon), std::exp2(-4.5f * std::max(d.y, 0.0f)));
    const Vec3 below =
        glm::mix(rgb(b.ground), 0.8f * rgb(b.horizon), std::exp2(12.0f * std::min(d.y, 0.0f)));
    return glm::mix(below, above, smoothstep(-0.015f, 0.015f, d.y));
}

Vec3 studio(const layout::EnvironmentBlock& b, const Vec3& d) {
    const float wall = 1.0f - std::abs(d.y - 0.05f);
    const float carpet = smoothstep(-0.1f, -0.9f, d.y);
    Vec3 sum = b.horizon.w
               * (glm::mix(0.030f, 0.175f, wall * wall * wall) * Vec3(0.96f, 0.98f, 1.04f)
                  + 0.04f * carpet);
    for (const layout::StudioLamp& lamp : b.lamps) {
        const float t = glm::dot(d, rgb(lamp.center));
        if (t > 0) {
            const float soft = lamp.center.w;
            const float x = std::abs(glm::dot(d, rgb(lamp.u))) / std::max(t, 1e-4f);
            const float y = std::abs(glm::dot(d, rgb(lamp.v))) / std::max(t, 1e-4f);
            sum += rgb(lamp.color)
                   * ((1 - smoothstep(1 - soft, 1 + soft, x))
                      * (1 - smoothstep(1 - soft, 1 + soft, y)));
        }
    }
    return sum;
}

/// The nine real spherical harmonics without their constants, in the order of the block.
std::array<float, 9> harmonics(const Vec3& n) {
    return {1,
            n.y,
            n.z,
            n.x,
            n.x * n.y,
            n.y * n.z,
            3 * n.z * n.z - 1,
            n.x * n.z,
            n.x * n.x - n.y * n.y};
}
/// Squared SH constants times the clamped-cosine convolution factor of each band / pi.
constexpr std::array<float, 9> kHarmonicFactors = {
    1.0f / (4 * kPi),
    (2.0f / 3.0f) * 3.0f / (4 * kPi),
    (2.0f / 3.0f) * 3.0f / (4 * kPi),
    (2.0f / 3.0f) * 3.0f / (4 * kPi),
    0.25f * 15.0f / (4 * kPi),
    0.25f * 15.0f / (4 * kPi),
    0.25f * 5.0f / (16 * kPi),
    0.25f * 15.0f / (4 * kPi),
    0.25f * 15.0f / (16 * kPi),
};

float radical_inverse(std::uint32_t bits) {
    float value = 0;
    for (float digit = 0.5f; bits != 0; bits >>= 1, digit *= 0.5f) {
        value += digit * static_cast<float>(bits & 1);
    }
    return value;
}

/// A microfacet normal visible from `v`, sampled with two uniform numbers (Heitz, "Sampling the GGX
/// Distribution of Visible Normals", 2018).
Vec3 visible_normal(const Vec3& v, float alpha, float u1, float u2) {
    const Vec3 stretched = glm::normalize(Vec3(alpha * v.x, alpha * v.y, v.z));
    const float across2 = square(stretched.x) + square(stretched.y);
    const Vec3 t1 =
        across2 > 0 ? Vec3(-stretched.y, stretched.x, 0) / std::sqrt(across2) : Vec3(1, 0, 0);
    const Vec3 t2 = glm::cross(stretched, t1);
    const float radius = std::sqrt(u1);
    const float a = radius * std::cos(2 * kPi * u2);
    const float s = 0.5f * (1 + stretched.z);
    const float b = (1 - s) * std::sqrt(1 - a * a) + s * radius * std::sin(2 * kPi * u2);
    const Vec3 n = a * t1 + b * t2 + std::sqrt(std::max(1 - a * a - b * b, 0.0f)) * stretched;
    return glm::normalize(Vec3(alpha * n.x, alpha * n.y, std::max(n.z, 1e-6f)));
}

/// GGX with height-correlated Smith masking, integrated over the visible microfacets.
Vec2 integrate_specular(float n_v, float roughness, int samples) {
    const float alpha = square(roughness);
    const float alpha2 = square(alpha);
    const Vec3 v = {std::sqrt(1 - n_v * n_v), 0, n_v};
    const float smith_v = std::sqrt(alpha2 + (1 - alpha2) * n_v * n_v);
    Vec2 sum = {0, 0};
    for (int i = 0; i < samples; ++i) {
        const float u = (static_cast<float>(i) + 0.5f) / static_cast<float>(samples);
        const Vec3 h = visible_normal(v, alpha, u, radical_inverse(static_cast<std::uint32_t>(i)));
        const float v_h = glm::dot(v, h);
        const float n_l = 2 * v_h * h.z - n_v;
        if (n_l > 0) {
            const float smith_l = std::sqrt(alpha2 + (1 - alpha2) * n_l * n_l);
            const float weight = n_l * (n_v + smith_v) / (n_v * smith_l + n_l * smith_v);
            const float fresnel = std::pow(1 - std::clamp(v_h, 0.0f, 1.0f), 5.0f);
            sum += weight * Vec2(1 - fresnel, fresnel);
        }
    }
    return sum / static_cast<float>(samples);
}

}  // namespace

layout::EnvironmentBlock make_environment_block(
    const Environment& environment, const Vec3& sun_direction, const Vec3& sun_color) {
    layout::EnvironmentBlock block{};
    const float intensity = environment.intensity;
    block.zenith = Vec4(environment.zenith * intensity, static_cast<float>(environment.sky));
    block.horizon = Vec4(environment.horizon * intensity, intensity);
    block.ground = Vec4(environment.ground * intensity, 0);
    block.sun_direction = Vec4(sun_direction, 0);
    block.sun_color = Vec4(sun_color, 0);
    if (environment.sky == SkyKind::Atmosphere) {
        block.zenith = Vec4(Vec3(0), block.zenith.w);
        block.ground = Vec4(0);
    }
    for (std::size_t i = 0; i < layout::kStudioLamps; ++i) {
        const LampSpec& lamp = kLamps[i];
        const Vec3 center = glm::normalize(lamp.center);
        const Vec3 up = std::abs(center.y) > 0.9f ? Vec3(0, 0, -1) : Vec3(0, 1, 0);
        const Vec3 u = glm::normalize(glm::cross(up, center));
        const Vec3 v = glm::cross(center, u);
        block.lamps[i].center = Vec4(center, lamp.softness);
        block.lamps[i].u = Vec4(u / lamp.half_size.x, 0);
        block.lamps[i].v = Vec4(v / lamp.half_size.y, 0);
        block.lamps[i].color = Vec4(lamp.radiance * intensity, 0);
    }
    return block;
}

Vec3 sky_radiance(
    const layout::EnvironmentBlock& block, const Vec3& direction, const SkyView* view) {
    switch (static_cast<SkyKind>(static_cast<int>(block.zenith.w))) {
    case SkyKind::Gradient:
        return gradient_sky(block, direction);
    case SkyKind::Studio:
        return studio(block, direction);
    case SkyKind::Panorama:
        return Vec3(0);
    case SkyKind::Atmosphere:
        return view != nullptr ? rgb(block.zenith) * sky_radiance(*view, direction) : Vec3(0);
    case SkyKind::Uniform:
        break;
    }
    return rgb(block.zenith);
}

layout::Irradiance project_irradiance(const layout::EnvironmentBlock& block, const SkyView* view) {
    // Equal areas: rings of equal height, divided evenly.
    constexpr int kRings = 96;
    constexpr int kSectors = 192;
    std::array<glm::dvec3, 9> sums{};
    for (int i = 0; i < kRings; ++i) {
        const float y = 1 - 2 * (static_cast<float>(i) + 0.5f) / kRings;
        const float across = std::sqrt(1 - y * y);
        for (int j = 0; j < kSectors; ++j) {
            const float phi = 2 * kPi * (static_cast<float>(j) + 0.5f) / kSectors;
            const Vec3 d = {across * std::cos(phi), y, across * std::sin(phi)};
            const glm::dvec3 radiance = sky_radiance(block, d, view);
            const std::array<float, 9> h = harmonics(d);
            for (int k = 0; k < 9; ++k) {
                sums[k] += radiance * static_cast<double>(h[k]);
            }
        }
    }
    const double solid_angle = 4.0 * kPi / (kRings * kSectors);
    layout::Irradiance irradiance;
    for (int k = 0; k < 9; ++k) {
        irradiance.coefficients[k] = Vec4(Vec3(sums[k] * solid_angle) * kHarmonicFactors[k], 0);
    }
    return irradiance;
}

Vec3 irradiance_toward(const layout::Irradiance& irradiance, const Vec3& normal) {
    const std::array<float, 9> h = harmonics(normal);
    Vec3 sum = Vec3(0);
    for (int k = 0; k < 9; ++k) {
        sum += rgb(irradiance.coefficients[k]) * h[k];
    }
    return glm::max(sum, Vec3(0));
}

std::vector<Vec2> make_specular_albedo(int size) {
    constexpr int kSamples = 256;
    std::vector<Vec2> table(static_cast<std::size_t>(size) * size);
    parallel_for(size, 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) {
            // Below this roughness the result no longer changes, and precision is lost.
            const float roughness =
                std::max(static_cast<float>(y) / static_cast<float>(size - 1), 0.03f);
            for (int x = 0; x < size; ++x) {
                const float n_v =
                    std::max(static_cast<float>(x) / static_cast<float>(size - 1), 1e-3f);
                table[y * size + x] = integrate_specular(n_v, roughness, kSamples);
            }
        }
    });
    return table;
}

}  // namespace limn
