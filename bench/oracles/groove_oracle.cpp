#include "bench/oracles/groove_oracle.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace limn::oracle {

namespace {

constexpr std::size_t kStrips = 200;
constexpr int kBounces = 400;

using Strips = std::array<double, kStrips>;  ///< values of a wall, from the bottom to the rim

double along(std::size_t strip, double within) {
    return (static_cast<double>(strip) + within) / static_cast<double>(kStrips);
}

/// Distance between points of opposite walls, `a` and `b` away from the bottom.
double string_length(double slope, double a, double b) {
    return std::hypot((a + b) * std::cos(slope), (a - b) * std::sin(slope));
}

/// Fraction of the light of strip `i` of one wall that falls on strip `j` of the other.
double form_factor(double slope, std::size_t i, std::size_t j) {
    const double a0 = along(i, 0);
    const double a1 = along(i, 1);
    const double b0 = along(j, 0);
    const double b1 = along(j, 1);
    const double crossed = string_length(slope, a0, b0) + string_length(slope, a1, b1);
    const double uncrossed = string_length(slope, a0, b1) + string_length(slope, a1, b0);
    return std::abs(uncrossed - crossed) / (2 * (a1 - a0));
}

double mean(const Strips& strips) {
    double sum = 0;
    for (const double strip : strips) {
        sum += strip;
    }
    return sum / static_cast<double>(kStrips);
}

/// Direct light from (x, y) on the wall at the side `side` (-1: left).
Strips light_directly(double slope, double side, double x, double y) {
    const double cosine = y * std::cos(slope) - side * x * std::sin(slope);
    Strips light;
    for (std::size_t i = 0; i < kStrips; ++i) {
        // Where the ray to the light passes the height of the rims.
        const double t = along(i, 0.5);
        const double passes = side * t * std::cos(slope) + (1 - t) * std::sin(slope) * x / y;
        light[i] = cosine > 0 && std::abs(passes) <= std::cos(slope) ? cosine : 0.0;
    }
    return light;
}

GrooveWalls bounce(double slope, double albedo, const Strips& left, const Strips& right) {
    Strips from_left = {};
    Strips from_right = {};
    for (int n = 0; n < kBounces; ++n) {
        Strips next_left = left;
        Strips next_right = right;
        for (std::size_t i = 0; i < kStrips; ++i) {
            for (std::size_t j = 0; j < kStrips; ++j) {
                const double factor = form_factor(slope, i, j);
                next_left[i] += factor * from_right[j];
                next_right[i] += factor * from_left[j];
            }
        }
        double change = 0;
        for (std::size_t i = 0; i < kStrips; ++i) {
            change = std::fmax(change, std::abs(albedo * next_left[i] - from_left[i]));
            change = std::fmax(change, std::abs(albedo * next_right[i] - from_right[i]));
            from_left[i] = albedo * next_left[i];
            from_right[i] = albedo * next_right[i];
        }
        if (change < 1e-9) {
            break;
        }
    }
    return {.left = mean(from_left), .right = mean(from_right)};
}

}  // namespace

GrooveWalls groove_cosines(double slope, double x, double y) {
    return {
        .left = mean(light_directly(slope, -1, x, y)),
        .right = mean(light_directly(slope, 1, x, y))};
}

GrooveWalls groove_radiosity(double slope, double albedo, double x, double y) {
    return bounce(slope, albedo, light_directly(slope, -1, x, y), light_directly(slope, 1, x, y));
}

double groove_radiosity_around(double slope, double albedo) {
    Strips open;  // the fraction that is not occluded by the other wall
    for (std::size_t i = 0; i < kStrips; ++i) {
        open[i] = 1;
        for (std::size_t j = 0; j < kStrips; ++j) {
            open[i] -= form_factor(slope, i, j);
        }
    }
    return bounce(slope, albedo, open, open).left;
}

}  // namespace limn::oracle
