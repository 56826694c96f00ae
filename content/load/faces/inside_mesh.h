#pragma once

#include "ecs/base/math.h"

namespace limn {

struct MeshData;

/// How often the surface of `mesh` encloses `point`, both in its space: 1 inside a closed mesh that
/// faces outwards, -1 inside one that faces inwards (a sky dome), 0 outside, a fraction if the mesh
/// is open. Takes time linear in its triangles.
/// A. Jacobson et al., "Robust Inside-Outside Segmentation using Generalized Winding Numbers",
/// SIGGRAPH 2013; the angle of a triangle after A. van Oosterom and J. Strackee, 1983.
[[nodiscard]] double winding_number(const MeshData& mesh, const Vec3& point);

}  // namespace limn
