#pragma once

#include "ecs/base/math.h"
#include "systems/particles/mesh_bvh.h"

#include <optional>
#include <span>
#include <variant>

namespace limn {

// Static surfaces that particles hit, as points or as balls of a given radius. Planes, spheres,
// boxes and height fields are solid and are hit from outside only; meshes are two-sided sheets.
// Everything is evaluated in double precision and rounded once.

/// Solid where dot(unit normal, x) < offset [m].
struct PlaneCollider {
    Vec3 normal = {0, 1, 0};  ///< outward; normalized if need be
    float offset = 0;
};

struct SphereCollider {
    Vec3 center = Vec3(0);
    float radius = 1;       ///< [m], >= 0
    bool inverted = false;  ///< hollow: solid outside
};

struct BoxCollider {
    Affine world_from_box{};  ///< rotation and translation only
    Vec3 half = Vec3(0.5f);   ///< [m], >= 0
};

/// Solid below the bilinear surface over a grid: terrain, or water sampled by the caller. Point
/// (i, j) has index j * width + i and is at origin + (i cell.x, heights[index], j cell.y). There is
/// nothing beyond its edges: a particle that enters below the surface from there is not stopped,
/// but pushed up later. The normal is that of the bilinear surface: differences across the cell.
struct HeightCollider {
    Vec3 origin = Vec3(0);
    Vec2 cell = Vec2(1);               ///< along x and z [m], > 0
    int width = 0;                     ///< points along x, >= 2
    int depth = 0;                     ///< points along z, >= 2
    std::span<const float> heights{};  ///< [m]
};

/// Does not own the hierarchy, which is in world space.
struct MeshCollider {
    const MeshBvh* bvh = nullptr;
};

using Collider =
    std::variant<PlaneCollider, SphereCollider, BoxCollider, HeightCollider, MeshCollider>;

struct Contact {
    float fraction = 0;     ///< of the path, 0 .. 1
    Vec3 point = Vec3(0);   ///< the particle's center then
    Vec3 normal = Vec3(0);  ///< unit, against the motion
};

/// The first contact of a particle of radius `radius` >= 0 [m] that moves from `from` to `to`.
/// Exact for points. With a radius: planes and spheres grow by it, exactly; boxes grow but keep
/// sharp corners; height fields are raised by radius / cos(slope) in each cell; of meshes, the
/// plane of the triangle that the center would hit is moved along its normal (up to 75 degrees from
/// the normal: at more grazing angles, and at edges, the center comes nearer, but never crosses).
/// In a cell of a height field, the contact is the exact root of the quadratic of its bilinear
/// patch along the path. None if the path starts inside a solid, has no length or is not finite.
[[nodiscard]] std::optional<Contact>
first_contact(const Collider& collider, const Vec3& from, const Vec3& to, float radius = 0);

/// The way out of a solid.
struct Escape {
    Vec3 point = Vec3(0);   ///< on the surface grown by the radius
    Vec3 normal = Vec3(0);  ///< unit, outward
    float depth = 0;        ///< [m], > 0; vertical for height fields
};

/// To the nearest position outside; straight up for height fields and from the center of a sphere.
/// None if the particle is outside, or inside by no more than `tolerance` [m]. Meshes have no
/// inside.
[[nodiscard]] std::optional<Escape>
find_escape(const Collider& collider, const Vec3& position, float radius, float tolerance = 0);

/// That position, or `position` if it is outside. Idempotent but for rounding.
[[nodiscard]] Vec3 push_out(const Collider& collider, const Vec3& position, float radius = 0);

}  // namespace limn
