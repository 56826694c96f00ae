#include "bench/oracles/glow_oracle.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

// Techniques: post.glow

namespace limn::oracle {
namespace {

constexpr double kGlowPi = 3.14159265358979323846;
constexpr double kCutoff = 6;  // of a Gaussian [standard deviations]: 2e-9 of it is beyond

int mirrored(int at, int size) {
    const int period = 2 * size;
    at = ((at % period) + period) % period;
    return at < size ? at : period - 1 - at;
}

/// Integral of a Gaussian over each pixel about its center pixel; sums to 1.
std::vector<double> gaussian(double sigma) {
    const int radius = static_cast<int>(std::ceil(kCutoff * sigma));
    std::vector<double> weights;
    double sum = 0;
    for (int i = -radius; i <= radius; ++i) {
        weights.push_back(
            std::erf((i + 0.5) / (sigma * std::sqrt(2.0)))
            - std::erf((i - 0.5) / (sigma * std::sqrt(2.0))));
        sum += weights.back();
    }
    for (double& weight : weights) {
        weight /= sum;
    }
    return weights;
}

/// Kernels wider than the image are folded back first, so that a pixel costs one row.
std::vector<double> folded(const std::vector<double>& weights, int size, int at) {
    std::vector<double> row(static_cast<std::size_t>(size), 0.0);
    const int radius = static_cast<int>(weights.size() / 2);
    for (int i = -radius; i <= radius; ++i) {
        row[mirrored(at + i, size)] += weights[i + radius];
    }
    return row;
}

LightImage blur(const LightImage& image, double sigma) {
    const std::vector<double> weights = gaussian(sigma);
    const int width = image.width;
    const int height = image.height;
    LightImage across = make_black_image(width, height);
    for (int x = 0; x < width; ++x) {
        const std::vector<double> row = folded(weights, width, x);
        for (int y = 0; y < height; ++y) {
            glm::dvec3 sum(0);
            for (int i = 0; i < width; ++i) {
                sum += row[i] * image.at(i, y);
            }
            across.pixels[y * width + x] = sum;
        }
    }
    LightImage both = make_black_image(width, height);
    for (int y = 0; y < height; ++y) {
        const std::vector<double> column = folded(weights, height, y);
        for (int i = 0; i < height; ++i) {
            for (int x = 0; column[i] != 0 && x < width; ++x) {
                both.pixels[y * width + x] += column[i] * across.at(x, i);
            }
        }
    }
    return both;
}

/// Catmull-Rom interpolation of the values at -1, 0, 1, 2.
double cubic(const std::array<double, 4>& v, double t) {
    return v[1]
           + 0.5 * t
                 * (v[2] - v[0]
                    + t
                          * (2 * v[0] - 5 * v[1] + 4 * v[2] - v[3]
                             + t * (3 * (v[1] - v[2]) + v[3] - v[0])));
}

double green_at(const LightImage& image, const glm::dvec2& position) {
    const double x = position.x - 0.5;
    const double y = position.y - 0.5;
    const int left = static_cast<int>(std::floor(x));
    const int top = static_cast<int>(std::floor(y));
    std::array<double, 4> rows{};
    for (int j = 0; j < 4; ++j) {
        std::array<double, 4> row{};
        for (int i = 0; i < 4; ++i) {
            row[i] =
                image.at(mirrored(left - 1 + i, image.width), mirrored(top - 1 + j, image.height))
                    .y;
        }
        rows[j] = cubic(row, x - left);
    }
    return cubic(rows, y - top);
}

}  // namespace

LightImage make_black_image(int width, int height) {
    return {
        width, height,
        std::vector<glm::dvec3>(static_cast<std::size_t>(width) * height, glm::dvec3(0))};
}

LightImage scatter(const LightImage& image, double strength, std::span<const Scattering> parts) {
    LightImage sum = image;
    for (glm::dvec3& pixel : sum.pixels) {
        pixel *= 1 - strength;
    }
    for (const Scattering& part : parts) {
        const LightImage blurred = blur(image, part.sigma);
        for (std::size_t i = 0; i < sum.pixels.size(); ++i) {
            sum.pixels[i] += strength * part.weight * blurred.pixels[i];
        }
    }
    return sum;
}

std::vector<Scattering> scattering_of_levels(std::span<const float> weights) {
    std::vector<Scattering> parts;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const double level = 2.0 + static_cast<double>(i);
        parts.push_back({weights[i], std::sqrt(1.5 * std::exp2(2.0 * level) - 4.5)});
    }
    return parts;
}

LightImage blur_7x7(const LightImage& image, const std::array<double, 7>& weights) {
    LightImage blurred = make_black_image(image.width, image.height);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            for (int j = -3; j <= 3; ++j) {
                for (int i = -3; i <= 3; ++i) {
                    blurred.pixels[y * image.width + x] +=
                        weights[i + 3] * weights[j + 3]
                        * image.at(
                            std::clamp(x + i, 0, image.width - 1),
                            std::clamp(y + j, 0, image.height - 1));
                }
            }
        }
    }
    return blurred;
}

glm::dvec3 sum_of(const LightImage& image) {
    glm::dvec3 sum(0);
    for (const glm::dvec3& pixel : image.pixels) {
        sum += pixel;
    }
    return sum;
}

double rotational_spread(const LightImage& image, const glm::dvec2& center, double radius) {
    constexpr int kAngles = 256;
    double sum = 0;
    double squares = 0;
    for (int i = 0; i < kAngles; ++i) {
        const double angle = 2 * kGlowPi * i / kAngles;
        const double value =
            green_at(image, center + radius * glm::dvec2(std::cos(angle), std::sin(angle)));
        sum += value;
        squares += value * value;
    }
    const double mean = sum / kAngles;
    return std::sqrt(std::max(squares / kAngles - mean * mean, 0.0)) / mean;
}

}  // namespace limn::oracle
