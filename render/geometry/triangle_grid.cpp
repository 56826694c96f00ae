#include "render/geometry/triangle_grid.h"

#include "ecs/base/triangle.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace limn {
namespace {

constexpr float kMaxCells = 128;  // along an axis
/// Entries per triangle, on average: long thin triangles reach through far more cells than a
/// surface of that many has.
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

}  // namespace

TriangleGrid::TriangleGrid(std::span<const Vec3> positions, std::span<const std::uint32_t> indices)
    : positions_(positions), indices_(indices) {
    Vec3 high = positions[indices[0]];
    low_ = high;
    for (const std::uint32_t index : indices) {
        low_ = glm::min(low_, positions[index]);
        high = glm::max(high, positions[index]);
    }
    // Surfaces fill a share of the cells that grows as the area: sides as the square root.
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
        const Vec3 center = (a + b + c) / 3.0f;
        const float radius = std::max(
            {glm::distance(center, a), glm::distance(center, b), glm::distance(center, c)});
        balls_.push_back({center, 1.0001f * radius});  // against rounding
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
    const IVec3 middle = cell_of(p);
    const int rings = std::max({cells_.x, cells_.y, cells_.z});
    // A point outside of the grid is farther from the cells beyond a ring than one inside.
    float nearest = INFINITY;
    for (int ring = 0; ring <= rings; ++ring) {
        const IVec3 low = glm::max(middle - ring, IVec3(0));
        const IVec3 high = glm::min(middle + ring, cells_ - 1);
        for_cells(low, high, [&](const IVec3& cell) {
            const IVec3 away = glm::abs(cell - middle);
            if (std::max({away.x, away.y, away.z}) != ring || nearest <= enough) {
                return;
            }
            const std::size_t number = number_of(cell);
            for (std::uint32_t i = first_[number]; i < first_[number + 1]; ++i) {
                const Ball& ball = balls_[triangles_[i]];
                const Vec3 offset = p - ball.center;
                if (glm::dot(offset, offset) >= square(nearest + ball.radius)) {
                    continue;
                }
                const std::uint32_t* corner = &indices_[std::size_t{3} * triangles_[i]];
                nearest = std::min(
                    nearest,
                    distance_to_triangle(
                        p, positions_[corner[0]], positions_[corner[1]], positions_[corner[2]]));
            }
        });
        if (nearest <= std::max(enough, static_cast<float>(ring) * side_)) {
            break;
        }
    }
    return nearest;
}

}  // namespace limn
