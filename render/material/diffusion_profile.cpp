#include "render/material/diffusion_profile.h"

#include "ecs/base/check.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

// Techniques: skin.diffusion

namespace limn {
namespace {

// Sample density is the weighted mean of the profiles, with the widest one stretched: its outer
// rings are so large that they would get too few samples.
constexpr double kStretch = 2;
constexpr double kSampledFraction =
    0.995;  ///< of that mean; light farther out is added to the last ring

/// Radius that contains a fraction of that mean, by bisection.
double radius_of(double fraction, const DiffusionDensity& density, const double (&d)[3]) {
    double low = 0;
    double high = 100 * kStretch * d[0];
    for (int i = 0; i < 60; ++i) {
        const double radius = 0.5 * (low + high);
        const double within = density.widest * diffused_within(radius, kStretch * d[0])
                              + density.middle * diffused_within(radius, d[1])
                              + density.narrowest * diffused_within(radius, d[2]);
        (within < fraction ? low : high) = radius;
    }
    return 0.5 * (low + high);
}

}  // namespace

Vec3 diffusion_distance(const Vec3& albedo, const Vec3& mean_free_path) {
    Vec3 d;
    for (int c = 0; c < 3; ++c) {
        d[c] = mean_free_path[c] / (3.5f + 100 * square(square(albedo[c] - 0.33f)));
    }
    return d;
}

double diffused_within(double radius, double d) {
    return d > 0 ? 1 - 0.25 * std::exp(-radius / d) - 0.75 * std::exp(-radius / (3 * d)) : 1.0;
}

void sample_diffusion(const Vec3& d, const DiffusionDensity& density, std::span<Vec4> samples) {
    LIMN_CHECK(!samples.empty());
    double sorted[3] = {d.x, d.y, d.z};
    std::sort(std::begin(sorted), std::end(sorted), std::greater<>());
    const auto count = static_cast<double>(samples.size());
    const double first = density.center > 0 ? density.center : 1 / count;
    const double others = (1 - first) / std::max(count - 1, 1.0);
    double inner = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const bool last = i + 1 == samples.size();
        const double end = first + static_cast<double>(i) * others;
        const double center = end - 0.5 * (i == 0 ? first : others);
        const double outer = radius_of(kSampledFraction * end, density, sorted);
        samples[i].x = static_cast<float>(radius_of(kSampledFraction * center, density, sorted));
        for (int c = 0; c < 3; ++c) {
            const auto channel = static_cast<double>(d[c]);
            const double within = last ? 1.0 : diffused_within(outer, channel);
            const double previous = i == 0 ? 0.0 : diffused_within(inner, channel);
            samples[i][c + 1] = static_cast<float>(within - previous);
        }
        inner = outer;
    }
}

}  // namespace limn
