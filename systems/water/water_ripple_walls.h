#pragma once

#include "ecs/components/water_frame.h"
#include "ecs/components/water_ripples.h"

#include <optional>
#include <span>

namespace limn {

// Walls that stand in a ripple field.
//
// A cell whose middle is in a wall's section with the rest surface is dry. Waves meet no cell
// beyond: the Laplacian of nine points is the sum of what neighbors exchange, 4 over an edge and 1
// over a corner, and a wall takes the exchanges with it away. Where two cells lie before a straight
// wall, the corners behind it mirror theirs, so their edge carries 1 more. Each exchange is the
// same for both, so walls keep the volume, and the sum of squares too: nothing grows, and nothing
// is lost. The kernel knows none of it: what it did with cells of walls is taken back along them,
// by a list that is made anew only when one has moved. Cells of walls repeat the water before them,
// so that who asks or draws sees it level off at the wall.
//
// A wall thinner than a cell is as wide as keeps the water out; columns thinner than a cell may
// stop nothing. Walls below the rest surface do nothing to waves. Steps of a cell are walls too:
// a slanted one scatters ripples as short as cells.

/// What a wall at `world` is to a field of this extent with a bottom at `depth` (0: none); nothing
/// if it is not in it, or nowhere.
[[nodiscard]] std::optional<PlacedWall> place_wall(
    const WaterWall& wall, const Affine& world, const WaterFrame& frame, float depth,
    const Vec2& extent);

/// Makes these its walls. What stands there before the first step was there before the water;
/// later the water makes room as it does for bodies: what was in cells that are dry now runs to
/// those beside them, and the volume of walls that have come is raised about them. After it
/// displace_ripples has to raise bodies anew.
void set_ripple_walls(RippleState& state, std::span<const PlacedWall> walls, RippleBorder border);

/// Adds to `next` of the rows begin .. end what `faces` change of a sub-step from `height`;
/// `factor` is what the kernel multiplies the Laplacian with.
void close_faces(RippleState& state, std::size_t begin, std::size_t end, float factor);

/// Cells of walls in `field` repeat the water before them.
void fill_rims(const RippleState& state, std::vector<float>& field);

}  // namespace limn
