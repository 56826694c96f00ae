#pragma once

#include "ecs/components/surface.h"

#include <vector>

namespace limn {

// Heights of the folds of a wrinkle map at the vertices of a mesh; the map itself has only their
// slopes. Heights h are the least-squares fit of differences along edges to the integrals g of the
// slopes there,
//
//     minimize  sum over edges (h_b - h_a - g_ab)^2 + anchor * sum over vertices h^2
//
// by conjugate gradients. Edges are measured in space, not on the map, so that its scale, mirrored
// parts and seams do not matter. Vertices at one position have one height: no seam opens.
//
// A fold of wavelength w needs edges of w / 4 or less; at w / 2 it fades out completely, because
// the mesh would alias it to other folds.

/// Per vertex the heights of one or, with `layers`, two layers of the map, mapped to the mesh by
/// `slot`, at the slopes of the map [m]. 0 at hard edges, which would open. Empty if the mesh has
/// no tangents or cannot represent any fold.
[[nodiscard]] std::vector<Vec2>
fold_heights(const MeshData& mesh, const ImageData& map, const TextureSlot& slot, bool layers);

}  // namespace limn
