#include "systems/attach_system.h"

#include "ecs/base/log.h"
#include "ecs/base/rotation.h"
#include "ecs/components/placement.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

// Techniques: engine.attach

namespace limn {
namespace {

/// The named point; the origin for an empty name.
std::optional<AttachPoint> find_point(const World& world, Entity entity, std::string_view name) {
    if (name.empty()) {
        return AttachPoint{};
    }
    const AttachPoints* const all = world.find<AttachPoints>(entity);
    if (all == nullptr) {
        return std::nullopt;
    }
    const auto found = std::ranges::find(all->points, name, &AttachPoint::name);
    return found != all->points.end() ? std::optional(*found) : std::nullopt;
}

Affine affine_of(const Transform& transform) {
    return affine_from(transform.position, transform.rotation, transform.scale);
}

}  // namespace

Affine world_from_entity(const World& world, Entity entity) {
    Affine result;
    for (; !entity.is_null(); entity = parent_of(world, entity)) {
        if (const Transform* const transform = world.find<Transform>(entity)) {
            result = affine_of(*transform) * result;
        }
    }
    return result;
}

Transform attached_transform(
    const AttachPoint& parent, const AttachPoint& child, const Vec3& child_scale, bool facing) {
    const Quat turn = facing ? Quat(0, 0, 1, 0) : Quat(1, 0, 0, 0);
    Transform result;
    result.scale = child_scale;
    result.rotation = normalize_or_identity(
        normalize_or_identity(parent.rotation) * turn
        * glm::conjugate(normalize_or_identity(child.rotation)));
    result.position = parent.position - result.rotation * (child_scale * child.position);
    return result;
}

bool attach(World& world, Entity parent, Entity child, const Transform& transform) {
    if (parent.is_null() || !world.alive(child) || !set_parent(world, child, parent)) {
        return false;
    }
    world.add(child, transform);
    world.add(child, Teleport{});
    return true;
}

bool attach(
    World& world, Entity parent, std::string_view parent_point, Entity child,
    std::string_view child_point, bool facing) {
    if (!world.alive(parent) || !world.alive(child)) {
        return false;
    }
    const std::optional<AttachPoint> at = find_point(std::as_const(world), parent, parent_point);
    const std::optional<AttachPoint> by = find_point(std::as_const(world), child, child_point);
    if (!at || !by) {
        return false;
    }
    const Transform* const own = std::as_const(world).find<Transform>(child);
    const Vec3 scale = own != nullptr ? own->scale : Vec3(1);
    return attach(world, parent, child, attached_transform(*at, *by, scale, facing));
}

bool detach(World& world, Entity child) {
    if (!world.alive(child) || parent_of(world, child).is_null()) {
        return false;
    }
    const Transform placed = decompose_affine(world_from_entity(world, child));
    if (!set_parent(world, child, Entity{})) {
        return false;
    }
    world.add(child, placed);
    return true;
}

void update_attach(World& world) {
    std::vector<std::pair<Entity, Attach>> changed;
    world.query<const Attach>().each([&](Entity entity, const Attach& wanted) {
        const AttachState* const state = std::as_const(world).find<AttachState>(entity);
        if (state == nullptr || state->applied != wanted) {
            changed.emplace_back(entity, wanted);
        }
    });
    for (const auto& [entity, wanted] : changed) {
        if (wanted.to.is_null()) {
            (void)detach(world, entity);  // it may have been a root
        } else if (!attach(world, wanted.to, wanted.at, entity, wanted.by, wanted.facing)) {
            log_error(
                "attach: found no point {} and {}, or a parent that is a descendant, expected "
                "points of attach_points",
                wanted.at, wanted.by);
        }
        world.add(entity, AttachState{wanted});
    }
}

}  // namespace limn
