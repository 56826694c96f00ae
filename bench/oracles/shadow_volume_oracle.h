#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <span>
#include <vector>

namespace limn::oracle {

// Shadow volumes as Crow (1977) defines them, polygon by polygon in double precision: a point is in
// shadow if a walk from the eye to it enters more volumes than it leaves (shadow.volume-count).
// What the stencil passes are held against. Polygons edge-on and walks through an edge count by
// chance: choose points in general position.

using DVec3 = glm::dvec3;
using DTriangle = std::array<DVec3, 3>;  ///< counter-clockwise seen from outside

/// shadow.vol-extrude: `p` moved away from `light` by `distance`.
[[nodiscard]] DVec3 extrude(const DVec3& p, const DVec3& light, double distance);

/// z-pass: 1 for every front face between eye and point, -1 for every back face; without the
/// volumes that contain the eye.
[[nodiscard]] int
count_before(std::span<const DTriangle> volume, const DVec3& eye, const DVec3& point);
/// z-fail: 1 for every back face behind the point, -1 for every front face.
[[nodiscard]] int
count_behind(std::span<const DTriangle> volume, const DVec3& eye, const DVec3& point);

/// How many times the closed surface winds around the point: in how many volumes it lies.
[[nodiscard]] int winding_number(std::span<const DTriangle> volume, const DVec3& point);

/// Whether a triangle of either side lies between the points.
[[nodiscard]] bool
segment_hits(std::span<const DTriangle> mesh, const DVec3& from, const DVec3& to);

/// Positive if the triangles close around a solid and look outward.
[[nodiscard]] double signed_volume(std::span<const DTriangle> volume);

/// Edges, directed, that no equal edge the other way cancels: 0 for a closed surface. Triangles
/// without area count with the others.
[[nodiscard]] int open_directed_edges(std::span<const DTriangle> volume);

/// Triangles whose area is not 0.
[[nodiscard]] int count_spread(std::span<const DTriangle> volume);

}  // namespace limn::oracle
