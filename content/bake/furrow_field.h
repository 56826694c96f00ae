#pragma once

#include "ecs/components/furrows.h"

#include <span>
#include <vector>

namespace limn {

// Vector fields for furrows: two tangent vectors at each vertex of a mesh, from a few that an
// author sets.
//
// Without any, the first points up the surface and the second is perpendicular. Vectors between
// edited vertices are weighted by the inverse of the distance (Shepard 1968; for fields on meshes
// Praun et al. 2000): d(p) = sum w_i d_i / sum w_i, w_i = weight_i / |p - p_i|. The distance is
// straight, so that what is set on a finger reaches the next one.

/// At a vertex with unit normal `n`: (0, 1, 0) without its part along n, and that cross n. Where n
/// is vertical, (0, 0, -1) takes the place of (0, 1, 0).
[[nodiscard]] FurrowVectors initial_furrow_vectors(const Vec3& n);

/// An edited vertex.
struct FurrowEdit {
    std::uint32_t vertex = 0;
    FurrowVectors vectors = {};
    float weight = 1;  ///< 0 .. 10
};

/// The vertex that each arrow sets: the nearest one; of several, the first. A magnitude beyond 2
/// becomes 2, and what is not tangent is taken away, with the magnitude kept.
[[nodiscard]] std::vector<FurrowEdit> place_furrow_arrows(
    std::span<const FurrowArrow> arrows, std::span<const Vec3> positions,
    std::span<const Vec3> normals);

/// The weighted mean of the edits as seen from `point`; exactly the vectors of an edit that lies
/// there. `otherwise` if all weights are 0 or there are none.
[[nodiscard]] FurrowVectors interpolate_furrow_vectors(
    const Vec3& point, std::span<const FurrowEdit> edits, std::span<const Vec3> positions,
    const FurrowVectors& otherwise);

/// Both fields at every vertex, tangent to the surface; `normals` are unit. Edits of vertices that
/// do not exist are a mistake of the caller.
[[nodiscard]] std::vector<FurrowVectors> make_furrow_field(
    std::span<const Vec3> positions, std::span<const Vec3> normals,
    std::span<const FurrowEdit> edits);

}  // namespace limn
