#pragma once

#include "ecs/base/math.h"

#include <array>
#include <optional>

namespace limn {

// Contacts of capsules and triangles: nearest points as in C. Ericson, "Real-Time Collision
// Detection" (2005), chapter 5.

/// All points within `radius` of the segment from `low` to `high`; a ball if they coincide.
struct Capsule {
    Vec3 low = Vec3(0);
    Vec3 high = Vec3(0);
    float radius = 0;
};

using TriangleCorners = std::array<Vec3, 3>;

/// The nearest points of two figures, and their distance.
struct NearestPoints {
    Vec3 a = Vec3(0);
    Vec3 b = Vec3(0);
    float distance = 0;
};

[[nodiscard]] Vec3 nearest_on_triangle(const TriangleCorners& triangle, const Vec3& point);

/// Of the segments a0 a1 and b0 b1, of any length; of parallel ones any pair.
[[nodiscard]] NearestPoints
nearest_of_segments(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1);

/// How a capsule leaves a triangle.
struct CapsuleContact {
    Vec3 normal = Vec3(0, 1, 0);  ///< unit, towards the capsule
    float depth = 0;              ///< how far it must move along the normal, > 0 [m]
    Vec3 point = Vec3(0);         ///< of the triangle
};

/// None where they do not overlap. A capsule whose axis passes through the triangle leaves it on
/// the side on which more of the axis is. None for triangles without area that it does not touch,
/// and for what is not finite.
[[nodiscard]] std::optional<CapsuleContact>
touch_triangle(const Capsule& capsule, const TriangleCorners& triangle);

}  // namespace limn
