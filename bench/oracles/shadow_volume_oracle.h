#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <span>
#include <vector>

namespace limn::oracle {

// Shadow volumes as Crow (1977) defines them, polygon by polygon in double precision: a point is in
// shadow if a ray from the eye to it enters more volumes than it leaves (shadow.volume-count). The
// reference for the stencil passes. Polygons viewed edge-on and rays through an edge count
// arbitrarily: choose points in general position.

using DVec3 = glm::dvec3;
using DTriangle = std::array<DVec3, 3>;  ///< counter-clockwise from outside

/// shadow.vol-extrude: `p` moved away from `light` by `distance`.
[[nodiscard]] DVec3 extrude(const DVec3& p, const DVec3& light, double distance);

/// z-pass: 1 for every front face between eye and point, -1 for every back face; without the
/// volumes that contain the eye.
[[nodiscard]] int
z_pass_count(std::span<const DTriangle> volume, const DVec3& eye, const DVec3& point);
/// z-fail: 1 for every back face behind the point, -1 for every front face.
[[nodiscard]] int
z_fail_count(std::span<const DTriangle> volume, const DVec3& eye, const DVec3& point);

/// Winding number of the closed surface about the point: the number of volumes that contain it.
[[nodiscard]] int winding_number(std::span<const DTriangle> volume, const DVec3& point);

/// Whether a triangle, of either orientation, lies between the points.
[[nodiscard]] bool
segment_hits(std::span<const DTriangle> mesh, const DVec3& from, const DVec3& to);

/// Positive if the triangles enclose a solid and face outward.
[[nodiscard]] double signed_volume(std::span<const DTriangle> volume);

/// Number of directed edges without a matching edge of opposite direction: 0 for a closed surface.
/// Includes degenerate triangles.
[[nodiscard]] int open_directed_edges(std::span<const DTriangle> volume);

/// Number of triangles with nonzero area.
[[nodiscard]] int count_nondegenerate(std::span<const DTriangle> volume);

}  // namespace limn::oracle
