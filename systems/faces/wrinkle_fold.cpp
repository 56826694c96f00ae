#include "systems/faces/wrinkle_fold.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

// Techniques: wrinkle.compression.skin-model, wrinkle.resting

namespace limn {

namespace {

constexpr float kFlat = 1e-6f;        ///< square of a slope that counts as flat
constexpr float kMinNormalZ = 0.05f;  ///< steeper slopes are clamped
constexpr std::size_t kFoldBins = 256;

/// A histogram bin of slope magnitudes.
struct SlopeBin {
    double square = 0;    ///< mean square of its slopes
    double fraction = 0;  ///< of all slopes
};

std::vector<SlopeBin> sort_into_bins(std::span<const Vec2> slopes) {
    float largest = 0;
    for (const Vec2& slope : slopes) {
        largest = std::max(largest, glm::dot(slope, slope));
    }
    std::vector<SlopeBin> bins(kFoldBins);
    double count = 0;
    for (const Vec2& slope : slopes) {
        const float square = glm::dot(slope, slope);
        if (square > kFlat) {
            const auto bin = static_cast<std::size_t>(square / largest * (kFoldBins - 1));
            bins[bin].square += double{square};
            bins[bin].fraction += 1;
            count += 1;
        }
    }
    std::erase_if(bins, [](const SlopeBin& bin) { return bin.fraction == 0; });
    for (SlopeBin& bin : bins) {
        bin.square /= bin.fraction;
        bin.fraction /= count;
    }
    return bins;
}

/// Length of the folded profile relative to the unfolded one.
double length_of(const std::vector<SlopeBin>& bins, double factor) {
    double length = 0;
    for (const SlopeBin& bin : bins) {
        length += bin.fraction * std::sqrt(1 + factor * factor * bin.square);
    }
    return length;
}

/// The factor for an excess `e` > 0 by bisection: the length grows with it, without bound.
double find_factor(const std::vector<SlopeBin>& bins, double e) {
    double low = 0;
    double high = 1;
    while (length_of(bins, high) < 1 + e) {
        high *= 2;
    }
    for (int i = 0; i < 50; ++i) {
        const double center = 0.5 * (low + high);
        (length_of(bins, center) < 1 + e ? low : high) = center;
    }
    return high;
}

}  // namespace

FoldTable make_fold_table(std::span<const Vec2> slopes) {
    FoldTable table = {};
    const std::vector<SlopeBin> bins = sort_into_bins(slopes);
    if (bins.empty()) {
        return table;
    }
    double mean_square = 0;
    for (const SlopeBin& bin : bins) {
        mean_square += bin.fraction * bin.square;
    }
    table[0] = static_cast<float>(std::sqrt(2 / mean_square));  // the limit for small e
    for (std::size_t i = 1; i < table.size(); ++i) {
        const double e = static_cast<double>(i) / (kFoldSteps - 1);
        table[i] = static_cast<float>(find_factor(bins, e) / std::sqrt(e));
    }
    return table;
}

float fold_strength(const FoldTable& table, float e) {
    const float at = std::clamp(e, 0.0f, 1.0f);
    const float step = at * static_cast<float>(kFoldSteps - 1);
    const auto i = std::min(static_cast<std::size_t>(step), table.size() - 2);
    const float factor = std::lerp(table[i], table[i + 1], step - static_cast<float>(i));
    return factor * std::sqrt(at);
}

float rested_ratio(float ratio, float resting) {
    return ratio * square(1 - resting);
}

float fold_excess(float ratio, float slack, float folding) {
    const float shortening = std::max(1 - std::sqrt(std::max(ratio, 0.0f)) - slack, 0.0f);
    return 1 / std::max(1 - folding * shortening, 0.5f) - 1;
}

std::vector<Vec2> wrinkle_slopes(const ImageData& map) {
    std::vector<Vec2> slopes;
    if (map.format != PixelFormat::Rgba8) {
        return slopes;
    }
    slopes.reserve(map.pixels.size() / 4);
    for (std::size_t i = 0; i + 4 <= map.pixels.size(); i += 4) {
        const auto component = [&](std::size_t k) {
            return (static_cast<float>(map.pixels[i + k]) - 128.0f) / 127.0f;
        };
        slopes.push_back(Vec2{component(0), component(1)} / -std::max(component(2), kMinNormalZ));
    }
    return slopes;
}

std::vector<Vec2> layered_slopes(const ImageData& map) {
    std::vector<Vec2> slopes;
    if (map.format != PixelFormat::Rgba8) {
        return slopes;
    }
    slopes.reserve(map.pixels.size() / 2);
    for (std::size_t i = 0; i + 2 <= map.pixels.size(); i += 2) {
        const Vec2 n = (Vec2(map.pixels[i], map.pixels[i + 1]) - 128.0f) / 127.0f;
        const float z2 = std::max(1 - glm::dot(n, n), square(kMinNormalZ));
        slopes.push_back(-n / std::sqrt(z2));
    }
    return slopes;
}

}  // namespace limn
