#pragma once

#include "ecs/components/water_ripples.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace limn {

// The grid of a RippleState: positions of its cells, and iteration over the cells of an ellipse.

/// A range of cells, excluding `last`.
struct CellBox {
    IVec2 first;
    IVec2 last;
};

/// Bounding box of an ellipse, clipped to the grid.
[[nodiscard]] inline CellBox
box_around(const RippleState& state, const Vec2& center, const Vec2& radius) {
    const Vec2 center_cell = center / state.cell + 0.5f * Vec2(state.cells) - 0.5f;
    const Vec2 radius_cells = radius / state.cell;
    CellBox box;
    for (int axis = 0; axis < 2; ++axis) {
        const float cells = static_cast<float>(state.cells[axis]);
        const float from =
            std::clamp(std::ceil(center_cell[axis] - radius_cells[axis]), 0.0f, cells);
        const float to =
            std::clamp(std::floor(center_cell[axis] + radius_cells[axis]) + 1, 0.0f, cells);
        box.first[axis] = static_cast<int>(from);
        box.last[axis] = static_cast<int>(to);
    }
    return box;
}

/// Center of a cell, in the water's local space.
[[nodiscard]] inline Vec2 cell_center(const RippleState& state, int x, int z) {
    return state.cell * (Vec2(x, z) + 0.5f - 0.5f * Vec2(state.cells));
}

[[nodiscard]] inline bool is_over(const RippleState& state, const Vec2& at) {
    const Vec2 half = 0.5f * state.size();
    return std::abs(at.x) <= half.x && std::abs(at.y) <= half.y;
}

/// Array index of the cell that contains a point over the grid.
[[nodiscard]] inline std::size_t cell_at(const RippleState& state, const Vec2& point) {
    const Vec2 cell = glm::floor(point / state.cell + 0.5f * Vec2(state.cells));
    const IVec2 on = glm::clamp(IVec2(cell), IVec2(0), state.cells - 1);
    return state.at(on.x, on.y);
}

/// Whether the cell at an array index is a wall.
[[nodiscard]] inline bool is_dry(const RippleState& state, std::size_t at) {
    return !state.dry.empty() && state.dry[at] != 0;
}

/// (1 - u^2)^2 with u the distance from the center in radii; 0 outside.
[[nodiscard]] inline float bump(const Vec2& from_center, const Vec2& radius) {
    const Vec2 u = from_center / radius;
    const float rest = std::max(0.0f, 1.0f - (u.x * u.x + u.y * u.y));
    return rest * rest;
}

/// Calls body(index, weight, x, z) for each water cell in an ellipse, with its bump as weight.
template <typename Body>
void each_bump_cell(const RippleState& state, const Vec2& center, const Vec2& radius, Body&& body) {
    const CellBox box = box_around(state, center, radius);
    for (int z = box.first.y; z < box.last.y; ++z) {
        for (int x = box.first.x; x < box.last.x; ++x) {
            const std::size_t at = state.at(x, z);
            if (!is_dry(state, at)) {
                body(at, bump(cell_center(state, x, z) - center, radius), x, z);
            }
        }
    }
}

}  // namespace limn
