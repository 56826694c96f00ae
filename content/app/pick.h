#pragma once

#include "ecs/base/math.h"
#include "ecs/entity.h"

#include <optional>

namespace limn {

class World;
struct RenderView;

// What lies under the pointer, and where it is on the screen. On the CPU, against the meshes' boxes
// and then their triangles: a click may take a millisecond.

/// A half line in world space.
struct Ray {
    Vec3 origin = {0, 0, 0};
    Vec3 direction = {0, 0, -1};  ///< unit
};

/// Through the point (x, y) of the picture, 0 .. 1 from the top left.
[[nodiscard]] Ray ray_through(const RenderView& view, const Vec2& point);

struct Hit {
    Entity entity;
    float distance = 0.0f;  ///< along the ray [m]
};

/// The nearest MeshInstance that the ray meets, front or back.
[[nodiscard]] std::optional<Hit> pick_entity(const World& world, const Ray& ray);

/// Box of what the entity draws, inflated and posed as it is, in its own space; empty if it draws
/// nothing.
[[nodiscard]] Bounds local_bounds(const World& world, Entity entity);

/// The same in world space.
[[nodiscard]] Bounds entity_bounds(const World& world, Entity entity);

/// Where the entity is: the middle of its box, or its origin.
[[nodiscard]] std::optional<Vec3> entity_middle(const World& world, Entity entity);

}  // namespace limn
