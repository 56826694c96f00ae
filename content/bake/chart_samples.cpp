#include "content/bake/chart_samples.h"

#include "ecs/base/check.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace limn {

namespace {

double cross2(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

int clamped_cell(double x, int count) {
    return static_cast<int>(std::clamp(x, 0.0, static_cast<double>(count)));
}

}  // namespace

Charts::Charts(
    std::span<const Vec2> uvs, std::span<const std::uint32_t> indices, int columns, int rows)
    : columns_(columns) {
    LIMN_CHECK(columns > 0 && rows > 0);
    bins_.resize(static_cast<std::size_t>((rows - 1) / kBinRows + 1));
    constexpr double kMinArea = 1e-9;  // twice the area of a triangle, in samples
    for (std::size_t i = 0; i + 3 <= indices.size(); i += 3) {
        Triangle triangle;
        triangle.index = static_cast<std::int32_t>(i / 3);
        bool finite = true;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec2 uv = uvs[indices[i + k]];
            finite = finite && is_finite(uv);
            triangle.p[k] = glm::dvec2(uv) * glm::dvec2(columns, rows);
        }
        const double area = cross2(triangle.p[1] - triangle.p[0], triangle.p[2] - triangle.p[0]);
        if (!finite || !(std::abs(area) > kMinArea)) {
            ++degenerate_;
            continue;
        }
        const glm::dvec2 low = glm::min(triangle.p[0], glm::min(triangle.p[1], triangle.p[2]));
        const glm::dvec2 high = glm::max(triangle.p[0], glm::max(triangle.p[1], triangle.p[2]));
        constexpr double kSlack = 1e-3;
        if (low.x < -kSlack || low.y < -kSlack || high.x > columns + kSlack
            || high.y > rows + kSlack) {
            ++outside_;
        }
        if (high.x < 0 || high.y < 0 || low.x > columns || low.y > rows) {
            continue;
        }
        triangle.low_row = clamped_cell(std::ceil(low.y - 0.5), rows);
        triangle.high_row = clamped_cell(std::floor(high.y - 0.5) + 1, rows) - 1;
        if (triangle.low_row > triangle.high_row) {
            triangles_.push_back(triangle);  // between rows
            continue;
        }
        for (int bin = triangle.low_row / kBinRows; bin <= triangle.high_row / kBinRows; ++bin) {
            bins_[static_cast<std::size_t>(bin)].push_back(
                static_cast<std::uint32_t>(triangles_.size()));
        }
        triangles_.push_back(triangle);
    }
}

std::size_t Charts::sample(int first, int count, std::vector<ChartSample>& samples) const {
    const auto width = static_cast<std::size_t>(columns_);
    samples.assign(width * static_cast<std::size_t>(count), {});
    std::vector<std::uint8_t> twice(samples.size(), 0);
    // Points on an edge belong to both triangles there; only points well inside count as overlap.
    constexpr double kEdge = -1e-9;
    constexpr double kInside = 1e-3;
    const auto cover = [&](const Triangle& triangle) {
        const int begin = std::max(triangle.low_row, first);
        const int end = std::min(triangle.high_row, first + count - 1);
        const glm::dvec2(&p)[3] = triangle.p;
        const double area = cross2(p[1] - p[0], p[2] - p[0]);
        const double low = std::min({p[0].x, p[1].x, p[2].x});
        const double high = std::max({p[0].x, p[1].x, p[2].x});
        const int left = clamped_cell(std::ceil(low - 0.5), columns_);
        const int right = clamped_cell(std::floor(high - 0.5) + 1, columns_);
        for (int y = begin; y <= end; ++y) {
            for (int x = left; x < right; ++x) {
                const glm::dvec2 at = {x + 0.5, y + 0.5};
                const double w[3] = {
                    cross2(p[1] - at, p[2] - at) / area, cross2(p[2] - at, p[0] - at) / area,
                    cross2(p[0] - at, p[1] - at) / area};
                const double least = std::min({w[0], w[1], w[2]});
                if (least < kEdge) {
                    continue;
                }
                const std::size_t i =
                    static_cast<std::size_t>(y - first) * width + static_cast<std::size_t>(x);
                ChartSample& sample = samples[i];
                if (sample.triangle < 0) {
                    sample.triangle = triangle.index;
                    sample.weights = Vec3(w[0], w[1], w[2]);
                } else if (
                    least > kInside
                    && std::min({sample.weights.x, sample.weights.y, sample.weights.z})
                           > static_cast<float>(kInside)) {
                    twice[i] = 1;
                }
            }
        }
    };
    // A triangle in several bins counts once: in the first of them that has rows of this band.
    for (int bin = first / kBinRows; bin <= (first + count - 1) / kBinRows; ++bin) {
        for (const std::uint32_t i : bins_[static_cast<std::size_t>(bin)]) {
            if (std::max(triangles_[i].low_row, first) / kBinRows == bin) {
                cover(triangles_[i]);
            }
        }
    }
    return static_cast<std::size_t>(std::count(twice.begin(), twice.end(), 1));
}

}  // namespace limn
