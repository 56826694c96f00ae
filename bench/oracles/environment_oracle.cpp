#include "bench/oracles/environment_oracle.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace limn::oracle {
namespace {

constexpr double kEnvironmentPi = std::numbers::pi;

/// Tangent and bitangent: a right-handed frame with `n`.
struct Frame {
    glm::dvec3 t;
    glm::dvec3 b;
};
Frame frame_about(const glm::dvec3& n) {
    const glm::dvec3 other = std::abs(n.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 t = glm::normalize(glm::cross(other, n));
    return {t, glm::cross(n, t)};
}

}  // namespace

glm::dvec3 irradiance(const RadianceFunction& radiance, const glm::dvec3& normal, int steps) {
    const Frame frame = frame_about(normal);
    glm::dvec3 sum(0);
    double weights = 0;
    for (int i = 0; i < steps; ++i) {
        const double theta = 0.5 * kEnvironmentPi * (i + 0.5) / steps;
        const double weight = std::sin(theta) * std::cos(theta);
        for (int j = 0; j < 4 * steps; ++j) {
            const double phi = 0.5 * kEnvironmentPi * (j + 0.5) / steps;
            sum += weight
                   * radiance(
                       std::sin(theta) * (std::cos(phi) * frame.t + std::sin(phi) * frame.b)
                       + std::cos(theta) * normal);
            weights += weight;
        }
    }
    return sum / weights;
}

glm::dvec3 prefiltered(
    const RadianceFunction& radiance, const glm::dvec3& normal, double roughness, int strata) {
    const Frame frame = frame_about(normal);
    const double a2 = std::pow(roughness, 4);
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform;
    glm::dvec3 sum(0);
    double weights = 0;
    for (int i = 0; i < strata * strata; ++i) {
        const double u = (i / strata + uniform(random)) / strata;
        const double phi = 2 * kEnvironmentPi * (i % strata + uniform(random)) / strata;
        // tan^2 of the half vector's angle has the distribution a^2 u / (1 - u).
        const double theta_h = std::atan(std::sqrt(a2 * u / (1 - u)));
        const double theta = 2 * theta_h;
        const double n_l = std::cos(theta);
        if (n_l > 0) {
            sum += n_l
                   * radiance(
                       std::sin(theta) * (std::cos(phi) * frame.t + std::sin(phi) * frame.b)
                       + n_l * normal);
            weights += n_l;
        }
    }
    return sum / weights;
}

}  // namespace limn::oracle
