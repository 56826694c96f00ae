#include "bench/oracles/pbr_oracle.h"

#include "ecs/base/math.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace limn::oracle {
namespace {

constexpr double kPiD = std::numbers::pi;

double radical_inverse(std::uint32_t bits) {
    double value = 0;
    for (double digit = 0.5; bits != 0; bits >>= 1, digit *= 0.5) {
        value += digit * (bits & 1);
    }
    return value;
}

double schlick(double v_h) {
    return std::pow(std::clamp(1 - v_h, 0.0, 1.0), 5);
}

}  // namespace

double ggx_lobe(double n_l, double n_v, double n_h, double alpha) {
    if (n_l <= 0) {
        return 0;
    }
    const double a2 = alpha * alpha;
    const double distribution = a2 / (kPiD * square(n_h * n_h * (a2 - 1) + 1));
    const double visibility =
        0.5
        / (n_l * std::sqrt(n_v * n_v * (1 - a2) + a2) + n_v * std::sqrt(n_l * n_l * (1 - a2) + a2));
    return n_l * distribution * visibility;
}

DirectionalAlbedo directional_albedo(double n_v, double roughness, int samples) {
    const double alpha = roughness * roughness;
    const glm::dvec3 v(std::sqrt(1 - n_v * n_v), 0, n_v);
    DirectionalAlbedo sum;
    for (int i = 0; i < samples; ++i) {
        // Half vectors distributed as D(h) n.h; weight = 4 G2-visibility n.l v.h / n.h.
        const double u = (i + 0.5) / samples;
        const double phi = 2 * kPiD * radical_inverse(static_cast<std::uint32_t>(i));
        const double cosine = std::sqrt((1 - u) / (1 + (alpha * alpha - 1) * u));
        const double sine = std::sqrt(1 - cosine * cosine);
        const glm::dvec3 h(sine * std::cos(phi), sine * std::sin(phi), cosine);
        const double v_h = glm::dot(v, h);
        const double n_l = 2 * v_h * h.z - v.z;
        if (n_l > 0 && v_h > 0) {
            const double a2 = alpha * alpha;
            const double visibility = 0.5
                                      / (n_l * std::sqrt(n_v * n_v * (1 - a2) + a2)
                                         + n_v * std::sqrt(n_l * n_l * (1 - a2) + a2));
            const double weight = 4 * visibility * n_l * v_h / cosine;
            sum.scale += weight * (1 - schlick(v_h));
            sum.bias += weight * schlick(v_h);
        }
    }
    return {.scale = sum.scale / samples, .bias = sum.bias / samples};
}

glm::dvec3 reflect_pbr(
    const PbrMaterial& material, const DirectionalAlbedo& lobe, const glm::dvec3& normal,
    const glm::dvec3& to_camera, const glm::dvec3& to_light) {
    const double n_l = glm::dot(normal, to_light);
    if (n_l <= 0) {
        return glm::dvec3(0);
    }
    // Metalness linearly blends the dielectric and the metal (glTF 2.0).
    const glm::dvec3 h = glm::normalize(to_light + to_camera);
    const double p = schlick(glm::dot(to_camera, h));
    const double spread =
        ggx_lobe(n_l, glm::dot(normal, to_camera), glm::dot(normal, h), square(material.roughness));
    const auto given_back = [&](const glm::dvec3& f0) {
        return 1.0 + f0 * (1 / (lobe.scale + lobe.bias) - 1);
    };
    const auto specular = [&](const glm::dvec3& f0) {
        return (f0 * (1 - p) + p) * given_back(f0) * spread;
    };
    const glm::dvec3 f0(0.04);
    const glm::dvec3 left = 1.0 - (f0 * lobe.scale + lobe.bias) * given_back(f0);
    const glm::dvec3 dielectric = specular(f0) + left * material.albedo * (n_l / kPiD);
    return glm::mix(dielectric, specular(material.albedo), material.metalness);
}

glm::dvec3 furnace(const PbrMaterial& material, double n_v, int steps) {
    const DirectionalAlbedo lobe = directional_albedo(n_v, material.roughness, 1 << 15);
    const glm::dvec3 normal(0, 0, 1);
    const glm::dvec3 to_camera(std::sqrt(1 - n_v * n_v), 0, n_v);
    glm::dvec3 sum(0);
    // Midpoint rule in the elevation angle, in which the lobe is resolved better than in its
    // cosine.
    const double step = 0.5 * kPiD / steps;
    for (int i = 0; i < steps; ++i) {
        const double theta = (i + 0.5) * step;
        for (int j = 0; j < 2 * steps; ++j) {
            const double phi = (j + 0.5) * kPiD / steps;
            const glm::dvec3 to_light(
                std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
            sum += reflect_pbr(material, lobe, normal, to_camera, to_light) * std::sin(theta);
        }
    }
    return sum * (step * kPiD / steps);
}

}  // namespace limn::oracle
