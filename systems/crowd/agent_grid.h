#pragma once

#include "ecs/base/math.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Points sorted into square cells of the plane, for neighbor searches: a counting sort, then by
// key within a cell, so that the order depends on the set of points alone. Cells of an unbounded
// plane share a table of about one cell a point, which repeats in x and y (a spatial hash whose
// neighbor cells are neighbors in memory): a run may hold points that are far away.

/// A range of slots.
struct SlotRun {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
};

struct AgentGrid {
    float cell = 1;             ///< side of a cell [m]
    std::uint32_t columns = 1;  ///< of the table, and its rows: a power of two
    std::vector<std::uint32_t>
        begins{};  ///< slot of the first point of each cell, then their number
    std::vector<std::uint32_t> order{};  ///< index of the point in each slot
};

/// Sorts finite points; `keys` differ. Coordinates beyond 1e6 cells count as if they were there.
void build_agent_grid(
    std::span<const Vec2> points, std::span<const std::uint64_t> keys, float cell, AgentGrid& grid);

/// Rounds down, without std::floor, which is a call where the compiler may not use SSE 4.1.
[[nodiscard]] inline std::int32_t grid_coordinate(float x, float cells_per_meter) {
    const float cells = std::clamp(x * cells_per_meter, -1e6f, 1e6f);
    const auto toward_zero = static_cast<std::int32_t>(cells);
    return toward_zero - (static_cast<float>(toward_zero) > cells ? 1 : 0);
}

/// The cells that a square of `reach` [m] to each side of a point touches: up to two runs a row.
struct GridWindow {
    std::uint32_t column = 0;   ///< the first one
    std::uint32_t columns = 0;  ///< their number
    std::uint32_t row = 0;
    std::uint32_t rows = 0;
    std::uint32_t straight = 0;  ///< columns before the table repeats

    /// No slot is in two of these.
    [[nodiscard]] SlotRun run(const AgentGrid& grid, std::uint32_t i) const {
        const std::uint32_t* const begins = row_begins(grid, i);
        return {begins[column], begins[column + straight]};
    }
    /// Empty unless straight < columns.
    [[nodiscard]] SlotRun wrapped_run(const AgentGrid& grid, std::uint32_t i) const {
        const std::uint32_t* const begins = row_begins(grid, i);
        return {begins[0], begins[columns - straight]};
    }
    [[nodiscard]] const std::uint32_t* row_begins(const AgentGrid& grid, std::uint32_t i) const {
        return grid.begins.data() + std::size_t{(row + i) & (grid.columns - 1)} * grid.columns;
    }
};

[[nodiscard]] inline GridWindow find_window(const AgentGrid& grid, const Vec2& point, float reach) {
    const std::uint32_t mask = grid.columns - 1;
    const float per_meter = 1 / grid.cell;
    const auto range = [&](float x, std::uint32_t& first, std::uint32_t& count) {
        const std::int32_t low = grid_coordinate(x - reach, per_meter);
        const std::int32_t high = grid_coordinate(x + reach, per_meter);
        first = static_cast<std::uint32_t>(low) & mask;
        count = std::min(static_cast<std::uint32_t>(high - low) + 1, grid.columns);
    };
    GridWindow window;
    range(point.x, window.column, window.columns);
    range(point.y, window.row, window.rows);
    window.straight = std::min(window.columns, grid.columns - window.column);
    return window;
}

/// Calls visit(SlotRun) for the cells that a square of `reach` [m] to each side of a point touches;
/// no slot twice.
template <typename Visit>
void each_run(const AgentGrid& grid, const Vec2& point, float reach, const Visit& visit) {
    const GridWindow window = find_window(grid, point, reach);
    for (std::uint32_t i = 0; i < window.rows; ++i) {
        visit(window.run(grid, i));
        if (window.straight < window.columns) {
            visit(window.wrapped_run(grid, i));
        }
    }
}

}  // namespace limn
