#include "systems/crowd/agent_grid.h"

#include "ecs/base/check.h"

namespace limn {

void build_agent_grid(
    std::span<const Vec2> points, std::span<const std::uint64_t> keys, float cell,
    AgentGrid& grid) {
    LIMN_CHECK(cell > 0 && points.size() == keys.size());
    grid.cell = cell;
    grid.columns = 4;  // so that the 3x3 cells about a point differ
    while (std::size_t{grid.columns} * grid.columns < points.size()) {
        grid.columns *= 2;
    }
    const std::uint32_t mask = grid.columns - 1;
    const std::size_t cells = std::size_t{grid.columns} * grid.columns;
    thread_local std::vector<std::uint32_t> cell_memory;  // reused between steps
    std::vector<std::uint32_t>& cell_of = cell_memory;
    cell_of.resize(points.size());
    grid.begins.assign(cells + 1, 0);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto column =
            static_cast<std::uint32_t>(grid_coordinate(points[i].x, 1 / cell)) & mask;
        const auto row = static_cast<std::uint32_t>(grid_coordinate(points[i].y, 1 / cell)) & mask;
        cell_of[i] = row * grid.columns + column;
        ++grid.begins[cell_of[i] + 1];
    }
    for (std::size_t i = 1; i < cells; ++i) {
        grid.begins[i + 1] += grid.begins[i];
    }
    grid.order.resize(points.size());
    for (std::size_t i = points.size(); i-- > 0;) {  // backward: begins[c + 1] counts down
        grid.order[--grid.begins[cell_of[i] + 1]] = static_cast<std::uint32_t>(i);
    }
    // Now begins[c + 1] is the first slot of cell c.
    std::copy(grid.begins.begin() + 1, grid.begins.end(), grid.begins.begin());
    grid.begins[cells] = static_cast<std::uint32_t>(points.size());
    if (std::is_sorted(keys.begin(), keys.end())) {
        return;  // and so is each cell
    }
    const auto by_key = [keys](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; };
    for (std::size_t c = 0; c < cells; ++c) {
        const auto begin = grid.order.begin() + grid.begins[c];
        const auto end = grid.order.begin() + grid.begins[c + 1];
        if (!std::is_sorted(begin, end, by_key)) {
            std::sort(begin, end, by_key);
        }
    }
}

}  // namespace limn
