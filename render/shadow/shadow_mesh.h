#pragma once

#include "ecs/base/math.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace limn {

struct MeshData;

// Meshes as casters of stencil shadow volumes: the geometry of a volume, independent of the light.
//
// A volume is drawn from the corners of the mesh's triangles. Every corner carries the plane of its
// triangle, and the vertex shader extrudes it away from the light or leaves it:
//
//   per edge      a corner is extruded if its triangle faces away from the light. Triangles facing
//                 it are the light cap, the others the dark cap; every edge has a degenerate quad,
//                 and those on the silhouette open into sides (shadow.vol-per-edge). The mesh must
//                 be closed: every edge is shared by exactly two triangles, which traverse it in
//                 opposite directions (shadow.closed-mesh).
//   per triangle  each triangle is the cap of a prism of its own, for any mesh, at four times the
//                 fill cost (shadow.vol-per-triangle).
//
// Vertices are welded by position first: seams of texture coordinates and normals are not edges of
// the solid. Lights are homogeneous: (position, 1), or (direction toward it, 0).

/// Why a mesh is not closed; for a closed one all but `triangles` and `removed` are 0.
struct ManifoldReport {
    int triangles = 0;           ///< remaining
    int removed = 0;             ///< triangles with two equal corners
    int duplicated = 0;          ///< triangles with the corners of an earlier one
    int open_edges = 0;          ///< with only one triangle
    int crowded_edges = 0;       ///< with three or more
    int inconsistent_edges = 0;  ///< traversed in the same direction by both
    bool operator==(const ManifoldReport&) const = default;
};
[[nodiscard]] bool is_closed(const ManifoldReport& report);
/// "3 open edges, 1 edge with more than two triangles", or "closed".
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
    std::vector<Vec4> planes;  ///< per triangle: outward unit normal, -distance; 0 for a sliver
    std::vector<ShadowEdge> edges;  ///< of a closed mesh, in triangle order; else empty
    ManifoldReport report;
};

/// Welding distance, as a fraction of the bounding box's diagonal.
inline constexpr float kWeldTolerance = 1e-6f;

/// Welds, drops degenerate triangles, finds the edges. Triangles with an index out of range or a
/// non-finite corner are left out.
[[nodiscard]] ShadowMesh make_shadow_mesh(const MeshData& mesh);

/// Whether a triangle faces the light; edge-on does not. The shader uses the same test.
[[nodiscard]] inline bool faces_light(const Vec4& plane, const Vec4& light) {
    return plane.x * light.x + plane.y * light.y + plane.z * light.z + plane.w * light.w > 0;
}

/// Indices into positions.
struct SilhouetteEdge {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
};
/// The silhouette of a closed mesh from the light: edges between lit and unlit triangles, directed
/// counter-clockwise around the lit part as seen from the light (shadow.silhouette).
[[nodiscard]] std::vector<SilhouetteEdge>
find_silhouette(const ShadowMesh& mesh, const Vec4& light);

/// Vertex layout of the shader.
struct VolumeVertex {
    Vec4 corner;  ///< position; w = 1: far cap of a prism, else 0
    Vec4 plane;   ///< of its triangle
};
/// Triangles, counter-clockwise from outside the volume.
struct VolumeGeometry {
    std::vector<VolumeVertex> vertices;
    std::vector<std::uint32_t> indices;
    std::uint32_t cap_indices = 0;  ///< number of leading indices that are caps; the rest are sides
};

/// Caps and edge quads of a closed mesh: 3 vertices and 12 indices per triangle.
[[nodiscard]] VolumeGeometry make_edge_volume(const ShadowMesh& mesh);
/// One prism per triangle, of any mesh: 6 vertices and 24 indices each; twice for an open mesh,
/// once for each side that may face the light.
[[nodiscard]] VolumeGeometry make_triangle_volume(const ShadowMesh& mesh);

}  // namespace limn
