#pragma once

#include "ecs/base/math.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace limn {

// Bright patterns where a surface gathers light on planes (Shah, Konttinen and Pattanaik 2007 have
// the modern form): every vertex of the surface sends one ray, is moved to where that lands, and
// is drawn there as bright as the light it brings. The functions that water needs are in
// render/shaders/lib/caustic_landing.glsl, too.

/// Of points x with dot(normal, x) = offset.
struct Plane {
    Vec3 normal = {0, 1, 0};  ///< unit
    float offset = 0;         ///< [m]
};

inline constexpr float kFarPlane = 10000.0f;  ///< way of rays that meet no plane [m]

/// Way along `ray` to the plane; kFarPlane where that lies behind or the ray runs along it.
[[nodiscard]] inline float way_to_plane(const Vec3& from, const Vec3& ray, const Plane& plane) {
    const float along = glm::dot(plane.normal, ray);
    if (std::abs(along) <= 1e-9f) {
        return kFarPlane;
    }
    const float way = (plane.offset - glm::dot(plane.normal, from)) / along;
    return way >= 0 ? way : kFarPlane;
}

/// Where `ray` meets the first of the planes; kFarPlane away if none.
[[nodiscard]] inline Vec3
land_on_planes(const Vec3& from, const Vec3& ray, std::span<const Plane> planes) {
    float way = kFarPlane;
    for (const Plane& plane : planes) {
        way = std::min(way, way_to_plane(from, ray, plane));
    }
    return from + way * ray;
}

/// Light of a vertex of a pool's surface by its height: 0 at the least, 1 at the greatest.
///   per_height  1 / (greatest - least); that of still water must be finite: pool_scale()
[[nodiscard]] inline float pool_light(float height, float least, float per_height) {
    const float c = (height - least) * per_height;
    return c * c * c;
}
/// The same as the book's text has it, in meters.
[[nodiscard]] inline float pool_light_squared(float height, float least, float per_height) {
    const float c = height - least;
    return c * c * per_height;
}
[[nodiscard]] inline float pool_scale(float least, float greatest) {
    return 1.0f / std::max(greatest - least, 1e-4f);
}

/// Light per area where a patch of surface lands, over that on the patch.
[[nodiscard]] inline float area_light(float area_before, float area_after) {
    return area_before / std::max(area_after, 1e-12f);
}

/// A vertex that mirrors light onto a plane.
struct MirroredVertex {
    Vec3 position = {0, 0, 0};
    float light = 0;
};
struct MirrorLook {
    float power_plane = 3;     ///< of the cosine at the plane; the book's text: 1
    float power_surface = 3;   ///< of the cosine at the surface; the book's text: 4
    float farthest = 1000;     ///< rays go no farther [m]
    float highest = INFINITY;  ///< above the plane nothing is lit that lands higher [m]
};

/// Where a vertex of a mirror sends the light of a lamp at `light`. One that faces away stays where
/// it is and is black; so is one whose ray leaves the plane.
[[nodiscard]] inline MirroredVertex mirror_vertex(
    const Vec3& vertex, const Vec3& normal, const Vec3& light, const Plane& plane,
    const MirrorLook& look = {}) {
    const Vec3 in = glm::normalize(vertex - light);
    const float facing = -glm::dot(in, normal);
    if (facing < 0) {
        return {vertex, 0};
    }
    const Vec3 out = in + 2.0f * facing * normal;
    const float toward = -glm::dot(plane.normal, out);
    const float height = glm::dot(plane.normal, vertex) - plane.offset;
    const float way = toward > 1e-9f ? height / toward : height > 0 ? 0.0f : look.farthest;
    MirroredVertex moved = {vertex + std::clamp(way, 0.0f, look.farthest) * out, 0};
    const float above = glm::dot(plane.normal, moved.position) - plane.offset;
    if (way > look.farthest || above > look.highest) {
        moved.position -= above * plane.normal;
    }
    if (above <= look.highest) {
        moved.light = std::pow(std::max(toward, 0.0f), look.power_plane)
                      * std::pow(facing, look.power_surface);
    }
    return moved;
}

}  // namespace limn
