#pragma once

#include "ecs/base/math.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Strain of skin in its tangent plane: how much, and in which direction, a deformed triangle mesh
// is compressed or stretched (face.strain).
//
//     F = Ds Dm^-1,    S = sqrt(F^T F),    strain = S - I
//
// Dm and Ds have two edges of a triangle as columns, at rest and deformed. F^T F needs only the dot
// products of the deformed edges, so rigid motion cancels without a polar decomposition. The
// square root of a symmetric 2x2 matrix has a closed form.
//
// The axes of a triangle are u = normalize(up x n) and v = n x u, with up = +y and the normal n at
// rest; on a face that looks along +z, u points to its left and v upwards.

/// Symmetric 2x2 tensor in the axes u, v: 0 at rest, -0.1 on the diagonal: 10 % shorter.
struct SkinStrain {
    float uu = 0.0f;
    float vv = 0.0f;
    float uv = 0.0f;
};

/// Eigenvalues of a SkinStrain, and the direction of the lower one.
struct PrincipalStrain {
    float lower = 0.0f;   ///< > -1; negative: compression
    float higher = 0.0f;  ///< >= lower
    float angle = 0.0f;   ///< of `lower`, from u towards v [rad], -pi/2 .. pi/2
};

/// A mesh at rest, prepared for find_strain. Arrays with one element per triangle.
struct SkinTriangles {
    std::vector<std::uint32_t> corners;  ///< three vertices per triangle
    std::vector<std::uint32_t> source;   ///< index of the triangle in the mesh
    std::vector<Vec4> rest_inverse;      ///< Dm^-1 in u, v [1/m], rows (x, y) and (z, w)
    std::vector<float> area;             ///< at rest [m^2]
    std::vector<Vec3> u;                 ///< unit
    std::vector<Vec3> v;                 ///< unit
    std::vector<std::uint32_t> welded;   ///< per vertex: the first one at the same position
    std::vector<Vec3> vertex_u;          ///< per vertex, the same at all with one position
    std::vector<Vec3> vertex_v;          ///< the same
};

/// Skips triangles that have an edge shorter than `min_edge` [m], no area, a coordinate that is not
/// finite or an index out of range.
[[nodiscard]] SkinTriangles make_skin_triangles(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
    float min_edge = 2e-4f);

/// One strain per triangle of `skin`; 0 where a deformed position is not finite. `deformed` has as
/// many positions as the mesh at rest.
void find_strain(
    const SkinTriangles& skin, std::span<const Vec3> deformed, std::span<SkinStrain> strain);

/// Averages of `strain` over the triangles at each vertex, weighted by area, in the axes of the
/// vertex. Vertices at one position get the same value, so that UV seams do not show. 0 at a vertex
/// without triangles.
void average_strain(
    const SkinTriangles& skin, std::span<const SkinStrain> strain, std::span<SkinStrain> vertices);

[[nodiscard]] PrincipalStrain principal_strain(const SkinStrain& strain);

}  // namespace limn
