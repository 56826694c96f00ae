#include "systems/crowd/flow_field.h"

#include "ecs/base/check.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

// Techniques: char.flock

namespace limn {
namespace {

constexpr float kMaxCells = 1000;  // along a side
constexpr float kNoWay = std::numeric_limits<float>::infinity();

Vec2 flow_cell_center(const FlowGrid& grid, std::uint32_t i, std::uint32_t j) {
    return grid.origin
           + grid.cell * Vec2(static_cast<float>(i) + 0.5f, static_cast<float>(j) + 0.5f);
}

/// Cells that wait to be visited, by length, then by index.
using MarchCell = std::pair<float, std::uint32_t>;

struct MarchFront {
    std::vector<MarchCell> heap{};

    void push(float length, std::uint32_t cell) {
        heap.emplace_back(length, cell);
        std::push_heap(heap.begin(), heap.end(), std::greater<>());
    }
    MarchCell pop() {
        std::pop_heap(heap.begin(), heap.end(), std::greater<>());
        const MarchCell least = heap.back();
        heap.pop_back();
        return least;
    }
};

/// Length at a cell's neighbor, kNoWay outside.
float length_at(const FlowGrid& grid, const FlowField& field, std::uint32_t i, std::uint32_t j) {
    return i < grid.columns && j < grid.rows ? field.length[std::size_t{j} * grid.columns + i]
                                             : kNoWay;
}

/// The smaller length of both neighbors along each axis.
Vec2 upwind_lengths(const FlowGrid& grid, const FlowField& field, std::uint32_t cell) {
    const std::uint32_t i = cell % grid.columns;
    const std::uint32_t j = cell / grid.columns;
    return {
        std::min(length_at(grid, field, i - 1, j), length_at(grid, field, i + 1, j)),
        std::min(length_at(grid, field, i, j - 1), length_at(grid, field, i, j + 1))};
}

/// Solves ((t - x) / cell)^2 + ((t - y) / cell)^2 = 1 upwind.
float solve_eikonal(const Vec2& upwind, float cell) {
    const float low = std::min(upwind.x, upwind.y);
    const float difference = std::abs(upwind.x - upwind.y);
    if (!(difference < cell)) {  // also where both are infinite
        return low + cell;
    }
    return 0.5f * (upwind.x + upwind.y + std::sqrt(2 * square(cell) - square(difference)));
}

/// Where the ways end: free cells of the disc, else the free cell nearest to it.
void start_front(
    const FlowGrid& grid, const Vec2& goal, float radius, FlowField& field, MarchFront& front) {
    float nearest = kNoWay;
    std::uint32_t nearest_cell = 0;
    bool is_free = false;
    for (std::uint32_t cell = 0; cell < field.length.size(); ++cell) {
        if (grid.blocked[cell] != 0) {
            continue;
        }
        const Vec2 offset = flow_cell_center(grid, cell % grid.columns, cell / grid.columns) - goal;
        const float distance = std::sqrt(glm::dot(offset, offset));
        if (distance <= radius + grid.cell) {
            is_free = is_free || distance <= std::max(radius, grid.cell);
            field.length[cell] = distance;
            front.push(distance, cell);
        }
        if (distance < nearest) {
            nearest = distance;
            nearest_cell = cell;
        }
    }
    field.moved = !is_free;
    if (front.heap.empty() && nearest < kNoWay) {
        field.length[nearest_cell] = 0;
        front.push(0, nearest_cell);
    }
}

void march(const FlowGrid& grid, FlowField& field, MarchFront& front) {
    std::vector<std::uint8_t> done(field.length.size(), 0);
    while (!front.heap.empty()) {
        const std::uint32_t cell = front.pop().second;
        if (done[cell] != 0) {
            continue;
        }
        done[cell] = 1;
        const std::uint32_t i = cell % grid.columns;
        const std::uint32_t j = cell / grid.columns;
        const std::array<std::pair<std::uint32_t, std::uint32_t>, 4> around = {
            {{i - 1, j}, {i + 1, j}, {i, j - 1}, {i, j + 1}}};
        for (const auto& [column, row] : around) {
            if (column >= grid.columns || row >= grid.rows) {
                continue;
            }
            const std::uint32_t next = row * grid.columns + column;
            if (done[next] != 0 || grid.blocked[next] != 0) {
                continue;
            }
            const float length = solve_eikonal(upwind_lengths(grid, field, next), grid.cell);
            if (length < field.length[next]) {
                field.length[next] = length;
                front.push(length, next);
            }
        }
    }
}

/// Against the upwind gradient.
Vec2 descend(const FlowGrid& grid, const FlowField& field, std::uint32_t cell) {
    const std::uint32_t i = cell % grid.columns;
    const std::uint32_t j = cell / grid.columns;
    const float here = field.length[cell];
    const auto along = [here](float before, float after) {
        if (std::min(before, after) >= here) {
            return 0.0f;
        }
        return before < after ? before - here : here - after;
    };
    const Vec2 way = {
        along(length_at(grid, field, i - 1, j), length_at(grid, field, i + 1, j)),
        along(length_at(grid, field, i, j - 1), length_at(grid, field, i, j + 1))};
    const float length2 = glm::dot(way, way);
    return length2 > 0 ? way / std::sqrt(length2) : Vec2(0);
}

}  // namespace

FlowGrid make_flow_grid(
    const Vec2& center, const Vec2& size, float cell, float clearance,
    std::span<const CrowdBarrier> barriers) {
    LIMN_CHECK(size.x > 0 && size.y > 0 && cell > 0);
    FlowGrid grid;
    grid.cell = std::max(cell, std::max(size.x, size.y) / kMaxCells);
    grid.columns = static_cast<std::uint32_t>(std::max(std::ceil(size.x / grid.cell), 2.0f));
    grid.rows = static_cast<std::uint32_t>(std::max(std::ceil(size.y / grid.cell), 2.0f));
    grid.origin =
        center
        - 0.5f * grid.cell * Vec2(static_cast<float>(grid.columns), static_cast<float>(grid.rows));
    grid.blocked.assign(std::size_t{grid.columns} * grid.rows, 0);
    for (std::uint32_t j = 0; j < grid.rows; ++j) {
        for (std::uint32_t i = 0; i < grid.columns; ++i) {
            const Vec2 point = flow_cell_center(grid, i, j);
            for (const CrowdBarrier& barrier : barriers) {
                if (find_barrier(barrier, point).distance < clearance) {
                    grid.blocked[std::size_t{j} * grid.columns + i] = 1;
                    break;
                }
            }
        }
    }
    return grid;
}

FlowField solve_flow_field(const FlowGrid& grid, const Vec2& goal, float radius) {
    FlowField field;
    field.length.assign(grid.blocked.size(), kNoWay);
    field.direction.assign(grid.blocked.size(), Vec2(0));
    MarchFront front;
    start_front(grid, goal, radius, field, front);
    march(grid, field, front);
    for (std::uint32_t cell = 0; cell < field.length.size(); ++cell) {
        if (field.length[cell] < kNoWay) {
            field.direction[cell] = descend(grid, field, cell);
        }
    }
    return field;
}

Vec2 find_flow(const FlowGrid& grid, const FlowField& field, const Vec2& point) {
    const Vec2 local = (point - grid.origin) / grid.cell;
    const auto columns = static_cast<float>(grid.columns);
    const auto rows = static_cast<float>(grid.rows);
    if (!(local.x >= 0 && local.x <= columns && local.y >= 0 && local.y <= rows)) {
        return Vec2(0);
    }
    const float x = std::clamp(local.x - 0.5f, 0.0f, columns - 1);
    const float y = std::clamp(local.y - 0.5f, 0.0f, rows - 1);
    const auto i = std::min(static_cast<std::uint32_t>(x), grid.columns - 2);
    const auto j = std::min(static_cast<std::uint32_t>(y), grid.rows - 2);
    const float u = x - static_cast<float>(i);
    const float v = y - static_cast<float>(j);
    const std::size_t cell = std::size_t{j} * grid.columns + i;
    const Vec2 flow = (1 - v) * ((1 - u) * field.direction[cell] + u * field.direction[cell + 1])
                      + v
                            * ((1 - u) * field.direction[cell + grid.columns]
                               + u * field.direction[cell + grid.columns + 1]);
    const float length2 = glm::dot(flow, flow);
    return length2 > 1e-12f ? flow / std::sqrt(length2) : Vec2(0);
}

}  // namespace limn
