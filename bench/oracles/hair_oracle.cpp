#include "bench/oracles/hair_oracle.h"

#include "ecs/base/math.h"

#include <glm/exponential.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace limn::oracle {
namespace {

constexpr double kHairPi = std::numbers::pi;
constexpr double kIndex = 1.55;

double dielectric(double cosine) {
    const double inside = std::sqrt(1 - (1 - square(cosine)) / square(kIndex));
    const double s = (cosine - kIndex * inside) / (cosine + kIndex * inside);
    const double p = (kIndex * cosine - inside) / (kIndex * cosine + inside);
    return 0.5 * (s * s + p * p);
}

/// I0(x) exp(-x), by its integral over half a turn.
double scaled_bessel(double x) {
    constexpr int kSteps = 1000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        sum += std::exp(x * (std::cos(kHairPi * (i + 0.5) / kSteps) - 1));
    }
    return sum / kSteps;
}

double longitudinal(double variance, double to_light, double to_viewer) {
    const double x = std::cos(to_light) * std::cos(to_viewer) / variance;
    return std::exp((std::cos(to_light + to_viewer) - 1) / variance) * scaled_bessel(x)
           / (variance * (1 - std::exp(-2 / variance)));
}

/// Density of the logistic distribution, wrapped around once.
double wrapped_logistic(double angle, double scale) {
    const auto cumulative = [&](double x) { return 1 / (1 + std::exp(-x / scale)); };
    const double x = std::remainder(angle, 2 * kHairPi);
    const double e = std::exp(-std::abs(x) / scale);
    return e / (scale * square(1 + e)) / (cumulative(kHairPi) - cumulative(-kHairPi));
}

}  // namespace

std::array<DVec3, 4>
fiber_light(const HairFiber& fiber, double to_light, double to_viewer, double azimuth, int steps) {
    const double across = fiber.roughness_across;
    const DVec3 root =
        glm::log(glm::max(fiber.color, 1e-6))
        / (5.969 - 0.215 * across + 2.532 * std::pow(across, 2) - 10.73 * std::pow(across, 3)
           + 5.574 * std::pow(across, 4) + 0.245 * std::pow(across, 5));
    const DVec3 absorption = root * root;
    const double scale = std::sqrt(kHairPi / 8)
                         * (0.265 * across + 1.194 * square(across) + 5.372 * std::pow(across, 22));

    const double sine = std::sin(to_viewer);
    const double cosine = std::cos(to_viewer);
    const double inside_cosine = std::sqrt(1 - square(sine / kIndex));
    const double bent_index = std::sqrt(square(kIndex) - square(sine)) / cosine;
    std::array<DVec3, 4> around = {};
    for (int i = 0; i < steps; ++i) {
        const double h = 2 * (i + 0.5) / steps - 1;
        const double in = std::asin(h);
        const double bent = std::asin(h / bent_index);
        const double f = dielectric(cosine * std::cos(in));
        const DVec3 passed = glm::exp(-absorption * (2 * std::cos(bent) / inside_cosine));
        const std::array<DVec3, 3> held = {
            DVec3(f), square(1 - f) * passed, square(1 - f) * f * passed * passed};
        for (int p = 0; p < 3; ++p) {
            const double leaves = 2 * p * bent - 2 * in + p * kHairPi;
            around[p] += held[p] * (wrapped_logistic(azimuth - leaves, scale) / steps);
        }
        around[3] += held[2] * (f * passed / (1.0 - f * passed)) / (2 * kHairPi * steps);
    }

    const double r = fiber.roughness;
    const double variance = square(0.726 * r + 0.812 * square(r) + 3.7 * std::pow(r, 20));
    around[0] *= longitudinal(variance, to_light, to_viewer + 2 * fiber.tilt);
    around[1] *= longitudinal(0.25 * variance, to_light, to_viewer - fiber.tilt);
    const double inner = longitudinal(4 * variance, to_light, to_viewer - 3 * fiber.tilt);
    around[2] *= inner;
    around[3] *= inner;
    return around;
}

}  // namespace limn::oracle
