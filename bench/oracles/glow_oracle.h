#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <span>
#include <vector>

namespace limn::oracle {

// Light that a lens scatters, as a convolution in double precision: what the pyramid of the
// renderer is held against. Beyond its border a picture is mirrored.

/// Linear light, rows from the top.
struct LightPicture {
    int width = 0;
    int height = 0;
    std::vector<glm::dvec3> pixels;  ///< (x, y) is at y * width + x

    [[nodiscard]] const glm::dvec3& at(int x, int y) const { return pixels[y * width + x]; }
};

/// Dark, of that size.
[[nodiscard]] LightPicture make_dark(int width, int height);

/// A part of the light, spread as a Gaussian.
struct Scattering {
    double weight = 0;
    double sigma = 0;  ///< standard deviation [px]
};

/// (1 - strength) I + strength (sum of weight * Gaussian * I).
[[nodiscard]] LightPicture
scatter(const LightPicture& picture, double strength, std::span<const Scattering> parts);

/// What level k of a pyramid of tents and [1 2 1] spreads to, of weights from level 2 on: Gaussians
/// of the same variance, 3/2 4^k - 9/2 square pixels.
[[nodiscard]] std::vector<Scattering> scattering_of_levels(std::span<const float> weights);

/// post.separable-blur: all 49 weights of the outer product at once, edges repeated.
[[nodiscard]] LightPicture
blur_7x7(const LightPicture& picture, const std::array<double, 7>& weights);

[[nodiscard]] glm::dvec3 sum_of(const LightPicture& picture);

/// Standard deviation over mean of the green light along a circle about `center` [px, from the
/// left and the top]: 0 if it is as round as can be.
[[nodiscard]] double
rotational_spread(const LightPicture& picture, const glm::dvec2& center, double radius);

}  // namespace limn::oracle
