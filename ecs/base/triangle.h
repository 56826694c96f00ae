#pragma once

#include "ecs/base/math.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace limn {

/// The point of a segment, which may be a point, that is nearest to `p`.
[[nodiscard]] inline Vec3 nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 ab = b - a;
    const float length2 = glm::dot(ab, ab);
    const float t = length2 > 0 ? std::clamp(glm::dot(p - a, ab) / length2, 0.0f, 1.0f) : 0.0f;
    return a + t * ab;
}

/// The point of a triangle, which may be a line or a point, that is nearest to `p`.
/// After Ericson, "Real-Time Collision Detection", 2005, section 5.1.5.
[[nodiscard]] inline Vec3
nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 normal = glm::cross(b - a, c - a);
    const float length2 = glm::dot(normal, normal);
    const bool above = length2 > 0 && glm::dot(glm::cross(b - a, p - a), normal) >= 0
                       && glm::dot(glm::cross(c - b, p - b), normal) >= 0
                       && glm::dot(glm::cross(a - c, p - c), normal) >= 0;
    if (above) {
        return p - glm::dot(p - a, normal) / length2 * normal;
    }
    const auto distance2 = [&](const Vec3& q) { return glm::dot(q - p, q - p); };
    Vec3 nearest = nearest_on_segment(p, a, b);
    float smallest = distance2(nearest);
    for (const Vec3& other : {nearest_on_segment(p, b, c), nearest_on_segment(p, c, a)}) {
        const float away = distance2(other);
        nearest = away < smallest ? other : nearest;
        smallest = std::min(smallest, away);
    }
    return nearest;
}

/// Distance [m] of `p` from such a triangle.
[[nodiscard]] inline float
distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    return glm::distance(p, nearest_on_triangle(p, a, b, c));
}

/// Where a ray meets a triangle a b c.
struct TriangleHit {
    float distance = 0;  ///< along the ray, in units of its direction
    float b = 0;         ///< barycentric weight of the corner b, 0 .. 1
    float c = 0;
};

/// Nothing where it passes by, or lies in the plane; of either side.
/// T. Moeller and B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997.
[[nodiscard]] inline std::optional<TriangleHit> hit_triangle(
    const Vec3& origin, const Vec3& direction, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 edge1 = b - a;
    const Vec3 edge2 = c - a;
    const Vec3 p = glm::cross(direction, edge2);
    const float determinant = glm::dot(edge1, p);
    if (std::abs(determinant) < 1e-20f) {
        return std::nullopt;
    }
    const Vec3 from_a = origin - a;
    const float u = glm::dot(from_a, p) / determinant;
    const Vec3 q = glm::cross(from_a, edge1);
    const float v = glm::dot(direction, q) / determinant;
    const float distance = glm::dot(edge2, q) / determinant;
    return u >= 0.0f && v >= 0.0f && u + v <= 1.0f && distance >= 0.0f
               ? std::optional(TriangleHit{distance, u, v})
               : std::nullopt;
}

}  // namespace limn
