#pragma once

#include "ecs/base/math.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace limn {

// Positions of vertices on the patches of a surface that moves them (surface_binding.h, method
// patches), and the patches. Shared by the CPU and the GPU.

inline constexpr std::uint32_t kNoPatch = 0xffffffffu;

/// Position of a vertex: on `patch` at (u, v), plus `offset` along the axes of the patch: tangent,
/// bitangent and normal. The normal alone suffices, except for vertices above an edge that do not
/// project perpendicularly onto a patch. A vertex that is not close to a single patch has several,
/// each with a share of its motion: the first at its own index, the others after those of all
/// vertices.
struct SurfaceAnchor {
    std::uint32_t patch = kNoPatch;
    float u = 0.0f;          ///< weight of the patch's first corner
    float v = 0.0f;          ///< weight of its second
    Vec3 offset = Vec3(0);   ///< [m]
    Vec3 normal = Vec3(0);   ///< of the mesh, as a covector of (u, v, distance)
    Vec3 tangent = Vec3(0);  ///< of the mesh, as a vector of (u, v, distance)
    float share = 1.0f;      ///< of the vertex's motion; the rest of it stays
    std::uint32_t vertex = 0;
    std::uint32_t next = 0;  ///< the vertex's next anchor; 0: none
};

// A patch is 22 texels, xyz each: control points b300 b030 b003 b210 b120 b021 b012 b102 b201 b111,
// where the exponents belong to u, v and w; offsets that bend it, two per edge: by the first and by
// the second end of the edges from u to v, from v to w and from w to u; then normals n200 n020 n002
// n110 n011 n101.
inline constexpr std::size_t kPatchPoints = 10;
inline constexpr std::size_t kPatchNormals = 16;
inline constexpr std::size_t kPatchTexels = 22;

/// The patches that move an instance of a bound mesh; without `anchors` it is not moved.
struct SurfaceShape {
    std::span<const SurfaceAnchor> anchors;  ///< one per vertex, then further ones
    std::span<const Vec4> patches;
    std::span<const std::uint32_t> order;  ///< anchors that have one, patch by patch
};

/// Bound on the motion [m] of a bound vertex between two shapes of a surface: that of a control
/// point of its patch, plus the rotation of its offset. `largest_offset`: of all vertices.
[[nodiscard]] float
max_motion(std::span<const Vec4> rest, std::span<const Vec4> patches, float largest_offset);

}  // namespace limn
