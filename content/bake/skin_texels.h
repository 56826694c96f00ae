#pragma once

#include "ecs/base/math.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

struct MeshData;

// Deformed skin in texture space: the triangle at each texel, and the strain of the skin in the
// tangent frame there (face.strain), for maps that are baked from poses.

/// Position of a texel on a mesh.
struct SkinTexel {
    std::int32_t triangle = -1;  ///< -1: none
    Vec3 weights = {0, 0, 0};    ///< barycentric coordinates, sum 1
};

/// For each texel of a square image, row by row from the top, the first triangle that covers its
/// center in the `uvs` of `mesh`; up to `gutter` texels beyond the mesh, that of a neighbor, so
/// that filtering stays within skin.
[[nodiscard]] std::vector<SkinTexel> find_skin_texels(const MeshData& mesh, int size, int gutter);

/// Per vertex the strain sqrt(C) - I as (tt, bb, tb), t along the tangent and b the bitangent: C is
/// the mean of F^T F over the triangles at its position, weighted by their angles there and rotated
/// into the tangent plane, so that UV seams do not show. 0 without a triangle, or where a position
/// is not finite. `mesh` has normals and tangents; `deformed`: one position per vertex.
[[nodiscard]] std::vector<Vec3>
find_tangent_strain(const MeshData& mesh, std::span<const Vec3> deformed);

/// A vertex attribute interpolated at a texel; 0 without a triangle.
template <typename T>
[[nodiscard]] T at_texel(
    std::span<const std::uint32_t> indices, const SkinTexel& texel, std::span<const T> values) {
    T sum = T(0);
    for (int k = 0; texel.triangle >= 0 && k < 3; ++k) {
        sum += texel.weights[k] * values[indices[static_cast<std::size_t>(3 * texel.triangle + k)]];
    }
    return sum;
}

}  // namespace limn
