#include "render/material/hair_lobes.h"

#include "ecs/base/math.h"

#include <cmath>
#include <numbers>

// Techniques: hair.shading

namespace limn {
namespace {

// Fits for a smooth strand with an index of refraction of 1.55, for inclinations up to 45 degrees
// and colors from white to dark brown, within 0.05.
constexpr double kMeanCosineTt = 0.84;
constexpr double kMeanCosineTrt = 0.975;
/// Length of TT's path inside the strand, projected across it and averaged over its width [radii].
constexpr double kMeanPath = 1.851;

/// Mean cosine of the logistic distribution that spreads the azimuths of a rough strand.
double roughness_cosine(double roughness) {
    const double scale =
        std::sqrt(std::numbers::pi / 8)
        * (0.265 * roughness + 1.194 * square(roughness) + 5.372 * std::pow(roughness, 22));
    const double x = std::numbers::pi * scale;
    return x < 1e-6 ? 1 : x / std::sinh(x);
}

/// Concentration of the von Mises distribution with this mean cosine, 0 .. 1 (Best and Fisher
/// 1981).
double concentration(double cosine) {
    if (cosine < 0.53) {
        return 2 * cosine + std::pow(cosine, 3) + 5.0 / 6 * std::pow(cosine, 5);
    }
    if (cosine < 0.85) {
        return -0.4 + 1.39 * cosine + 0.43 / (1 - cosine);
    }
    return 1 / (std::pow(cosine, 3) - 4 * square(cosine) + 3 * cosine);
}

/// Concentration and peak of the lobe of a smooth strand with this mean cosine.
Vec2 azimuthal_lobe(double smooth_cosine, double roughness) {
    const double k = concentration(smooth_cosine * roughness_cosine(roughness));
    const double peak = std::exp(k) / (2 * std::numbers::pi * std::cyl_bessel_i(0.0, k));
    return {static_cast<float>(k), static_cast<float>(peak)};
}

/// Chiang's absorption inside a strand by the square of the logarithm of the color of a mass of
/// such strands [1/radius], times the path of TT.
double absorption(double r) {
    const double fit = 5.969 + r * (-0.215 + r * (2.532 + r * (-10.73 + r * (5.574 + r * 0.245))));
    return kMeanPath / square(fit);
}

}  // namespace

layout::HairBlock make_hair_block(const Material& material) {
    const auto roughness = static_cast<double>(material.roughness_across);
    const Vec2 tt = azimuthal_lobe(kMeanCosineTt, roughness);
    const Vec2 trt = azimuthal_lobe(kMeanCosineTrt, roughness);
    return {
        .azimuth = {tt.x, tt.y, trt.x, trt.y},
        .fiber = {
            static_cast<float>(absorption(roughness)), material.hair_scatter,
            std::cos(material.scale_tilt), std::sin(material.scale_tilt)}};
}

}  // namespace limn
