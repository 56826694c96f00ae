#pragma once

#include "ecs/base/math.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

struct MeshData;

// Deformed skin in the space of its textures: which triangle a texel lies on, and the strain of the
// skin in the tangent frame there (face.strain), for maps that are made from poses.

/// Where a texel lies on a mesh.
struct SkinTexel {
    std::int32_t triangle = -1;  ///< -1: on none
    Vec3 weights = {0, 0, 0};    ///< of its corners; sum 1
};

/// For each texel of a square image, row by row from the top, the first triangle that covers its
/// center by the first uvs of `mesh`; beyond the mesh, up to `gutter` texels, that of a neighbor,
/// so that filtering finds skin.
[[nodiscard]] std::vector<SkinTexel> find_skin_texels(const MeshData& mesh, int size, int gutter);

/// Per vertex the strain sqrt(C) - I as (tt, bb, tb), t along the tangent and b the bitangent: C is
/// the mean of F^T F over the triangles at its position, weighted by their angles there and turned
/// into the tangent plane, so that UV seams do not show. 0 without a triangle, or where a position
/// is not finite. `mesh` has normals and tangents; `deformed`: one position per vertex.
[[nodiscard]] std::vector<Vec3>
find_tangent_strain(const MeshData& mesh, std::span<const Vec3> deformed);

/// A value per vertex at a texel; 0 on no triangle.
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
