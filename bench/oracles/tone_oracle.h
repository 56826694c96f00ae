#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace limn::oracle {

// From radiance to display in double precision, one formula per function, not optimized: the
// reference for the statistics, tone mapper and viewer. Sources are the named spec entries.

/// hdr.luminance: 0.27 R + 0.67 G + 0.06 B.
[[nodiscard]] double luminance(const glm::dvec3& color);

/// hdr.log-average: exp of the mean of ln(delta + L). 0 pixels give delta.
[[nodiscard]] double log_average(std::span<const double> luminances, double delta = 1e-4);

/// hdr.dynamic-range: largest over smallest luminance > 0, without the fraction `clipped` at either
/// end; 1 for a black image.
[[nodiscard]] double dynamic_range(std::span<const double> luminances, double clipped = 0);

/// Statistics of an image. Pixels with NaN or infinity are only counted; others are clamped to 0 ..
/// 65504.
struct ImageStatistics {
    std::size_t finite = 0;
    std::size_t broken = 0;
    glm::dvec3 mean = glm::dvec3(0);
    double log_average = 0;
    double least = 0;  ///< smallest luminance > 0; 0 for a black image
    double largest = 0;
    double clipped_min_luminance = 0;  ///< the same without the clipped fraction
    double clipped_max_luminance = 0;
};
[[nodiscard]] ImageStatistics
measure_image(std::span<const glm::dvec3> pixels, double clipped = 0.001);

/// hdr.compress: L / (1 + L); with a white point, L (1 + L / white^2) / (1 + L).
[[nodiscard]] double compress(double scaled);
[[nodiscard]] double compress(double scaled, double white);

/// hdr.gamma: the value stored for a display of this gamma, and the light that it shows.
[[nodiscard]] double gamma_encode(double linear, double gamma = 2.2);
[[nodiscard]] double gamma_display(double stored, double gamma = 2.2);

/// Linear 0 .. 1 to sRGB (IEC 61966-2-1); clamps.
[[nodiscard]] double srgb_encode(double linear);

/// Khronos Group, "PBR Neutral Tone Mapper", 2024.
[[nodiscard]] glm::dvec3 pbr_neutral(glm::dvec3 color);
/// Stephen Hill's fit of the ACES reference and output transforms, 2017; not clamped.
[[nodiscard]] glm::dvec3 aces_fit(const glm::dvec3& color);

/// hdr.tonemap-shader: 0.3333 (ln(k e max(c - defog, 0) + 1) / k)^exponent, not clamped.
struct KneeSettings {
    double exposure = 1;
    double contrast = 0;       ///< k; 0 omits the logarithm
    double exponent = 0.4545;  ///< 1 / gamma
    double scale = 0.3333;
};
[[nodiscard]] double knee_map(double c, double defog, const KneeSettings& settings);

/// hdr.dodge-burn of scaled luminances in row order, edges clamped. Gaussians are sampled at the
/// pixels and normalized.
struct DodgeBurnSettings {
    double key = 0.18;   ///< alpha
    double phi = 8;      ///< sharpness
    double even = 0.05;  ///< epsilon
    int scales = 9;
};
struct DodgeBurn {
    std::vector<double> display;   ///< Ld
    std::vector<double> surround;  ///< V1 of the selected scale
    std::vector<int> scale;        ///< index of the selected scale
};
[[nodiscard]] DodgeBurn dodge_burn(
    std::span<const double> scaled, int width, int height, const DodgeBurnSettings& settings = {});

/// Gaussian response to the kernel exp(-r^2 / (a1 s)^2) with s = 1.6^scale, a1 = 1 / (2 sqrt 2).
[[nodiscard]] std::vector<double>
gaussian_response(std::span<const double> luminances, int width, int height, int scale);

}  // namespace limn::oracle
