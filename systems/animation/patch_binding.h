#pragma once

#include "ecs/base/math.h"
#include "ecs/components/surface_anchors.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Which points of a surface of patches (surface_patches.h) move each vertex of a mesh
// (face.bids-project). One that lies on a patch follows it alone. Farther from the surface the
// nearest point jumps from patch to patch between neighboring vertices, and a net of few markers
// would tear or crumple a face; a vertex therefore follows all patches that are little farther than
// the nearest one, with weights that are continuous along the mesh. A patch is far if the way to it
// along the mesh is: the upper lip does not follow markers of the lower one (marker_paths.h), and
// where a triangle of the net spans an opening of the mesh, such as the mouth, nothing follows it.
// Normals leave out the gradients of the weights. Beside the border of a net, where the nearest
// patch changes, the fade to rest may still jump.

/// A chart that separates points and faces which touch, or nearly touch, in space.
struct PatchChart {
    std::span<const Vec2> points;   ///< one per point
    std::span<const Vec2> corners;  ///< one per corner of the faces
};

/// The mesh to bind. Without triangles, ways are straight.
struct PointsToBind {
    std::span<const Vec3> positions;
    std::span<const Vec3> normals;
    std::span<const Vec4> tangents;
    std::span<const std::uint32_t> triangles = {};
};

/// Positions of the points on the surface: one anchor per point, then the further ones of those
/// that have several. With a chart, a point is carried by the nearest patch there that is below it,
/// or else by the nearest one; points beyond all faces of the chart, such as a torso below the
/// surface of a head, are bound only within a quarter of a patch. Without a chart, patches that
/// face away from its normal count as farther; and a point follows less the farther it is: all the
/// motion within half of `max_distance` [m] of the surface, fading out up to it, and from the
/// border on. A point that is farther is not bound: patch = kNoPatch. Takes O(points * patches)
/// time.
[[nodiscard]] std::vector<SurfaceAnchor> bind_to_patches(
    const PointsToBind& points, std::span<const Vec3> positions,
    std::span<const std::uint32_t> corners, float max_distance, const PatchChart& chart = {});

}  // namespace limn
