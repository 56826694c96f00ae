#pragma once

#include "ecs/base/math.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Distances to a set of triangles, by a uniform grid of about as many cells as triangles.

class TriangleGrid {
  public:
    /// Three valid indices per triangle, at least one triangle; all positions finite. Both spans
    /// must outlive the grid.
    TriangleGrid(std::span<const Vec3> positions, std::span<const std::uint32_t> indices);

    /// Distance from `p` to the nearest triangle, or to any triangle within `enough` [m].
    [[nodiscard]] float distance(const Vec3& p, float enough) const;

    /// Triangle references in all cells: at most 32 per triangle, unless the grid has only one or a
    /// few cells.
    [[nodiscard]] std::size_t entries() const { return triangles_.size(); }

  private:
    [[nodiscard]] IVec3 cell_of(const Vec3& p) const;
    [[nodiscard]] std::size_t number_of(const IVec3& cell) const;

    struct Box {
        Vec3 low;
        Vec3 high;
    };

    std::span<const Vec3> positions_;
    std::span<const std::uint32_t> indices_;
    Vec3 low_ = {0, 0, 0};
    float side_ = 1;                        ///< of a cell [m]
    IVec3 cells_ = {1, 1, 1};               ///< along each axis
    std::vector<std::uint32_t> first_;      ///< start of each cell's list, plus the end
    std::vector<std::uint32_t> triangles_;  ///< the cells' lists, one after the other
    std::vector<Box> boxes_;                ///< around each triangle
};

}  // namespace limn
