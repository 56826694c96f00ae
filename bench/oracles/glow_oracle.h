#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <span>
#include <vector>

namespace limn::oracle {

// Glow (light scattered by a lens) as a convolution in double precision, the reference for the
// renderer's pyramid. Images are mirrored at their borders.

/// Linear light, rows from the top.
struct LightImage {
    int width = 0;
    int height = 0;
    std::vector<glm::dvec3> pixels;  ///< (x, y) is at y * width + x

    [[nodiscard]] const glm::dvec3& at(int x, int y) const { return pixels[y * width + x]; }
};

/// A black image.
[[nodiscard]] LightImage make_black_image(int width, int height);

/// A fraction of the light, spread by a Gaussian.
struct Scattering {
    double weight = 0;
    double sigma = 0;  ///< standard deviation [px]
};

/// (1 - strength) I + strength (sum of weight * Gaussian * I).
[[nodiscard]] LightImage
scatter(const LightImage& image, double strength, std::span<const Scattering> parts);

/// The Gaussians that approximate level k of a pyramid of tent and [1 2 1] filters, for weights
/// from level 2 on: they have the same variance, 3/2 4^k - 9/2 square pixels.
[[nodiscard]] std::vector<Scattering> scattering_of_levels(std::span<const float> weights);

/// post.separable-blur: the full 49 weights of the outer product, edges clamped.
[[nodiscard]] LightImage blur_7x7(const LightImage& image, const std::array<double, 7>& weights);

[[nodiscard]] glm::dvec3 sum_of(const LightImage& image);

/// Rotational asymmetry: standard deviation over mean of green along a circle about `center` [px
/// from the top left]; 0 if radially symmetric.
[[nodiscard]] double
rotational_spread(const LightImage& image, const glm::dvec2& center, double radius);

}  // namespace limn::oracle
