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

    /// The distance of `p` from the nearest triangle, or any that is at most `enough` [m].
    [[nodiscard]] float distance(const Vec3& p, float enough) const;

    /// Triangles in all cells together: at most 32 times their number, unless a single cell or a
    /// few have all of them.
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
    std::vector<std::uint32_t> first_;      ///< by cell, and the end
    std::vector<std::uint32_t> triangles_;  ///< of one cell after the other
    std::vector<Box> boxes_;                ///< around each triangle
};

}  // namespace limn
