#pragma once

#include "ecs/base/math.h"

#include <vector>

namespace limn {

// Polygons of skin as cells of a Voronoi diagram (Ishii et al. 1993), in nested levels: the older
// method for the pattern of skin, which is isotropic. Polygons also emerge between furrows drawn
// along fields (furrow_trace.h); cells serve as the finest relief between them.

struct SkinCells {
    int cells = 48;  ///< along each side of the image, >= 2
    int levels = 2;  ///< 1 .. 4; each has twice as many cells and edges half as deep
    int seed = 1;
};

/// Height per pixel of a square image that tiles: 0 on the edges of the coarsest cells, up to 1
/// inside; with one level 1 at the sites. Rows from top to bottom. `size` >= 1 [px].
[[nodiscard]] std::vector<float> make_skin_cells(int size, const SkinCells& cells);

/// The same at one point of the image, 0 .. 1.
[[nodiscard]] float skin_cell_height(const Vec2& uv, const SkinCells& cells);

/// The site of the cell in this row and column of the coarsest level, 0 .. 1.
[[nodiscard]] Vec2 skin_cell_site(const IVec2& cell, const SkinCells& cells);

}  // namespace limn
