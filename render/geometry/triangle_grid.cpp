#include "render/geometry/triangle_grid.h"

#include "ecs/base/triangle.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <utility>

namespace limn {
namespace {

constexpr float kMaxCells = 128;  // along an axis
/// Mean entries per triangle: long thin triangles cross far more cells than the triangles of an
/// ordinary surface.
constexpr std::size_t kMaxEntries = 32;

template <typename Visit>
void for_cells(const IVec3& low, const IVec3& high, Visit visit) {
    for (int z = low.z; z <= high.z; ++z) {
        for (int y = low.y; y <= high.y; ++y) {
            for (int x = low.x; x <= high.x; ++x) {
                visit(IVec3(x, y, z));
            }
        }
    }
}

/// The cells of 0 .. cells - 1 whose largest distance from `center` along an axis is `ring`.
template <typename Visit>
void for_ring(const IVec3& center, int ring, const IVec3& cells, Visit visit) {
    const IVec3 low = glm::max(center - ring, IVec3(0));
    const IVec3 high = glm::min(center + ring, cells - 1);
    for (int z = low.z; z <= high.z; ++z) {
        for (int y = low.y; y <= high.y; ++y) {
            const bool whole_row = std::abs(z - center.z) == ring || std::abs(y - center.y) == ring;
            const int step = whole_row || ring == 0 ? 1 : 2 * ring;
            for (int x = whole_row ? low.x : center.x - ring; x <= high.x; x += step) {
                if (x >= 0) {
                    visit(IVec3(x, y, z));
                }
            }
        }
    }
}

}  // namespace

TriangleGrid::TriangleGrid(std::span<const Vec3> positions, std::span<const std::uint32_t> indices)
    : positions_(positions), indices_(indices) {
    Vec3 high = positions[indices[0]];
    low_ = high;
    for (const std::uint32_t index : indices) {
        low_ = glm::min(low_, positions[index]);
        high = glm::max(high, positions[index]);
    }
    // A surface of n triangles covers about as many cells as triangles if the grid has sqrt(n)
    // cells a side.
    const Vec3 size = high - low_;
    const float longest = std::max({size.x, size.y, size.z, 1e-6f});
    const auto count = static_cast<float>(indices.size() / 3);
    const float along = std::clamp(std::sqrt(count), 1.0f, kMaxCells);
    const std::size_t triangles = indices.size() / 3;
    const auto cells_of = [&](std::size_t t) {
        const Vec3& a = positions[indices[3 * t]];
        const Vec3& b = positions[indices[3 * t + 1]];
        const Vec3& c = positions[indices[3 * t + 2]];
        return std::pair(
            cell_of(glm::min(glm::min(a, b), c)), cell_of(glm::max(glm::max(a, b), c)));
    };
    const auto count_entries = [&] {
        std::size_t entries = 0;
        for (std::size_t t = 0; t < triangles; ++t) {
            const auto [from, to] = cells_of(t);
            const IVec3 extent = to - from + 1;
            entries += static_cast<std::size_t>(extent.x * extent.y) * extent.z;
        }
        return entries;
    };
    for (float fineness = along;; fineness /= 2) {
        side_ = longest / fineness;
        cells_ = glm::min(IVec3(size / side_) + 1, IVec3(static_cast<int>(kMaxCells) + 1));
        if (fineness < 2 || count_entries() <= kMaxEntries * triangles) {
            break;
        }
    }
    for (std::size_t t = 0; t < triangles; ++t) {
        const Vec3& a = positions[indices[3 * t]];
        const Vec3& b = positions[indices[3 * t + 1]];
        const Vec3& c = positions[indices[3 * t + 2]];
        boxes_.push_back({glm::min(glm::min(a, b), c), glm::max(glm::max(a, b), c)});
    }
    first_.resize(number_of(cells_ - 1) + 2);
    const auto for_cells_of = [&](std::size_t t, auto visit) {
        const auto [from, to] = cells_of(t);
        for_cells(from, to, visit);
    };
    for (std::size_t t = 0; t < triangles; ++t) {
        for_cells_of(t, [&](const IVec3& cell) { ++first_[number_of(cell) + 1]; });
    }
    for (std::size_t i = 1; i < first_.size(); ++i) {
        first_[i] += first_[i - 1];
    }
    triangles_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t t = 0; t < triangles; ++t) {
        for_cells_of(t, [&](const IVec3& cell) {
            triangles_[next[number_of(cell)]++] = static_cast<std::uint32_t>(t);
        });
    }
}

IVec3 TriangleGrid::cell_of(const Vec3& p) const {
    return glm::clamp(IVec3(glm::floor((p - low_) / side_)), IVec3(0), cells_ - 1);
}

std::size_t TriangleGrid::number_of(const IVec3& cell) const {
    return static_cast<std::size_t>((cell.z * cells_.y + cell.y) * cells_.x + cell.x);
}

float TriangleGrid::distance(const Vec3& p, float enough) const {
    const IVec3 center = cell_of(p);
    const int rings = std::max({cells_.x, cells_.y, cells_.z});
    // Lower bound of the distance from p to the cells beyond a ring, on the sides where there are
    // any.
    const auto beyond = [&](int ring) {
        float bound = INFINITY;
        for (int axis = 0; axis < 3; ++axis) {
            const float at = (p[axis] - low_[axis]) / side_;
            const int low = center[axis] - ring;
            const int high = center[axis] + ring + 1;
            bound = low > 0 ? std::min(bound, at - static_cast<float>(low)) : bound;
            bound = high < cells_[axis] ? std::min(bound, static_cast<float>(high) - at) : bound;
        }
        return (bound - 0.001f) * side_;  // against rounding
    };
    float nearest = INFINITY;
    for (int ring = 0; ring <= rings; ++ring) {
        for_ring(center, ring, cells_, [&](const IVec3& cell) {
            if (nearest <= enough) {
                return;
            }
            const std::size_t number = number_of(cell);
            for (std::uint32_t i = first_[number]; i < first_[number + 1]; ++i) {
                const Box& box = boxes_[triangles_[i]];
                const Vec3 offset = p - glm::clamp(p, box.low, box.high);
                if (glm::dot(offset, offset) >= nearest * nearest) {
                    continue;
                }
                const std::uint32_t* corner = &indices_[std::size_t{3} * triangles_[i]];
                nearest = std::min(
                    nearest,
                    distance_to_triangle(
                        p, positions_[corner[0]], positions_[corner[1]], positions_[corner[2]]));
            }
        });
        if (nearest <= std::max(enough, beyond(ring))) {
            break;
        }
    }
    return nearest;
}

}  // namespace limn
