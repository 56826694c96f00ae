#pragma once

#include "ecs/components/surface.h"

#include <cstdint>
#include <vector>

namespace limn {

// What curved relief needs of a mesh, per vertex (relief.vertex-format): how far a tile of texture
// reaches, and the quadric that the mesh follows, A x^2 + B y^2 + z = 0 with x along the tangent, y
// along the bitangent and z along the normal. A, B > 0: convex; a sphere of radius R has 1 / (2 R).

/// |dP/du| and |dP/dv| [m]: the length of a tile along u and v, the mean of the triangles at each
/// vertex. 0 where all of them have no area in texture space (relief.mapping-scale).
[[nodiscard]] std::vector<Vec2> mapping_scales(const MeshData& mesh);

/// A and B [1/m] of each vertex, the least squares fit to the vertices around it, across the seams
/// of the mesh (relief.curvature-fit). 0 with fewer than three of them or without tangents.
[[nodiscard]] std::vector<Vec2> fit_curvatures(const MeshData& mesh);

/// The same for one vertex and its neighbors in its tangent frame (x, y, z).
[[nodiscard]] Vec2 fit_quadric(const std::vector<Vec3>& neighbors);

/// The form of a quadric (relief.quadric-class).
enum class QuadricClass : std::uint8_t { Plane, Cylinder, Paraboloid, Saddle };
/// `zero`: curvature that counts as none [1/m].
[[nodiscard]] QuadricClass quadric_class(const Vec2& curvature, float zero = 1e-4f);

}  // namespace limn
