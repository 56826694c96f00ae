#pragma once

#include "ecs/base/math.h"

namespace limn {

/// The point of a triangle, which may be a line or a point, that is nearest to `p`.
[[nodiscard]] Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// Distance [m] of `p` from a triangle, which may be a line or a point.
/// After Ericson, "Real-Time Collision Detection", 2005, section 5.1.5.
[[nodiscard]] float
distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace limn
