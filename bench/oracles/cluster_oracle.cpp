#include "bench/oracles/cluster_oracle.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn::oracle {
namespace {

struct Interval {
    double low;
    double high;
};

/// Bounds of slope times distance.
Interval product(const Interval& slope, const Interval& distance) {
    return {
        std::min(slope.low * distance.low, slope.low * distance.high),
        std::max(slope.high * distance.low, slope.high * distance.high)};
}

double gap(double x, const Interval& interval) {
    return std::max({interval.low - x, x - interval.high, 0.0});
}

/// Bounds of x / z over a tile; NDC runs from -1 to 1 over the image.
Interval
slopes_of_tile(int tile, const ClusterShape& shape, int pixels, double jitter, double tangent) {
    const auto slope = [&](int edge) {
        return ((edge * shape.tile - jitter) / pixels * 2 - 1) * tangent;
    };
    return {slope(tile), slope(tile + 1)};
}

}  // namespace

bool reaches(const LightRange& light, const DVec3& point) {
    const DVec3 offset = point - DVec3(light.center);
    const double distance = glm::length(offset);
    return distance < light.radius
           && (light.cosine <= -1 || glm::dot(offset, DVec3(light.axis)) > light.cosine * distance);
}

std::vector<std::vector<std::uint32_t>> brute_force_lists(
    const RenderView& view, const ClusterShape& shape, std::span<const LightRange> lights,
    double slack) {
    const auto& r = view.world_from_camera.row;
    const auto column = [&](int c) { return DVec3(r[0][c], r[1][c], r[2][c]); };
    std::vector<std::vector<std::uint32_t>> lists;
    for (int s = 0; s < shape.slices; ++s) {
        const auto distance = [&](int edge) {
            return edge == 0 ? 0.0
                   : edge == shape.slices
                       ? 1e12
                       : std::exp2(
                           (static_cast<double>(edge) - shape.depth_bias) / shape.depth_scale);
        };
        const Interval z = {distance(s), distance(s + 1)};
        for (int row = 0; row < shape.rows; ++row) {
            const Interval y =
                product(slopes_of_tile(row, shape, view.height, view.jitter.y, view.tangent.y), z);
            for (int c = 0; c < shape.columns; ++c) {
                const Interval x =
                    product(slopes_of_tile(c, shape, view.width, view.jitter.x, view.tangent.x), z);
                std::vector<std::uint32_t>& list = lists.emplace_back();
                for (std::size_t i = 0; i < lights.size(); ++i) {
                    const DVec3 offset = DVec3(lights[i].center) - column(3);
                    const DVec3 apart = {
                        gap(glm::dot(offset, column(0)), x), gap(glm::dot(offset, column(1)), y),
                        gap(-glm::dot(offset, column(2)), z)};
                    if (glm::length(apart) <= lights[i].radius * (1 + slack) + slack * z.low) {
                        list.push_back(static_cast<std::uint32_t>(i));
                    }
                }
            }
        }
    }
    return lists;
}

}  // namespace limn::oracle
