#pragma once

#include "ecs/components/water_frame.h"
#include "ecs/components/water_ripples.h"

#include <optional>
#include <span>

namespace limn {

// Walls in a ripple field.
//
// A cell whose center is in a wall's section with the rest surface is dry. The nine-point Laplacian
// is a sum of exchanges between neighbors, with weight 4 over an edge and 1 over a corner;
// exchanges with dry cells are removed. Where two cells lie side by side at a straight wall, the
// corners behind it are mirrored, so the weight of their common edge grows by 1. Exchanges are
// symmetric, so walls conserve volume and energy. The kernel ignores walls: its exchanges with dry
// cells are corrected afterwards by a list that is rebuilt only when a wall moves. Dry cells copy
// the adjacent water, so that sampling and drawing see it level off at the wall.
//
// Walls thinner than a cell are widened until they are tight; columns thinner than a cell may have
// no effect. Walls below the rest surface do not affect waves. Slanted walls are staircases, which
// scatter ripples with wavelengths near the cell size.

/// A wall at `world` in the space of a field of this extent with a bottom at `depth` (0: none);
/// empty if outside the field or not finite.
[[nodiscard]] std::optional<PlacedWall> place_wall(
    const WaterWall& wall, const Affine& world, const WaterFrame& frame, float depth,
    const Vec2& extent);

/// Sets the walls of a field. Before the first step, walls displace nothing; later, they displace
/// water like bodies: the content of newly dry cells moves to adjacent ones, and the volume of new
/// walls is raised around them. displace_ripples must be called afterwards to raise bodies again.
void set_ripple_walls(RippleState& state, std::span<const PlacedWall> walls, RippleBorder border);

/// Adds the wall corrections `faces` of a substep from `height` to the next heights (in `before`)
/// of the rows begin .. end; `factor` is the kernel's factor on the Laplacian.
void apply_wall_faces(RippleState& state, std::size_t begin, std::size_t end, float factor);

/// Makes wall cells in `field` copy the adjacent water.
void fill_wall_cells(const RippleState& state, std::vector<float>& field);

}  // namespace limn
