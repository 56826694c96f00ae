#pragma once

#include <glm/vec2.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

/// The Delaunay triangulation of points in a plane (A. Bowyer, D. Watson 1981): three points per
/// triangle, counter-clockwise where y points up; their convex hull is covered once. Of points at
/// one place the first is used. Empty where fewer than three are at different places, or all lie
/// in a line. Time grows as the square of their number.
[[nodiscard]] std::vector<std::uint32_t> triangulate_points(std::span<const glm::dvec2> points);

}  // namespace limn
