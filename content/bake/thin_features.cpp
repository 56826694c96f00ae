#include "content/bake/thin_features.h"

#include "ecs/base/check.h"
#include "ecs/base/jobs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

// Techniques: relief.thin-features

namespace limn {

namespace {

int floor_of(float x) {  // std::floor is a call
    const int i = static_cast<int>(x);
    return i - (x < static_cast<float>(i) ? 1 : 0);
}

int wrapped(int i, int size) {
    if ((size & (size - 1)) == 0) {
        return i & (size - 1);
    }
    const int rest = i % size;
    return rest < 0 ? rest + size : rest;
}

}  // namespace

int steps_for(float shortest) {
    return std::clamp(static_cast<int>(std::ceil(1 / std::max(shortest, 1e-3f) - 1e-4f)), 8, 256);
}

ThinFeatures
find_thin_features(const BakedMap& relief, bool repeats, float depth, const ThinFeatureRays& rays) {
    LIMN_CHECK(relief.width > 0 && rays.azimuths > 0 && rays.elevations > 0);
    const int step_x = (relief.width - 1) / rays.max_texels + 1;
    const int step_y = (relief.height - 1) / rays.max_texels + 1;
    const int rows = (relief.height - 1) / step_y + 1;
    const auto texel = [&](int x, int y) {
        if (repeats) {
            x = wrapped(x, relief.width);
            y = wrapped(y, relief.height);
        }
        const bool outside = x < 0 || y < 0 || x >= relief.width || y >= relief.height;
        return outside ? 1.0f : relief.texels[relief.at(x, y)].w;
    };
    const auto depth_at = [&](float x, float y) {  // texel centers at whole numbers
        const int ix = floor_of(x);
        const int iy = floor_of(y);
        const float u = x - static_cast<float>(ix);
        const float v = y - static_cast<float>(iy);
        const float top = texel(ix, iy) * (1 - u) + texel(ix + 1, iy) * u;
        const float bottom = texel(ix, iy + 1) * (1 - u) + texel(ix + 1, iy + 1) * u;
        return top * (1 - v) + bottom * v;
    };
    using Counts = std::array<std::size_t, kStretchSamples + 1>;  // of rays by their stretch
    std::vector<Counts> counts(static_cast<std::size_t>(rows), Counts{});
    parallel_for(counts.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
            const float y = static_cast<float>(static_cast<int>(row) * step_y);
            for (int k = 0; k < rays.azimuths * rays.elevations; ++k) {
                const int level = k / rays.azimuths;
                const float elevation =
                    rays.lowest
                    + (rays.highest - rays.lowest) * static_cast<float>(level)
                          / static_cast<float>(std::max(rays.elevations - 1, 1));
                const float azimuth = 2 * kPi * static_cast<float>(k % rays.azimuths)
                                      / static_cast<float>(rays.azimuths);
                // Texels that the ray passes while it goes from the polygon to the floor.
                const float run = depth * static_cast<float>(relief.width) / std::tan(elevation);
                const Vec2 texels = {run * std::cos(azimuth), run * std::sin(azimuth)};
                for (int x = 0; x < relief.width; x += step_x) {
                    const float start = static_cast<float>(x);
                    const float found = shortest_stretch([&](float t) {
                        return depth_at(start + t * texels.x, y + t * texels.y) <= t;
                    });
                    ++counts[row][static_cast<std::size_t>(found * kStretchSamples + 0.5f)];
                }
            }
        }
    });
    Counts sums{};
    std::size_t all = 0;
    for (const Counts& row : counts) {
        for (std::size_t i = 0; i < row.size(); ++i) {
            sums[i] += row[i];
            all += row[i];
        }
    }
    ThinFeatures found;
    std::size_t below = 0;
    bool is_typical = false;
    for (std::size_t i = sums.size(); i-- > 0;) {
        found.shortest = sums[i] > 0 ? static_cast<float>(i) / kStretchSamples : found.shortest;
    }
    for (std::size_t i = 0; i < sums.size() && !is_typical; ++i) {
        below += sums[i];
        is_typical = static_cast<float>(below) > rays.missed * static_cast<float>(all);
        found.typical = static_cast<float>(i) / kStretchSamples;
    }
    found.steps = steps_for(found.typical);
    return found;
}

}  // namespace limn
