#include "bench/oracles/motion_blur_oracle.h"

#include "ecs/base/check.h"

#include <algorithm>
#include <cmath>

// Techniques: post.motion-blur-accumulation

namespace limn::oracle {

double exposure_sample_time(int index, int count, double shutter) {
    return ((index + 0.5) / count - 0.5) * shutter / 360.0;
}

void MeanImage::add(const gpu::FloatImage& image) {
    if (count_ == 0) {
        shape_ = image;
        sum_.assign(image.pixels.size(), 0.0);
    }
    LIMN_CHECK(sum_.size() == image.pixels.size());
    for (std::size_t i = 0; i < sum_.size(); ++i) {
        sum_[i] += static_cast<double>(image.pixels[i]);
    }
    ++count_;
}

gpu::FloatImage MeanImage::mean() const {
    gpu::FloatImage image = shape_;
    for (std::size_t i = 0; i < sum_.size(); ++i) {
        image.pixels[i] = static_cast<float>(sum_[i] / count_);
    }
    return image;
}

std::vector<double> box_filter(std::span<const double> row, double distance) {
    const int count = static_cast<int>(row.size());
    std::vector<double> filtered(row.begin(), row.end());
    if (count == 0 || distance <= 0.0) {
        return filtered;
    }
    for (int i = 0; i < count; ++i) {
        const double low = i + 0.5 - 0.5 * distance;
        const double high = i + 0.5 + 0.5 * distance;
        double sum = 0;
        for (int j = static_cast<int>(std::floor(low)); j < high; ++j) {
            const double overlap = std::min(high, j + 1.0) - std::max(low, static_cast<double>(j));
            sum += overlap * row[static_cast<std::size_t>(std::clamp(j, 0, count - 1))];
        }
        filtered[static_cast<std::size_t>(i)] = sum / distance;
    }
    return filtered;
}

double bar_coverage(double x, double begin, double end, double distance) {
    if (distance <= 0.0) {
        return x >= begin && x < end ? 1.0 : 0.0;
    }
    // It covers x while begin + s <= x < end + s, for s in -distance / 2 .. distance / 2.
    const double low = std::max(x - end, -0.5 * distance);
    const double high = std::min(x - begin, 0.5 * distance);
    return std::max(high - low, 0.0) / distance;
}

double stretch_coverage(double x, double begin, double end, double distance, int samples) {
    if (x < begin || x > end + distance) {
        return 0;
    }
    // Coverage around p by a bar whose ends lie between pixels.
    const auto filtered = [](double p, double low, double high) {
        return std::clamp(std::min(p - low, high - p) + 0.5, 0.0, 1.0);
    };
    double sum = 0;
    for (int i = 0; i < samples; ++i) {
        const double moved = distance * i / (samples - 1);
        sum +=
            filtered(x - moved, begin, end) + filtered(x + moved, begin + distance, end + distance);
    }
    return sum / (2 * samples);
}

}  // namespace limn::oracle
