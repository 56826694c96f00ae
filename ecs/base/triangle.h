#pragma once

#include "ecs/base/math.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace limn {

/// The point of a segment, which may be a point, that is nearest to `p`.
[[nodiscard]] inline Vec3 nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 ab = b - a;
    const float length2 = glm::dot(ab, ab);
    const float share = length2 > 0 ? std::clamp(glm::dot(p - a, ab) / length2, 0.0f, 1.0f) : 0.0f;
    return a + share * ab;
}

/// The point of a triangle, which may be a line or a point, that is nearest to `p`.
/// After Ericson, "Real-Time Collision Detection", 2005, section 5.1.5.
[[nodiscard]] inline Vec3
nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 normal = glm::cross(b - a, c - a);
    const float length = glm::length(normal);
    const bool above = length > 0 && glm::dot(glm::cross(b - a, p - a), normal) >= 0
                       && glm::dot(glm::cross(c - b, p - b), normal) >= 0
                       && glm::dot(glm::cross(a - c, p - c), normal) >= 0;
    if (above) {
        const Vec3 up = normal / length;
        return p - glm::dot(p - a, up) * up;
    }
    Vec3 nearest = nearest_on_segment(p, a, b);
    for (const Vec3& other : {nearest_on_segment(p, b, c), nearest_on_segment(p, c, a)}) {
        nearest = glm::distance(p, other) < glm::distance(p, nearest) ? other : nearest;
    }
    return nearest;
}

/// Distance [m] of `p` from such a triangle.
[[nodiscard]] inline float
distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    return glm::distance(p, nearest_on_triangle(p, a, b, c));
}

}  // namespace limn
