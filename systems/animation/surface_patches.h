#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/components/surface_places.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Deformation by a smooth surface through few markers (face.bids-*): J. Edge et al.,
// "Bezier-Triangle Induced Deformation", 2004. The markers are vertices of a triangle mesh; each
// triangle becomes a cubic Bezier patch with a quadratic field of normals, the PN triangles of A.
// Vlachos et al., "Curved PN Triangles", 2001: positions are continuous across edges, and so are
// these normals, though they are not quite perpendicular to the surface. A vertex is bound once to
// a place on the surface at rest and a distance along the normal there,
//
//     p = B(u, v) + d n(u, v),
//
// and is rebuilt from the patches as they are now. Normals and tangents go with the derivatives of
// this map.

/// A point of a patch, and derivatives there; w = 1 - u - v.
struct PatchPoint {
    Vec3 position;
    Vec3 by_u, by_v;
    Vec3 normal;  ///< unit
    Vec3 normal_by_u, normal_by_v;
};

/// Faces of a triangle mesh as three markers each.
struct PatchFaces {
    std::vector<std::uint32_t> corners;  ///< of vertices at one place the first
    std::vector<std::uint32_t> named;    ///< the same as the mesh names them
};

/// Of vertices at one place, as on both sides of a seam, the first stands for all, if their kinds
/// are the same: lips that touch are of different ones. `kinds`: one per vertex, or empty: all
/// alike. Triangles between such vertices are left out. Fails with one line at a triangle without
/// area, an edge of more than two triangles, or two triangles at an edge that face opposite sides.
[[nodiscard]] Result<PatchFaces> make_patch_faces(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
    std::span<const std::uint64_t> kinds = {});

/// Packs the patches over the faces `corners`, kPatchTexels each (surface_places.h). Normals at
/// markers are those of the triangles around, weighted by area.
void make_patches(
    std::span<const Vec3> positions, std::span<const std::uint32_t> corners,
    std::vector<Vec4>& patches);

/// `patch`: the texels of one patch. u belongs to its first corner, v to the second.
[[nodiscard]] PatchPoint evaluate_patch(std::span<const Vec4> patch, float u, float v);

/// A plane on which points and faces lie side by side that touch, or nearly, in space.
struct PatchChart {
    std::span<const Vec2> points;   ///< one per point
    std::span<const Vec2> corners;  ///< one per corner of the faces
};

/// Where the points are on the surface. A point above which no patch lies within `reach` [m] is not
/// bound: patch = kNoPatch. With a chart the nearest patch there that is below it carries it, or
/// the nearest of all; what lies beyond all faces of the chart, as a torso below the surface of a
/// head, is bound only within a quarter of a patch. Without a chart, those carry it that are
/// nearest in space and do not face away from its normal. Time grows as points * patches.
[[nodiscard]] std::vector<SurfacePlace> bind_to_patches(
    std::span<const Vec3> points, std::span<const Vec3> normals, std::span<const Vec4> tangents,
    std::span<const Vec3> positions, std::span<const std::uint32_t> corners, float reach,
    const PatchChart& chart = {});

/// The vertices of bound places, in place; what is not bound stays. All three spans have the length
/// of `places`; normals and tangents may be empty, both.
void follow_patches(
    std::span<const SurfacePlace> places, std::span<const Vec4> patches, std::span<Vec3> positions,
    std::span<Vec3> normals, std::span<Vec4> tangents);

}  // namespace limn
