#pragma once

#include "ecs/components/surface.h"

#include <cstddef>

namespace limn {

/// Collapses edges until about `triangles` are left, or until the shape would suffer by more than a
/// twentieth of its size; vertices that are not used any more leave, with their joints and morph
/// targets. What is left stays where it was, and closed where it was closed.
void simplify_mesh(MeshData& mesh, std::size_t triangles);

}  // namespace limn
