#include "content/speech/resample.h"

#include "ecs/base/check.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

// Techniques: face.align-resample, face.fragment-blend

namespace limn {

CurveSpline::CurveSpline(const SampledCurves& curves)
    : curves_(curves), bends_(curves.values.size(), 0.0) {
    const std::size_t count = curves_.size();
    const std::size_t channels = curves_.channels;
    // Tridiagonal system (1 4 1) m = 6 (second difference), with m = 0 at both ends.
    std::vector<double> upper(count, 0.0);
    for (std::size_t i = 1; i + 1 < count; ++i) {
        upper[i] = 1.0 / (4.0 - upper[i - 1]);
    }
    for (std::size_t c = 0; c < channels; ++c) {
        const auto value = [&](std::size_t i) {
            return static_cast<double>(curves_.values[i * channels + c]);
        };
        for (std::size_t i = 1; i + 1 < count; ++i) {
            const double right = 6.0 * (value(i - 1) - 2.0 * value(i) + value(i + 1));
            bends_[i * channels + c] = (right - bends_[(i - 1) * channels + c]) * upper[i];
        }
        for (std::size_t i = count; i-- > 1;) {
            bends_[(i - 1) * channels + c] -= upper[i - 1] * bends_[i * channels + c];
        }
    }
}

void CurveSpline::evaluate(float time, std::span<float> values) const {
    const std::size_t count = curves_.size();
    LIMN_CHECK(count > 0 && values.size() == curves_.channels);
    if (count == 1) {
        std::ranges::copy(curves_.row(0), values.begin());
        return;
    }
    const double at = double{time} * double{curves_.rate};
    const auto i =
        static_cast<std::size_t>(std::clamp(std::floor(at), 0.0, static_cast<double>(count - 2)));
    const double u = at - static_cast<double>(i);
    const double inside = std::clamp(u, 0.0, 1.0);
    for (std::size_t c = 0; c < curves_.channels; ++c) {
        const double a = curves_.row(i)[c];
        const double b = curves_.row(i + 1)[c];
        const double m = bends_[i * curves_.channels + c] / 6.0;
        const double n = bends_[(i + 1) * curves_.channels + c] / 6.0;
        const double v = 1.0 - inside;
        const double curve =
            v * a + inside * b + m * (v * v * v - v) + n * (inside * inside * inside - inside);
        const double slope = b - a - m * (3.0 * v * v - 1.0) + n * (3.0 * inside * inside - 1.0);
        values[c] = static_cast<float>(curve + slope * (u - inside));
    }
}

float map_time(std::span<const float> target, std::span<const float> source, float t) {
    LIMN_CHECK(target.size() == source.size() && target.size() >= 2);
    const auto next = std::upper_bound(target.begin() + 1, target.end() - 1, t);
    const auto i = static_cast<std::size_t>(next - target.begin());
    const float pace = (source[i] - source[i - 1]) / (target[i] - target[i - 1]);
    return source[i - 1] + (t - target[i - 1]) * pace;
}

float blend_weight(float s) {
    const float x = std::clamp(s, 0.0f, 1.0f);
    return x * x * (3.0f - 2.0f * x);
}

}  // namespace limn
