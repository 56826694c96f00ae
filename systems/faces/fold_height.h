#pragma once

#include "ecs/components/surface.h"

#include <vector>

namespace limn {

// How high the folds of a wrinkle map are at the vertices of a mesh, of which the map says only how
// steep they are. Heights h are those whose differences along edges come closest to the integrals
// of the slopes there,
//
//     minimize  sum over edges (h_b - h_a - g_ab)^2 + anchor * sum over vertices h^2
//
// by conjugate gradients. Edges are those of space, not of the map, so that its scale, mirrored
// parts and seams do not matter. Vertices at one position have one height: no seam opens.
//
// A fold of wavelength w needs edges of w / 4 or less; at w / 2 nothing is left of it, because
// the mesh would show other folds than the map.

/// Per vertex the heights of the one or, with `layers`, two layers of the map that `slot` places on
/// the mesh, where slopes are those of the map [m]. 0 at hard edges, which would open. Empty if the
/// mesh has no tangents, or can show no folds.
[[nodiscard]] std::vector<Vec2>
fold_heights(const MeshData& mesh, const ImageData& map, const TextureSlot& slot, bool layers);

}  // namespace limn
