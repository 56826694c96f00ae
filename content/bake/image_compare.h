#pragma once

#include "ecs/base/math.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Image difference metrics, for tests and `limn compare`. Both images must have the same size; a is
// the reference where it matters. Sums are in double precision and in row order, so that results
// are reproducible.

/// Rows from the top. "Display" images are sRGB-encoded, 0 .. 1. "Linear" ones hold radiance.
struct ColorImage {
    int width = 0;
    int height = 0;
    std::vector<Vec3> pixels;  ///< (x, y) is at y * width + x
};

/// Peak signal-to-noise ratio of display images [dB]: 10 log10(1 / mean squared error over all
/// channels). Infinite if they are equal.
[[nodiscard]] double psnr(const ColorImage& a, const ColorImage& b);

/// Structural similarity of the luma of display images, -1 .. 1, 1 = equal (Z. Wang, A. Bovik, H.
/// Sheikh, E. Simoncelli, "Image Quality Assessment: From Error Visibility to Structural
/// Similarity", 2004): Gaussian window of 11 x 11 with sigma 1.5, K1 = 0.01, K2 = 0.03, mean over
/// the windows inside the image. Images smaller than the window are clamped at their edges.
[[nodiscard]] double ssim(const ColorImage& a, const ColorImage& b);

/// What FLIP assumes of the viewer: 0.7 m from a 4K screen 0.7 m wide [pixels per degree].
inline constexpr float kFlipPixelsPerDegree = 67.0206433f;

/// FLIP error of each pixel, 0 .. 1, as perceived when alternating between two display images (P.
/// Andersson, J. Nilsson, T. Akenine-Moller, M. Oskarsson, K. Astrom, M. Fairchild, "FLIP: A
/// Difference Evaluator for Alternating Images", 2020): contrast sensitivity filters in an opponent
/// space, HyAB distance in Hunt-adjusted L*a*b*, raised where edges or points differ. Symmetric.
[[nodiscard]] std::vector<float>
flip_map(const ColorImage& a, const ColorImage& b, float pixels_per_degree = kFlipPixelsPerDegree);

/// Mean, and the value that 99 % of the pixels do not exceed.
struct ErrorSummary {
    double mean = 0;
    double p99 = 0;
};
[[nodiscard]] ErrorSummary summarize_errors(std::span<const float> errors);

/// Mean over pixels and channels of (b - a)^2 / (a^2 + epsilon), for linear images.
[[nodiscard]] double relative_mse(const ColorImage& a, const ColorImage& b, double epsilon = 0.01);

/// The pixel and channel of the largest difference, the first in row order. NaN against a number is
/// an infinite difference.
struct LargestDifference {
    float difference = 0;  ///< |b - a|
    IVec2 pixel = {0, 0};
    int channel = 0;  ///< 0 red, 1 green, 2 blue
};
[[nodiscard]] LargestDifference largest_difference(const ColorImage& a, const ColorImage& b);

// ---- the metrics of "fake Phong" (fakephong.metric-*)

/// 1 - the mean channel difference over the pixels with a nonzero `mask` (empty mask: all), of
/// display images rounded to 8 bits; 0 .. 1, 1 = equal or no pixel counted. Its values crowd near 1
/// and it is insensitive to the shape of highlights: check a scanline too.
[[nodiscard]] double color_correctness(
    const ColorImage& a, const ColorImage& b, std::span<const std::uint8_t> mask = {});

/// |b - a|^exponent per channel: a difference of one step in 255 shows as 57 % gray.
[[nodiscard]] ColorImage
enhanced_difference(const ColorImage& a, const ColorImage& b, float exponent = 0.1f);

/// (R + G + B) / 3 along a row.
[[nodiscard]] std::vector<float> scanline(const ColorImage& image, int row);

/// Comparison of two scanlines by their peaks and smoothness.
struct ScanlineComparison {
    int peak_shift = 0;      ///< position of b's peak minus a's [px]
    double peak_ratio = 1;   ///< height of b's over a's; 1 where both are 0
    double roughness_a = 0;  ///< largest second difference
    double roughness_b = 0;
    double largest_difference = 0;
};
[[nodiscard]] ScanlineComparison
compare_scanlines(std::span<const float> a, std::span<const float> b);

}  // namespace limn
