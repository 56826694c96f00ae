#pragma once

#include "ecs/base/math.h"
#include "systems/crowd/crowd_barrier.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Ways to a goal for any number of walkers: the length of the shortest way from each cell of a grid
// around the barriers, |grad length| = 1, by fast marching (J. Sethian, "A fast marching level set
// method for monotonically advancing fronts", PNAS 1996), first order; against the gradient leads
// the way. Lengths are up to some 8 % too long, most in diagonal directions; gaps narrower than a
// cell may be missed.

/// Cells of a rectangle; cell (i, j) has index j * columns + i and the center
/// origin + cell * (i + 0.5, j + 0.5).
struct FlowGrid {
    Vec2 origin = {0, 0};
    float cell = 1;  ///< [m]
    std::uint32_t columns = 0;
    std::uint32_t rows = 0;
    std::vector<std::uint8_t> blocked{};  ///< 1: nearer than the clearance to a barrier
};

/// A grid of at least 2x2 cells about `center`. Cells are enlarged where there would be more than a
/// thousand along a side.
[[nodiscard]] FlowGrid make_flow_grid(
    const Vec2& center, const Vec2& size, float cell, float clearance,
    std::span<const CrowdBarrier> barriers);

struct FlowField {
    std::vector<float> length{};    ///< of the way from each cell [m]; INFINITY: there is none
    std::vector<Vec2> direction{};  ///< unit, along it; 0 where there is none
    bool moved = false;  ///< the goal was not free: ways lead to the free cell nearest to it
};

/// The ways to a disc; none where no cell is free.
[[nodiscard]] FlowField solve_flow_field(const FlowGrid& grid, const Vec2& goal, float radius);

/// The way from any point: bilinear between cells; 0 outside the grid, or where there is none.
[[nodiscard]] Vec2 find_flow(const FlowGrid& grid, const FlowField& field, const Vec2& point);

}  // namespace limn
