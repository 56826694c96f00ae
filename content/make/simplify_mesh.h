#pragma once

#include "ecs/components/surface.h"

#include <cstddef>

namespace limn {

/// Collapses edges until about `triangles` are left, or until the error would exceed 5 % of the
/// size of the mesh. Unused vertices are removed, with their skin weights and morph targets; the
/// others keep their positions, and closed surfaces stay closed.
void simplify_mesh(MeshData& mesh, std::size_t triangles);

}  // namespace limn
