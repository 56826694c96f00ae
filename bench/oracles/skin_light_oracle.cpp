#include "bench/oracles/skin_light_oracle.h"

#include "ecs/base/math.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace limn::oracle {
namespace {

constexpr double kSkinPi = std::numbers::pi;

}  // namespace

DVec3 melanin_blood(double melanin, double blood) {
    return DVec3(0.97, 0.87, 0.67) - melanin * DVec3(0.69, 0.71, 0.90)
           - blood * DVec3(0.00, 0.24, 0.24);
}

double lafortune(double diffuse, std::span<const Lobe> lobes, const DVec3& u, const DVec3& v) {
    double sum = diffuse;
    for (const Lobe& lobe : lobes) {
        const double base = lobe.across * (u.x * v.x + u.y * v.y) + lobe.along * u.z * v.z;
        sum += base > 0 ? std::pow(base, lobe.exponent) : 0;
    }
    return sum;
}

double lafortune_albedo(double diffuse, std::span<const Lobe> lobes, const DVec3& u, int steps) {
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double z = (i + 0.5) / steps;
        const double radius = std::sqrt(1 - z * z);
        for (int j = 0; j < 2 * steps; ++j) {
            const double turn = kSkinPi * (j + 0.5) / steps;
            const DVec3 v(radius * std::cos(turn), radius * std::sin(turn), z);
            sum += lafortune(diffuse, lobes, u, v) * z;
        }
    }
    return sum * (2 * kSkinPi / (2.0 * steps * steps)) / kSkinPi;
}

double diffusion_profile(double r, double d) {
    return (std::exp(-r / d) + std::exp(-r / (3 * d))) / (8 * kSkinPi * d * r);
}

double diffused_fraction(double r, double d) {
    return 1 - 0.25 * std::exp(-r / d) - 0.75 * std::exp(-r / (3 * d));
}

double diffusion_scale(double albedo, double mean_free_path) {
    return mean_free_path / (3.5 + 100 * std::pow(albedo - 0.33, 4));
}

DVec3 diffusion_scales(const DVec3& albedo, const DVec3& mean_free_path) {
    return {
        diffusion_scale(albedo.x, mean_free_path.x), diffusion_scale(albedo.y, mean_free_path.y),
        diffusion_scale(albedo.z, mean_free_path.z)};
}

double diffused_edge(double x, double d) {
    // The fraction of the ring r on the lit side: all, none or an arc.
    constexpr int kRings = 20000;
    const double step = 60 * d / kRings;
    double lit = 0;
    for (int i = 0; i < kRings; ++i) {
        const double r = (i + 0.5) * step;
        const double lit_arc =
            r <= std::abs(x) ? (x > 0 ? 1.0 : 0.0) : 1 - std::acos(x / r) / kSkinPi;
        lit +=
            lit_arc * (diffused_fraction(r + 0.5 * step, d) - diffused_fraction(r - 0.5 * step, d));
    }
    return lit;
}

double diffused_strip(double x, double width, double d) {
    return diffused_edge(x + 0.5 * width, d) - diffused_edge(x - 0.5 * width, d);
}

double diffused_patches(std::span<const LitPatch> patches, std::size_t at, double d) {
    const DVec3 here = patches[at].center;
    double sum = 0;
    double total = 0;
    for (const LitPatch& patch : patches) {
        const double area = glm::length(glm::cross(patch.right, patch.up));
        const double far = glm::length(patch.center - here) / std::sqrt(area);
        // Even numbers of points: none lies at the pole of the profile.
        const int points = far > 12 ? 1 : far > 3 ? 4 : far > 0.5 ? 16 : 64;
        double inside = 0;
        for (int i = 0; i < points; ++i) {
            for (int j = 0; j < points; ++j) {
                const DVec3 point = patch.center + ((i + 0.5) / points - 0.5) * patch.right
                                    + ((j + 0.5) / points - 0.5) * patch.up;
                inside += diffusion_profile(glm::length(point - here), d);
            }
        }
        const double weight = inside * area / square(points);
        sum += weight * patch.light;
        total += weight;
    }
    return sum / total;
}

double transmitted(double thickness, double d) {
    return 1 - diffused_fraction(thickness, d);
}

}  // namespace limn::oracle
