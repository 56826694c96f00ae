#pragma once

#include "ecs/base/math.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace limn {

// Caustics on planes by vertex projection (see Shah, Konttinen and Pattanaik 2007 for the modern
// form): every vertex of the surface casts one ray, is moved to the hit point, and is drawn there
// with the light it carries. render/shaders/lib/caustic_landing.glsl has the functions that water
// needs.
// Techniques: caustic.projected-vertices, caustic.reflection-plane, caustic.refraction-pool

/// The points x with dot(normal, x) = offset.
struct Plane {
    Vec3 normal = {0, 1, 0};  ///< unit
    float offset = 0;         ///< [m]
};

inline constexpr float kFarPlane = 10000.0f;  ///< distance for rays that hit no plane [m]

/// Distance along `ray` to the plane; kFarPlane if it lies behind or the ray is parallel to it.
[[nodiscard]] inline float
distance_to_plane(const Vec3& from, const Vec3& ray, const Plane& plane) {
    const float along = glm::dot(plane.normal, ray);
    if (std::abs(along) <= 1e-9f) {
        return kFarPlane;
    }
    const float distance = (plane.offset - glm::dot(plane.normal, from)) / along;
    return distance >= 0 ? distance : kFarPlane;
}

/// Where `ray` hits the nearest of the planes; at distance kFarPlane if none.
[[nodiscard]] inline Vec3
hit_nearest_plane(const Vec3& from, const Vec3& ray, std::span<const Plane> planes) {
    float distance = kFarPlane;
    for (const Plane& plane : planes) {
        distance = std::min(distance, distance_to_plane(from, ray, plane));
    }
    return from + distance * ray;
}

/// Brightness of a vertex of a pool's surface by its height: 0 at `lowest`, 1 at the highest.
///   per_height  1 / (highest - lowest), finite for still water too: pool_scale()
[[nodiscard]] inline float pool_light(float height, float lowest, float per_height) {
    const float c = (height - lowest) * per_height;
    return c * c * c;
}
/// The squared variant in the book's text, with heights in meters.
[[nodiscard]] inline float pool_light_squared(float height, float lowest, float per_height) {
    const float c = height - lowest;
    return c * c * per_height;
}
[[nodiscard]] inline float pool_scale(float lowest, float highest) {
    return 1.0f / std::max(highest - lowest, 1e-4f);
}

/// Ratio of the irradiance where a surface patch lands to that on the patch itself.
[[nodiscard]] inline float irradiance_ratio(float area_before, float area_after) {
    return area_before / std::max(area_after, 1e-12f);
}

/// A vertex that reflects light onto a plane.
struct MirroredVertex {
    Vec3 position = {0, 0, 0};
    float light = 0;
};
struct MirrorFalloff {
    float plane_exponent = 3;     ///< exponent of the cosine at the plane; the book's text: 1
    float surface_exponent = 3;   ///< exponent of the cosine at the surface; the book's text: 4
    float max_distance = 1000;    ///< maximum ray length [m]
    float max_height = INFINITY;  ///< hits higher above the plane are not lit [m]
};

/// Projects a vertex of a mirror to where it reflects the point light at `light`. A vertex that
/// faces away stays where it is and is black; one whose ray points away from the plane is black
/// too.
[[nodiscard]] inline MirroredVertex mirror_vertex(
    const Vec3& vertex, const Vec3& normal, const Vec3& light, const Plane& plane,
    const MirrorFalloff& look = {}) {
    const Vec3 in = glm::normalize(vertex - light);
    const float facing = -glm::dot(in, normal);
    if (facing < 0) {
        return {vertex, 0};
    }
    const Vec3 out = in + 2.0f * facing * normal;
    const float toward = -glm::dot(plane.normal, out);
    const float height = glm::dot(plane.normal, vertex) - plane.offset;
    const float distance = toward > 1e-9f ? height / toward : height > 0 ? 0.0f : look.max_distance;
    MirroredVertex moved = {vertex + std::clamp(distance, 0.0f, look.max_distance) * out, 0};
    const float above = glm::dot(plane.normal, moved.position) - plane.offset;
    if (distance > look.max_distance || above > look.max_height) {
        moved.position -= above * plane.normal;
    }
    if (above <= look.max_height) {
        moved.light = std::pow(std::max(toward, 0.0f), look.plane_exponent)
                      * std::pow(facing, look.surface_exponent);
    }
    return moved;
}

}  // namespace limn
