#pragma once

#include "ecs/base/math.h"
#include "ecs/entity.h"

#include <optional>

namespace limn {

class World;
struct RenderView;

// Picking: ray tests on the CPU against the meshes' boxes, then their triangles. Fast enough for a
// click (about a millisecond).

/// A ray in world space.
struct Ray {
    Vec3 origin = {0, 0, 0};
    Vec3 direction = {0, 0, -1};  ///< unit
};

/// The camera ray through the point (x, y) of the image, 0 .. 1 from the top left.
[[nodiscard]] Ray ray_through(const RenderView& view, const Vec2& point);

struct Hit {
    Entity entity;
    float distance = 0.0f;  ///< along the ray [m]
};

/// The nearest MeshInstance that the ray hits, on either side of its triangles.
[[nodiscard]] std::optional<Hit> pick_entity(const World& world, const Ray& ray);

/// Box of the entity's mesh, inflated and posed as drawn, in its own space; empty without a mesh.
[[nodiscard]] Bounds local_bounds(const World& world, Entity entity);

/// The same in world space.
[[nodiscard]] Bounds entity_bounds(const World& world, Entity entity);

/// The center of the entity's box, or its origin if it has none.
[[nodiscard]] std::optional<Vec3> entity_center(const World& world, Entity entity);

}  // namespace limn
