#include "bench/oracles/glare_oracle.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>

// Techniques: post.glare-heat-haze

namespace limn::oracle {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr double kGlarePi = 3.14159265358979323846;

double cross(const dvec2& a, const dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

/// The Fourier transform of a polygon at the frequency `k` [rad per length] is a sum over its
/// sides (S.-W. Lee and R. Mittra, "Fourier transform of a polygonal shape function", 1983).
std::complex<double> transform_of(const std::vector<dvec2>& corners, const dvec2& k) {
    std::complex<double> sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const dvec2 side = corners[(i + 1) % corners.size()] - corners[i];
        const dvec2 center = corners[i] + 0.5 * side;
        const double half = 0.5 * glm::dot(k, side);
        const double sinc = std::abs(half) < 1e-9 ? 1.0 : std::sin(half) / half;
        sum += cross(k, side) * sinc * std::polar(1.0, -glm::dot(k, center));
    }
    return sum * std::complex<double>(0, 1) / glm::dot(k, k);
}

double luminance(const dvec3& light) {
    return glm::dot(light, dvec3(0.27, 0.67, 0.06));
}

/// Adds `light` at `position` [px from the top left], distributed bilinearly; outside the image it
/// is lost.
void splat(LightImage& image, const dvec2& position, const dvec3& light) {
    const dvec2 corner = glm::floor(position - 0.5);
    const dvec2 fraction = position - 0.5 - corner;
    for (int j = 0; j < 2; ++j) {
        for (int i = 0; i < 2; ++i) {
            const int x = static_cast<int>(corner.x) + i;
            const int y = static_cast<int>(corner.y) + j;
            if (x >= 0 && y >= 0 && x < image.width && y < image.height) {
                image.pixels[y * image.width + x] += (i == 0 ? 1 - fraction.x : fraction.x)
                                                     * (j == 0 ? 1 - fraction.y : fraction.y)
                                                     * light;
            }
        }
    }
}

}  // namespace

std::vector<double> diffraction_angles(int blades, double rotation) {
    std::vector<dvec2> corners;
    for (int i = 0; i < blades; ++i) {
        const double angle = rotation + kGlarePi * (2 * i + 1) / blades;
        corners.emplace_back(std::cos(angle), std::sin(angle));
    }
    constexpr int kAngles = 1440;
    std::vector<double> light(kAngles);
    for (int i = 0; i < kAngles; ++i) {
        const double angle = 2 * kGlarePi * i / kAngles;
        for (double frequency = 60; frequency < 120; frequency += 0.37) {
            const dvec2 k = frequency * dvec2(std::cos(angle), std::sin(angle));
            light[i] += std::norm(transform_of(corners, k));
        }
    }
    const double half = 0.5 * *std::max_element(light.begin(), light.end());
    std::vector<double> angles;
    for (int i = 0; i < kAngles; ++i) {
        const double before = light[(i + kAngles - 1) % kAngles];
        const double after = light[(i + 1) % kAngles];
        if (light[i] > half && light[i] > before && light[i] >= after) {
            angles.push_back(2 * kGlarePi * i / kAngles);
        }
    }
    return angles;
}

double line_density(double distance, double length) {
    const int tents = std::max(static_cast<int>(std::ceil(std::log2(0.5 * length))), 1);
    double density = 0;
    for (int j = 0; j < tents; ++j) {
        const double half_length = std::ldexp(length, -j);
        const double weight = std::ldexp(1.0, j) / (std::ldexp(1.0, tents) - 1);
        density += weight * std::max(1 - std::abs(distance) / half_length, 0.0) / half_length;
    }
    return density;
}

LightImage add_stars(const LightImage& image, const Star& star, double width) {
    constexpr double kStep = 0.25;  // along a line [px]
    std::vector<double> densities;
    double whole = 0;
    for (double s = 0.5 * kStep; s < star.length; s += kStep) {
        densities.push_back(line_density(s, star.length));
        whole += 2 * densities.back();
    }
    LightImage stars = make_black_image(image.width, image.height);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const double light = luminance(image.at(x, y));
            if (light <= star.threshold) {
                continue;
            }
            const dvec3 source = image.at(x, y) * (1 - star.threshold / light) * star.strength
                                 / static_cast<double>(star.lines);
            for (int line = 0; line < star.lines; ++line) {
                const double angle = star.rotation + kGlarePi * line / star.lines;
                const dvec2 along(std::cos(angle), -std::sin(angle));  // rows go down
                for (std::size_t i = 0; i < densities.size(); ++i) {
                    const dvec2 offset = (static_cast<double>(i) + 0.5) * kStep * along;
                    const dvec3 part = densities[i] / whole * source;
                    splat(stars, dvec2(x, y) + 0.5 + offset, part);
                    splat(stars, dvec2(x, y) + 0.5 - offset, part);
                }
            }
        }
    }
    const std::vector<Scattering> wide = {{1.0, width}};
    stars = scatter(stars, 1, wide);
    LightImage sum = image;
    for (std::size_t i = 0; i < sum.pixels.size(); ++i) {
        sum.pixels[i] += dvec3(610.0, 550.0, 465.0) / 550.0 * stars.pixels[i];
    }
    return sum;
}

}  // namespace limn::oracle
