#pragma once

#include "ecs/base/math.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace limn {

struct MeshData;

// Meshes as casters of stencil shadow volumes: what a volume is made of, whatever the light.
//
// A volume is drawn from the corners of the mesh's triangles. Every corner carries the plane of its
// triangle, and the vertex shader moves it away from the light or leaves it where it is:
//
//   per edge      a corner goes far if its triangle does not face the light. Triangles that do
//                 are the light cap, the others the dark cap; of the quads that stand folded on
//                 all edges, those between the two open to sides (shadow.vol-per-edge). The mesh
//                 must be closed: every edge between exactly two triangles, run through by them in
//                 opposite directions (shadow.closed-mesh).
//   per triangle  each triangle is the cap of a prism of its own, for any mesh, at four times the
//                 fill (shadow.vol-per-triangle).
//
// Vertices are welded by position first: seams of texture coordinates and normals are no edges of
// the solid. Lights are homogeneous: (position, 1), or (direction toward it, 0).

/// What keeps a mesh from being closed; all zero but `triangles` and `removed` when it is.
struct ManifoldReport {
    int triangles = 0;           ///< that are left
    int removed = 0;             ///< triangles with two equal corners
    int duplicated = 0;          ///< triangles with the corners of an earlier one
    int open_edges = 0;          ///< of one triangle alone
    int crowded_edges = 0;       ///< of three or more
    int inconsistent_edges = 0;  ///< of two that run through it the same way
    bool operator==(const ManifoldReport&) const = default;
};
[[nodiscard]] bool is_closed(const ManifoldReport& report);
/// "3 open edges, 1 edge of more than two triangles"; "closed".
[[nodiscard]] std::string describe(const ManifoldReport& report);

/// An edge between two triangles. Indices into positions and triangles of its mesh.
struct ShadowEdge {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    std::uint32_t along = 0;    ///< the triangle that runs from begin to end
    std::uint32_t against = 0;  ///< the one that runs from end to begin
};

struct ShadowMesh {
    std::vector<Vec3> positions;                          ///< welded [m]
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise from outside
    std::vector<Vec4> planes;       ///< a triangle: outward unit normal, -distance; 0 for a sliver
    std::vector<ShadowEdge> edges;  ///< of a closed mesh, in the order of the triangles; else none
    ManifoldReport report;
};

/// Of the bounding box's diagonal: vertices nearer than this are one.
inline constexpr float kWeldTolerance = 1e-6f;

/// Welds, drops what has collapsed, finds the edges. Triangles with an index out of range or a
/// corner that is not finite are left out.
[[nodiscard]] ShadowMesh make_shadow_mesh(const MeshData& mesh);

/// Whether a triangle is seen from the light; edge-on is not. The shader asks the same.
[[nodiscard]] inline bool faces_light(const Vec4& plane, const Vec4& light) {
    return plane.x * light.x + plane.y * light.y + plane.z * light.z + plane.w * light.w > 0;
}

/// Indices of positions.
struct SilhouetteEdge {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
};
/// The edges between what the light sees of a closed mesh and what it does not, directed so that
/// they run counter-clockwise around the lit part, seen from the light (shadow.silhouette).
[[nodiscard]] std::vector<SilhouetteEdge>
find_silhouette(const ShadowMesh& mesh, const Vec4& light);

/// As the vertex shader reads it.
struct VolumeVertex {
    Vec4 corner;  ///< position; w = 1: of the far cap of a prism, else 0
    Vec4 plane;   ///< of its triangle
};
/// Triangles, counter-clockwise seen from outside of the volume.
struct VolumeGeometry {
    std::vector<VolumeVertex> vertices;
    std::vector<std::uint32_t> indices;
    std::uint32_t cap_indices = 0;  ///< how many of them, from the first, are caps; the rest sides
};

/// Caps and folded quads of a closed mesh: 3 vertices and 12 indices a triangle.
[[nodiscard]] VolumeGeometry make_edge_volume(const ShadowMesh& mesh);
/// A prism a triangle, of any mesh: 6 vertices and 24 indices; those of an open mesh twice, once
/// for each side that may face the light.
[[nodiscard]] VolumeGeometry make_triangle_volume(const ShadowMesh& mesh);

}  // namespace limn
