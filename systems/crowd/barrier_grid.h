#pragma once

#include "ecs/base/math.h"
#include "systems/crowd/crowd_barrier.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

/// Barriers by square cells of the plane, so that walkers look at those alone that are near. Cells
/// share a table that repeats in x and y: far barriers may be listed too.
struct BarrierGrid {
    std::vector<CrowdBarrier> barriers{};  ///< all
    float reach = -1;           ///< distance of a rim up to which a cell lists it [m]; < 0: empty
    std::uint32_t columns = 1;  ///< of the table, and its rows: a power of two
    std::vector<std::uint32_t> begins{0, 0};  ///< of each cell in `listed`, then their number
    std::vector<std::uint32_t> listed{};      ///< indices of barriers, ascending in each cell
};

/// Sorts finite barriers, unless the grid is one of the same barriers with the same reach >= 0.
void update_barrier_grid(std::span<const CrowdBarrier> barriers, float reach, BarrierGrid& grid);

/// Indices of barriers, ascending: all whose rims are within `reach` of the point, and others.
[[nodiscard]] std::span<const std::uint32_t>
find_near_barriers(const BarrierGrid& grid, const Vec2& point);

}  // namespace limn
