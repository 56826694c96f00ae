#pragma once

#include "ecs/base/bezier.h"
#include "ecs/base/math.h"
#include "ecs/components/surface.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Bicubic Bezier patches: points, derivatives, splitting, triangles.
//
//     Q(u, v) = sum_ij B_i(u) B_j(v) P_ij,   B_i the cubic Bernstein polynomials
//
// Tangent T along u, bitangent B along v, normal N = T x B (one convention for the whole engine;
// the appendix of the book swaps the first two). Meshes made here store the texture coordinates (u,
// 1 - v): viewed from the front the image is upright and unmirrored, so w = +1.
//
// Sums are ordered so that a boundary curve read from its other end gives the same bits: patches
// that share a boundary have no cracks.
// After A. Watt, F. Policarpo, "Advanced Game Development with Programmable Graphics Hardware"
// (2005), appendix 7.1 (with its printed end tangent, expansion and partition of unity corrected).

/// 16 control points: p[i][j], i along u, j along v. The corners lie on the surface.
struct BezierPatch {
    std::array<std::array<Vec3, 4>, 4> p;
};

[[nodiscard]] Vec3 patch_point(const BezierPatch& patch, float u, float v);
[[nodiscard]] Vec3 patch_du(const BezierPatch& patch, float u, float v);
[[nodiscard]] Vec3 patch_dv(const BezierPatch& patch, float u, float v);
[[nodiscard]] Vec3 patch_duv(const BezierPatch& patch, float u, float v);

/// Position and tangent frame at a point of the surface.
struct PatchFrame {
    Vec3 point;
    Vec3 normal;   ///< unit, du x dv
    Vec3 tangent;  ///< unit, along u, perpendicular to `normal`
};

/// Finite everywhere: where an edge has collapsed to a point (the lid of the teapot) the frame is
/// the limit from inside the patch; a patch that is one point has the frame of the x-y plane.
[[nodiscard]] PatchFrame patch_frame(const BezierPatch& patch, float u, float v);

/// De Casteljau at the midpoint of both directions: children at 0 (low u, low v), 1 (high u, low
/// v), 2 (low u, high v), 3 (high u, high v). child(s, t) = parent(s / 2, t / 2) for child 0.
[[nodiscard]] std::array<BezierPatch, 4> split_patch(const BezierPatch& patch);

/// Largest distance of the control points from the bilinear patch through the corners [m], which
/// bounds that of the surface.
[[nodiscard]] float patch_flatness(const BezierPatch& patch);

/// One vertex of a tessellation.
struct PatchSample {
    std::uint32_t patch = 0;
    float u = 0;
    float v = 0;
};

/// Triangles over patches, counter-clockwise when viewed from the side that du x dv points to.
struct PatchTriangles {
    std::vector<PatchSample> samples;
    std::vector<std::uint32_t> indices;  ///< three per triangle, into `samples`
};

/// `divisions` x `divisions` quads per patch, two triangles each. divisions = 2^d: depth d.
[[nodiscard]] PatchTriangles tessellate_uniform(std::size_t patch_count, int divisions);

/// Quads as large as `tolerance` [m] > 0 allows (see patch_flatness), at most 2^max_depth along an
/// edge of a patch. Where neighbors differ, the coarser leaf includes the vertices of the finer
/// one, in the same patch and across patches that share a boundary: there are no T-junctions.
[[nodiscard]] PatchTriangles
tessellate_adaptive(std::span<const BezierPatch> patches, float tolerance, int max_depth = 6);

/// The mesh of a tessellation: positions, normals, tangents, uvs (u, 1 - v), bounds.
[[nodiscard]] MeshData
make_patch_mesh(std::span<const BezierPatch> patches, const PatchTriangles& triangles);

/// Precomputed LODs of one patch: level l is 4^l sub-patches, row by row.
struct PatchLevels {
    std::vector<std::vector<BezierPatch>> level;
};

[[nodiscard]] PatchLevels make_patch_levels(const BezierPatch& patch, int count);

}  // namespace limn
