#pragma once

#include "ecs/base/math.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Triangles of a polygon in space, concave or not, that lies roughly in a plane.
//
// Quads are split along the diagonal from their first corner unless it lies outside. Larger
// polygons lose one ear after the other (Meisters 1975): corners in a queue, of which a cut
// re-examines the two neighbors only, each against all reflex corners. That is quadratic: 10,000
// corners take 0.2 s. Orientations are computed in doubles from two unrounded coordinates of the
// corners, so that corners on a straight line are recognized as such and are cut last.

/// Corners above which a polygon is cut as a fan, which is right if it is convex.
inline constexpr std::size_t kMaxEarCorners = 10'000;

/// Corner numbers, 0 .. count - 1, three per triangle, of a polygon with these corners: always
/// count - 2 triangles, also of one that crosses itself or has no area.
[[nodiscard]] std::vector<std::uint32_t> triangulate_polygon(std::span<const Vec3> corners);

}  // namespace limn
