#pragma once

#include "ecs/components/attach.h"
#include "ecs/components/transform.h"
#include "ecs/entity.h"

#include <string_view>

namespace limn {

class World;

// Objects attached to each other at named points (engine.attach). With M2 the frame of the point
// of the parent and M4 that of the child, each in its own space, the child's transform is
//
//     T = M2 M4^-1,   so that   parent T M4 = parent M2
//
// The child keeps its scale.

/// T for a child of this scale; `facing`: turned half about the y axis of the point.
[[nodiscard]] Transform attached_transform(
    const AttachPoint& parent, const AttachPoint& child, const Vec3& child_scale, bool facing);

/// Makes `child` a child of `parent` with this transform. Returns false, and changes nothing, if
/// one does not exist or `child` is `parent` or one of its ancestors.
[[nodiscard]] bool attach(World& world, Entity parent, Entity child, const Transform& transform);

/// The same at named points; false also if one is unknown. An empty name is the origin.
[[nodiscard]] bool attach(
    World& world, Entity parent, std::string_view parent_point, Entity child,
    std::string_view child_point, bool facing = false);

/// Of the transforms as they are now, whatever was drawn last.
[[nodiscard]] Affine world_from_entity(const World& world, Entity entity);

/// Makes `child` a root that stays where it is in the world. False if it has no parent.
[[nodiscard]] bool detach(World& world, Entity child);

/// Applies new and changed Attach components; logs those that cannot be. Exclusive.
void update_attach(World& world);

}  // namespace limn
