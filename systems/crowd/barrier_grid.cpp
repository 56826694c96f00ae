#include "systems/crowd/barrier_grid.h"

#include "ecs/base/check.h"
#include "systems/crowd/agent_grid.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace limn {
namespace {

constexpr float kBarrierCell = 4.0f;  // [m]
constexpr std::uint32_t kMinColumns = 32;
constexpr std::uint32_t kMaxColumns = 256;
constexpr std::int32_t kFarCell = 999999;  // beyond, coordinates are clamped

/// The cell of a point, which is `steps` cells further in the table.
std::uint32_t wrap_cell(std::int32_t cell, std::uint32_t steps, std::uint32_t columns) {
    return (static_cast<std::uint32_t>(cell) + steps) & (columns - 1);
}

std::int32_t barrier_coordinate(float x) {
    return grid_coordinate(x, 1 / kBarrierCell);
}

/// Calls visit(cell) for the cells of which a point may be within `reach` of a barrier, each once.
template <typename Visit>
void each_cell_near(
    const CrowdBarrier& barrier, float reach, std::uint32_t columns, const Visit& visit) {
    const Vec2 x = glm::abs(barrier.axis);
    const Vec2 half = Vec2(
                          x.x * barrier.half.x + x.y * barrier.half.y,
                          x.y * barrier.half.x + x.x * barrier.half.y)
                      + Vec2(barrier.radius + reach);
    const std::int32_t low_x = barrier_coordinate(barrier.center.x - half.x);
    const std::int32_t low_y = barrier_coordinate(barrier.center.y - half.y);
    const std::int32_t high_x = barrier_coordinate(barrier.center.x + half.x);
    const std::int32_t high_y = barrier_coordinate(barrier.center.y + half.y);
    const auto width = static_cast<std::uint32_t>(high_x - low_x) + 1;
    const auto depth = static_cast<std::uint32_t>(high_y - low_y) + 1;
    // Where the box repeats in the table or is clamped, its cells have no single place.
    const bool is_placed =
        width <= columns && depth <= columns
        && std::max({std::abs(low_x), std::abs(low_y), std::abs(high_x), std::abs(high_y)})
               < kFarCell;
    const float limit = reach + 0.7072f * kBarrierCell;  // half a diagonal
    for (std::uint32_t j = 0; j < std::min(depth, columns); ++j) {
        for (std::uint32_t i = 0; i < std::min(width, columns); ++i) {
            const Vec2 center = kBarrierCell
                                * Vec2(
                                    static_cast<float>(low_x) + static_cast<float>(i) + 0.5f,
                                    static_cast<float>(low_y) + static_cast<float>(j) + 0.5f);
            if (!is_placed || find_barrier(barrier, center).distance <= limit) {
                visit(wrap_cell(low_y, j, columns) * columns + wrap_cell(low_x, i, columns));
            }
        }
    }
}

bool same_barriers(std::span<const CrowdBarrier> a, std::span<const CrowdBarrier> b) {
    static_assert(sizeof(CrowdBarrier) == 7 * sizeof(float));
    return a.size() == b.size()
           && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

}  // namespace

void update_barrier_grid(std::span<const CrowdBarrier> barriers, float reach, BarrierGrid& grid) {
    LIMN_CHECK(reach >= 0);
    if (grid.reach == reach && same_barriers(grid.barriers, barriers)) {
        return;
    }
    grid.barriers.assign(barriers.begin(), barriers.end());
    grid.reach = reach;
    grid.columns = kMinColumns;
    while (grid.columns < kMaxColumns && grid.columns * grid.columns < 4 * barriers.size()) {
        grid.columns *= 2;
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> entries;  // cell and barrier
    for (std::uint32_t i = 0; i < barriers.size(); ++i) {
        each_cell_near(barriers[i], reach, grid.columns, [&](std::uint32_t cell) {
            entries.emplace_back(cell, i);
        });
    }
    std::sort(entries.begin(), entries.end());
    grid.begins.assign(std::size_t{grid.columns} * grid.columns + 1, 0);
    grid.listed.clear();
    for (const auto& [cell, barrier] : entries) {
        ++grid.begins[cell + 1];
        grid.listed.push_back(barrier);
    }
    for (std::size_t cell = 1; cell < grid.begins.size(); ++cell) {
        grid.begins[cell] += grid.begins[cell - 1];
    }
}

std::span<const std::uint32_t> find_near_barriers(const BarrierGrid& grid, const Vec2& point) {
    const std::uint32_t column = wrap_cell(barrier_coordinate(point.x), 0, grid.columns);
    const std::uint32_t row = wrap_cell(barrier_coordinate(point.y), 0, grid.columns);
    const std::size_t cell = std::size_t{row} * grid.columns + column;
    return std::span(grid.listed)
        .subspan(grid.begins[cell], grid.begins[cell + 1] - grid.begins[cell]);
}

}  // namespace limn
