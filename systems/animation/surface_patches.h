#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/components/surface_anchors.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Deformation by a smooth surface through few markers (face.bids-*): J. Edge et al.,
// "Bezier-Triangle Induced Deformation", 2004. The markers are vertices of a triangle mesh; each
// triangle becomes a patch: the cubic of A. Vlachos et al., "Curved PN Triangles", 2001, whose
// edges meet but crease, plus six offsets that bend it into the tangent planes that both sides of
// an edge share, D. J. Walton and D. S. Meek, "A triangular G1 patch from boundary curves", 1996:
//
//     B(u, v) = sum 3!/(i!j!k!) u^i v^j w^k b_ijk + sum 12 c^2 a^2 b / (a + b) x_ca,
//
// for the six pairs (c, a) of the coordinates and b, the third. The surface is smooth (G1) at edges
// whose triangles face along the normals at their ends (patch_normals.h); where two sides of a fold
// touch, none is faced by both, and it may fold back there. Beside it there is a quadratic field of
// unit normals, continuous across edges, which does not fold where markers crowd, as the surface's
// own normals may. A vertex is bound once (patch_binding.h) to a point of the surface at rest and a
// distance along the normal there,
//
//     p = B(u, v) + d n(u, v),
//
// and is reconstructed from the deformed patches; of several such points, the mean by their shares.
// Normals and tangents are transformed by the derivatives of this map.

/// A point of a patch, and derivatives there; w = 1 - u - v.
struct PatchPoint {
    Vec3 position;
    Vec3 by_u, by_v;
    Vec3 normal;  ///< unit
    Vec3 normal_by_u, normal_by_v;
};

/// Faces of a triangle mesh as three markers each.
struct PatchFaces {
    std::vector<std::uint32_t> corners;  ///< the first of the vertices at one position
    std::vector<std::uint32_t> named;    ///< the same with the mesh's own indices
};

/// Vertices at one position, as on both sides of a seam, are merged to the first if their kinds are
/// equal: touching lips have different kinds. `kinds`: one per vertex, or empty: all equal.
/// Triangles that collapse are skipped. Fails with one line at a triangle without area, an edge of
/// more than two triangles, or two triangles at an edge that face opposite sides.
[[nodiscard]] Result<PatchFaces> make_patch_faces(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
    std::span<const std::uint64_t> kinds = {});

/// Packs the patches over the faces `corners`, kPatchTexels each (surface_anchors.h). Normals at
/// markers are those of make_patch_normals().
void make_patches(
    std::span<const Vec3> positions, std::span<const std::uint32_t> corners,
    std::vector<Vec4>& patches);

/// `patch`: the texels of one patch. u belongs to its first corner, v to the second.
[[nodiscard]] PatchPoint evaluate_patch(std::span<const Vec4> patch, float u, float v);

/// Third column of the map from (u, v, distance along the normal); the first two are by u and v.
[[nodiscard]] Mat3 patch_axes(const PatchPoint& at, float distance);

/// Tangent, bitangent and normal, in which the offset of an anchor is.
[[nodiscard]] Mat3 patch_frame(const PatchPoint& at);

/// Where an anchor alone would move its vertex.
[[nodiscard]] Vec3 anchored_point(const SurfaceAnchor& anchor, std::span<const Vec4> patches);

/// Moves bound vertices in place; others do not move. Each has one anchor at its own index, and
/// those that follow it; normals and tangents may both be empty.
void follow_patches(
    std::span<const SurfaceAnchor> anchors, std::span<const Vec4> patches,
    std::span<Vec3> positions, std::span<Vec3> normals, std::span<Vec4> tangents);

}  // namespace limn
