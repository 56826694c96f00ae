#include "bench/oracles/tone_oracle.h"

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace limn::oracle {
namespace {

constexpr double kLargestHalf = 65504;

/// The sorted luminances > 0 without the fraction `clipped` at either end.
std::vector<double> lit(std::span<const double> luminances, double clipped) {
    std::vector<double> sorted;
    for (const double l : luminances) {
        if (l > 0 && std::isfinite(l)) {
            sorted.push_back(l);
        }
    }
    std::sort(sorted.begin(), sorted.end());
    const auto outside =
        static_cast<std::ptrdiff_t>(std::floor(clipped * static_cast<double>(sorted.size())));
    return sorted.empty() ? sorted
                          : std::vector<double>(sorted.begin() + outside, sorted.end() - outside);
}

}  // namespace

double luminance(const glm::dvec3& color) {
    return 0.27 * color.x + 0.67 * color.y + 0.06 * color.z;
}

double log_average(std::span<const double> luminances, double delta) {
    double sum = 0;
    for (const double l : luminances) {
        sum += std::log(delta + l);
    }
    return luminances.empty() ? delta : std::exp(sum / static_cast<double>(luminances.size()));
}

double dynamic_range(std::span<const double> luminances, double clipped) {
    const std::vector<double> sorted = lit(luminances, clipped);
    return sorted.empty() ? 1 : sorted.back() / sorted.front();
}

ImageStatistics measure_image(std::span<const glm::dvec3> pixels, double clipped) {
    ImageStatistics result;
    std::vector<double> luminances;
    for (const glm::dvec3& pixel : pixels) {
        if (!std::isfinite(pixel.x) || !std::isfinite(pixel.y) || !std::isfinite(pixel.z)) {
            ++result.broken;
            continue;
        }
        const glm::dvec3 light = {
            std::clamp(pixel.x, 0.0, kLargestHalf), std::clamp(pixel.y, 0.0, kLargestHalf),
            std::clamp(pixel.z, 0.0, kLargestHalf)};
        result.mean += light;
        luminances.push_back(luminance(light));
    }
    result.finite = luminances.size();
    result.mean /= std::max(1.0, static_cast<double>(result.finite));
    result.log_average = log_average(luminances);
    const std::vector<double> all = lit(luminances, 0);
    const std::vector<double> inner = lit(luminances, clipped);
    if (!all.empty()) {
        result.least = all.front();
        result.largest = all.back();
        result.clipped_min_luminance = inner.front();
        result.clipped_max_luminance = inner.back();
    }
    return result;
}

double compress(double scaled) {
    return scaled / (1 + scaled);
}

double compress(double scaled, double white) {
    return scaled * (1 + scaled / (white * white)) / (1 + scaled);
}

double gamma_encode(double linear, double gamma) {
    return std::pow(std::max(linear, 0.0), 1 / gamma);
}

double gamma_display(double stored, double gamma) {
    return std::pow(std::max(stored, 0.0), gamma);
}

double srgb_encode(double linear) {
    const double x = std::clamp(linear, 0.0, 1.0);
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

glm::dvec3 pbr_neutral(glm::dvec3 color) {
    const double x = std::min({color.x, color.y, color.z});
    color -= x < 0.08 ? x - 6.25 * x * x : 0.04;
    const double p = std::max({color.x, color.y, color.z});
    if (p < 0.76) {
        return color;
    }
    const double q = 1 - 0.24 * 0.24 / (p + 0.24 - 0.76);
    const double g = 1 / (0.15 * (p - q) + 1);
    return glm::mix(glm::dvec3(q), color * (q / p), g);
}

glm::dvec3 aces_fit(const glm::dvec3& color) {
    const glm::dmat3 input = glm::transpose(glm::dmat3(
        0.59719, 0.35458, 0.04823, 0.07600, 0.90834, 0.01566, 0.02840, 0.13383, 0.83777));
    const glm::dmat3 output = glm::transpose(glm::dmat3(
        1.60475, -0.53108, -0.07367, -0.10208, 1.10813, -0.00605, -0.00327, -0.07276, 1.07602));
    const glm::dvec3 v = input * color;
    const glm::dvec3 a = v * (v + 0.0245786) - 0.000090537;
    const glm::dvec3 b = v * (0.983729 * v + 0.4329510) + 0.238081;
    return output * (a / b);
}

double knee_map(double c, double defog, const KneeSettings& settings) {
    const double exposed = settings.exposure * std::max(c - defog, 0.0);
    const double k = settings.contrast;
    const double bent = k > 0 ? std::log(k * exposed + 1) / k : exposed;
    return settings.scale * std::pow(bent, settings.exponent);
}

std::vector<double>
gaussian_response(std::span<const double> luminances, int width, int height, int scale) {
    const double spread = std::pow(1.6, scale) / (2 * std::sqrt(2.0));
    const int radius = static_cast<int>(std::ceil(4 * spread));
    std::vector<double> kernel;  // the product of two of these is the kernel over the plane
    double sum = 0;
    for (int i = -radius; i <= radius; ++i) {
        kernel.push_back(std::exp(-i * i / (spread * spread)));
        sum += kernel.back();
    }
    const auto blur = [&](std::span<const double> source, int dx, int dy) {
        std::vector<double> blurred(source.size());
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                double value = 0;
                for (int i = -radius; i <= radius; ++i) {
                    const int at_x = std::clamp(x + i * dx, 0, width - 1);
                    const int at_y = std::clamp(y + i * dy, 0, height - 1);
                    value += kernel[static_cast<std::size_t>(i + radius)] / sum
                             * source[static_cast<std::size_t>(at_y) * width + at_x];
                }
                blurred[static_cast<std::size_t>(y) * width + x] = value;
            }
        }
        return blurred;
    };
    return blur(blur(luminances, 1, 0), 0, 1);
}

DodgeBurn dodge_burn(
    std::span<const double> scaled, int width, int height, const DodgeBurnSettings& settings) {
    std::vector<std::vector<double>> responses;
    for (int i = 0; i <= settings.scales; ++i) {
        responses.push_back(gaussian_response(scaled, width, height, i));
    }
    DodgeBurn result;
    for (std::size_t p = 0; p < scaled.size(); ++p) {
        int chosen = 0;
        for (int i = 0; i < settings.scales; ++i) {
            const double v1 = responses[static_cast<std::size_t>(i)][p];
            const double v2 = responses[static_cast<std::size_t>(i) + 1][p];
            const double s = std::pow(1.6, i);
            const double activity =
                (v1 - v2) / (std::pow(2.0, settings.phi) * settings.key / (s * s) + v1);
            if (std::abs(activity) >= settings.even) {
                break;
            }
            chosen = i;
        }
        const double surround = responses[static_cast<std::size_t>(chosen)][p];
        result.scale.push_back(chosen);
        result.surround.push_back(surround);
        result.display.push_back(scaled[p] / (1 + surround));
    }
    return result;
}

}  // namespace limn::oracle
