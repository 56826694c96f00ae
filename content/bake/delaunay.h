#pragma once

#include <glm/vec2.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

/// The Delaunay triangulation of points in a plane (A. Bowyer, D. Watson 1981): three points per
/// triangle, counter-clockwise where y points up; their convex hull is covered once. Of coincident
/// points the first is used. Empty if fewer than three are distinct, or all lie on a line. Takes
/// O(n^2) time.
[[nodiscard]] std::vector<std::uint32_t> triangulate_points(std::span<const glm::dvec2> points);

}  // namespace limn
