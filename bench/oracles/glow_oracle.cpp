#include "bench/oracles/glow_oracle.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

// Techniques: post.glow

namespace limn::oracle {
namespace {

constexpr double kGlowPi = 3.14159265358979323846;
constexpr double kReach = 6;  // cut-off of a Gaussian, in standard deviations: 2e-9 of it is beyond

int mirrored(int at, int size) {
    const int period = 2 * size;
    at = ((at % period) + period) % period;
    return at < size ? at : period - 1 - at;
}

/// Integral of a Gaussian over each pixel about its center pixel; sums to 1.
std::vector<double> gaussian(double sigma) {
    const int reach = static_cast<int>(std::ceil(kReach * sigma));
    std::vector<double> weights;
    double sum = 0;
    for (int i = -reach; i <= reach; ++i) {
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
    const int reach = static_cast<int>(weights.size() / 2);
    for (int i = -reach; i <= reach; ++i) {
        row[mirrored(at + i, size)] += weights[i + reach];
    }
    return row;
}

LightImage blur(const LightImage& picture, double sigma) {
    const std::vector<double> weights = gaussian(sigma);
    const int width = picture.width;
    const int height = picture.height;
    LightImage across = make_black_image(width, height);
    for (int x = 0; x < width; ++x) {
        const std::vector<double> row = folded(weights, width, x);
        for (int y = 0; y < height; ++y) {
            glm::dvec3 sum(0);
            for (int i = 0; i < width; ++i) {
                sum += row[i] * picture.at(i, y);
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

double green_at(const LightImage& picture, const glm::dvec2& place) {
    const double x = place.x - 0.5;
    const double y = place.y - 0.5;
    const int left = static_cast<int>(std::floor(x));
    const int top = static_cast<int>(std::floor(y));
    std::array<double, 4> rows{};
    for (int j = 0; j < 4; ++j) {
        std::array<double, 4> row{};
        for (int i = 0; i < 4; ++i) {
            row[i] = picture
                         .at(mirrored(left - 1 + i, picture.width),
                             mirrored(top - 1 + j, picture.height))
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

LightImage scatter(const LightImage& picture, double strength, std::span<const Scattering> parts) {
    LightImage sum = picture;
    for (glm::dvec3& pixel : sum.pixels) {
        pixel *= 1 - strength;
    }
    for (const Scattering& part : parts) {
        const LightImage blurred = blur(picture, part.sigma);
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

LightImage blur_7x7(const LightImage& picture, const std::array<double, 7>& weights) {
    LightImage blurred = make_black_image(picture.width, picture.height);
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            for (int j = -3; j <= 3; ++j) {
                for (int i = -3; i <= 3; ++i) {
                    blurred.pixels[y * picture.width + x] +=
                        weights[i + 3] * weights[j + 3]
                        * picture.at(
                            std::clamp(x + i, 0, picture.width - 1),
                            std::clamp(y + j, 0, picture.height - 1));
                }
            }
        }
    }
    return blurred;
}

glm::dvec3 sum_of(const LightImage& picture) {
    glm::dvec3 sum(0);
    for (const glm::dvec3& pixel : picture.pixels) {
        sum += pixel;
    }
    return sum;
}

double rotational_spread(const LightImage& picture, const glm::dvec2& center, double radius) {
    constexpr int kAngles = 256;
    double sum = 0;
    double squares = 0;
    for (int i = 0; i < kAngles; ++i) {
        const double angle = 2 * kGlowPi * i / kAngles;
        const double value =
            green_at(picture, center + radius * glm::dvec2(std::cos(angle), std::sin(angle)));
        sum += value;
        squares += value * value;
    }
    const double mean = sum / kAngles;
    return std::sqrt(std::max(squares / kAngles - mean * mean, 0.0)) / mean;
}

}  // namespace limn::oracle
