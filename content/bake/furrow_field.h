#pragma once

#include "ecs/components/furrows.h"

#include <span>
#include <vector>

namespace limn {

// Vector fields for furrows: two tangent vectors at each vertex of a mesh, interpolated from a few
// that an author sets.
//
// Without any, the first points up the surface and the second is perpendicular to it. Between
// edited vertices, vectors are weighted by inverse distance (Shepard 1968; for fields on meshes
// Praun et al. 2000): d(p) = sum w_i d_i / sum w_i, w_i = weight_i / |p - p_i|. The distance is
// Euclidean, so that an edit on one finger affects the next.

/// At a vertex with unit normal `n`: (0, 1, 0) without its part along n, and that cross n. If n is
/// vertical, (0, 0, -1) replaces (0, 1, 0).
[[nodiscard]] FurrowVectors initial_furrow_vectors(const Vec3& n);

/// An edited vertex.
struct FurrowEdit {
    std::uint32_t vertex = 0;
    FurrowVectors vectors = {};
    float weight = 1;  ///< 0 .. 10
};

/// The vertex that each arrow sets: the nearest one; of several, the first. Magnitudes are clamped
/// to 2, and vectors are rotated into the tangent plane.
[[nodiscard]] std::vector<FurrowEdit> place_furrow_arrows(
    std::span<const FurrowArrow> arrows, std::span<const Vec3> positions,
    std::span<const Vec3> normals);

/// The weighted mean of the edits at `point`; exactly the vectors of an edit that lies there.
/// `otherwise` if all weights are 0 or there are no edits.
[[nodiscard]] FurrowVectors interpolate_furrow_vectors(
    const Vec3& point, std::span<const FurrowEdit> edits, std::span<const Vec3> positions,
    const FurrowVectors& otherwise);

/// Both fields at every vertex, tangent to the surface; `normals` are unit. All edited vertices
/// must exist.
[[nodiscard]] std::vector<FurrowVectors> make_furrow_field(
    std::span<const Vec3> positions, std::span<const Vec3> normals,
    std::span<const FurrowEdit> edits);

}  // namespace limn
