#pragma once

#include "ecs/base/math.h"

namespace limn {

struct MeshData;

// Generates normals and tangents for meshes without them.
//
// A triangle has an exact frame: T and B are the gradients of position along u and v
// (bump.tangent-triangle). A vertex has the sum of the frames around it, weighted by the angle of
// the triangle's corner there, so that the result does not depend on how a face was triangulated
// (Thuermer and Wuethrich 1998), then orthogonalized against the normal
// (bump.tangent-vertex). Like MikkTSpace, vertices that agree in position, normal and uv share
// their sum, each triangle counts as a direction, not as a length, and mirrored uvs are never
// averaged with unmirrored ones: such a vertex is split. Unlike MikkTSpace the corner angle is not
// projected; maps baked against MikkTSpace differ by under a degree on smooth meshes.
//
// Images have v growing downwards while normal maps have green up, so that the bitangent of a
// vertex, w cross(N, T), points along -v.

/// The gradients of position along u and v; both zero where the uvs span no area.
struct TriangleFrame {
    Vec3 tangent = Vec3(0);    ///< dP/du [m]
    Vec3 bitangent = Vec3(0);  ///< dP/dv [m]
    float determinant = 0;     ///< du1 dv2 - du2 dv1; < 0: the uvs are mirrored; 0: degenerate
};

/// The frame of the triangle `p` with texture coordinates `uv`.
[[nodiscard]] TriangleFrame triangle_frame(const Vec3 (&p)[3], const Vec2 (&uv)[3]);

/// Replaces the normals of `mesh`. Faces that meet in a point (equal positions, whatever their
/// index) are smoothed together where they differ by at most `crease_angle` [rad]: 0 gives flat
/// faces, pi one normal for each point. Vertices are split at creases and keep their skin weights,
/// morph targets and regions. Degenerate triangles do not count; vertices of no triangle get +y.
void generate_normals(MeshData& mesh, float crease_angle = kPi);

/// Replaces the tangents of `mesh` by those of `uvs` (or `uvs1` for set 1), which must exist, as
/// must normals. Splits vertices where mirrored and unmirrored triangles meet. A vertex without any
/// triangle with an area in uv gets an arbitrary tangent perpendicular to its normal, w = 1.
void generate_tangents(MeshData& mesh, int uv_set = 0);

/// Generates normals for morph targets without them: the difference between the smooth normals of
/// the mesh with the target at weight 1 and without it. Vertices that share position and normal
/// stay smooth. Vertices whose normal alone changes are added to the target.
void generate_morph_normals(MeshData& mesh);

/// Generates tangents for morph targets with normals but no tangents, perpendicular to the normals
/// at weight 1.
void generate_morph_tangents(MeshData& mesh);

/// Sets `bounds` to the bounding box of the positions.
void update_bounds(MeshData& mesh);

}  // namespace limn
