#include "content/bake/motion/motion_filter.h"

#include "ecs/base/rotation.h"

#include <algorithm>
#include <cmath>

// Techniques: char.mocap-cleanup

namespace limn {
namespace {

/// Coefficients of y[n] = b (x[n] + 2 x[n-1] + x[n-2]) - a1 y[n-1] - a2 y[n-2].
struct Biquad {
    double b = 1;
    double a1 = 0;
    double a2 = 0;
};

/// For two passes: each is at cutoff / 0.802, so that together they halve the power at `cutoff`.
Biquad make_butterworth(double rate, double cutoff) {
    const double both_passes = std::pow(std::sqrt(2.0) - 1, 0.25);
    const double w = std::tan(3.14159265358979323846 * cutoff / rate) / both_passes;
    const double scale = 1 / (1 + std::sqrt(2.0) * w + w * w);
    return {w * w * scale, 2 * (w * w - 1) * scale, (1 - std::sqrt(2.0) * w + w * w) * scale};
}

/// One pass over signals that are 0 before their first sample.
void run_biquad(const Biquad& filter, std::vector<double>& signal) {
    double x1 = 0;
    double x2 = 0;
    double y1 = 0;
    double y2 = 0;
    for (double& sample : signal) {
        const double y = filter.b * (sample + 2 * x1 + x2) - filter.a1 * y1 - filter.a2 * y2;
        x2 = x1;
        x1 = sample;
        y2 = y1;
        y1 = y;
        sample = y;
    }
}

template <typename Values, typename Get>
void filter_component(Values values, double rate, double cutoff, const Get& component) {
    std::vector<double> samples;
    samples.reserve(values.size());
    for (auto& value : values) {
        samples.push_back(static_cast<double>(component(value)));
    }
    low_pass(std::span(samples), rate, cutoff);
    for (std::size_t i = 0; i < values.size(); ++i) {
        component(values[i]) = static_cast<float>(samples[i]);
    }
}

}  // namespace

void low_pass(std::span<double> samples, double rate, double cutoff) {
    const std::size_t count = samples.size();
    if (count < 3 || !(cutoff > 0) || !(cutoff < 0.5 * rate)) {
        return;
    }
    // Without the line through both ends the signal begins and ends at 0, and continues beyond by
    // turning about its ends, which keeps its slope.
    const double first = samples.front();
    const double slope = (samples.back() - first) / static_cast<double>(count - 1);
    const auto line = [&](std::size_t i) { return first + slope * static_cast<double>(i); };
    const auto settling = static_cast<std::size_t>(2 * rate / cutoff) + 1;
    const std::size_t pad = std::min(settling, count - 1);
    std::vector<double> signal(count + 2 * pad, 0.0);
    for (std::size_t i = 0; i < count; ++i) {
        signal[pad + i] = samples[i] - line(i);
    }
    for (std::size_t i = 1; i <= pad; ++i) {
        signal[pad - i] = -signal[pad + i];
        signal[pad + count - 1 + i] = -signal[pad + count - 1 - i];
    }
    const Biquad filter = make_butterworth(rate, cutoff);
    for (int pass = 0; pass < 2; ++pass) {
        run_biquad(filter, signal);
        std::reverse(signal.begin(), signal.end());
    }
    for (std::size_t i = 0; i < count; ++i) {
        samples[i] = signal[pad + i] + line(i);
    }
}

void low_pass(std::span<Vec3> path, float rate, float cutoff) {
    for (int axis = 0; axis < 3; ++axis) {
        filter_component(
            path, static_cast<double>(rate), static_cast<double>(cutoff),
            [axis](Vec3& p) -> float& { return p[axis]; });
    }
}

void low_pass(std::span<Quat> rotations, float rate, float cutoff) {
    align_rotations(rotations);
    for (int part = 0; part < 4; ++part) {
        filter_component(
            rotations, static_cast<double>(rate), static_cast<double>(cutoff),
            [part](Quat& q) -> float& { return q[part]; });
    }
    for (Quat& q : rotations) {
        q = normalize_or_identity(q);
    }
}

void smooth_frames(MotionFrames& frames, float cutoff) {
    const std::size_t count = frames.frames();
    for (std::size_t j = 0; j < frames.joints; ++j) {
        std::vector<Quat> rotations;
        std::vector<Vec3> path;
        for (std::size_t f = 0; f < count; ++f) {
            rotations.push_back(frames.rotations[f * frames.joints + j]);
            path.push_back(frames.translations[f * frames.joints + j]);
        }
        low_pass(std::span(rotations), frames.rate, cutoff);
        low_pass(std::span(path), frames.rate, cutoff);
        for (std::size_t f = 0; f < count; ++f) {
            frames.rotations[f * frames.joints + j] = rotations[f];
            frames.translations[f * frames.joints + j] = path[f];
        }
    }
}

}  // namespace limn
