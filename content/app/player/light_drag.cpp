#include "content/app/player/light_drag.h"

#include "content/app/panels/field_widgets.h"
#include "content/app/panels/undo.h"
#include "ecs/any_component.h"
#include "ecs/components/light.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace limn {
namespace {

float brightness(const Vec3& color) {
    return std::max(color.x, std::max(color.y, color.z));
}

/// Fraction of a sphere's lit side that faces the viewer: 1 for a light behind the viewer, 0 for
/// one behind the sphere.
float facing_lit_fraction(const Vec3& to_light, const Vec3& to_viewer) {
    return 0.5f + 0.5f * glm::dot(normalize_or(to_light, to_viewer), to_viewer);
}

/// Into the space of the entity's Transform: that of its parent, which should not be stretched.
Affine parent_from_world(const World& world, Entity entity) {
    const Entity parent = parent_of(world, entity);
    const auto* const transform = parent.is_null() ? nullptr : world.find<WorldTransform>(parent);
    return transform != nullptr ? to_affine(glm::inverse(to_mat4(transform->world))) : Affine{};
}

/// The edit of a light's transform, not yet applied.
Edit edit_of(const World& world, Entity light, const Transform& after) {
    Edit edit;
    edit.entity = light;
    edit.before = AnyComponent::read(world, light, component_info<Transform>());
    edit.after = AnyComponent::of(after);
    edit.label = fmt::format("{}: transform", entity_label(world, light));
    return edit;
}

}  // namespace

std::optional<Entity>
brightest_light(const World& world, const Vec3& point, const Vec3& to_viewer) {
    std::optional<Entity> found;
    float most = 0;
    const auto offer = [&](Entity entity, float illuminance) {
        if (illuminance > most) {
            most = illuminance;
            found = entity;
        }
    };
    const auto offer_lamp = [&](Entity entity, const auto& lamp, const Transform& transform) {
        const Affine to_parent = parent_from_world(world, entity);
        const Vec3 to_light = transform.position - transform_point(to_parent, point);
        const float intensity = lamp.enabled ? lamp.intensity * brightness(lamp.color) : 0.0f;
        const float fraction = facing_lit_fraction(
            to_light, normalize_or(transform_vector(to_parent, to_viewer), {0, 0, 1}));
        offer(entity, fraction * intensity / std::max(glm::dot(to_light, to_light), 1e-6f));
    };
    world.query<const PointLight, const Transform>().each(offer_lamp);
    world.query<const SpotLight, const Transform>().each(offer_lamp);
    world.query<const DirectionalLight, const Transform>().each([&](Entity entity,
                                                                    const DirectionalLight& light,
                                                                    const Transform& transform) {
        const Vec3 viewer_direction =
            normalize_or(transform_vector(parent_from_world(world, entity), to_viewer), {0, 0, 1});
        const float fraction =
            facing_lit_fraction(transform.rotation * Vec3(0, 0, 1), viewer_direction);
        offer(
            entity, light.enabled ? fraction * light.illuminance * brightness(light.color) : 0.0f);
    });
    return found;
}

Transform turned_light(
    const Transform& transform, const Vec3& center, const Vec2& motion, float height,
    const Affine& world_from_camera) {
    const float angle = kPi / std::max(height, 1.0f);
    const Vec3 right = glm::normalize(transform_vector(world_from_camera, {1, 0, 0}));
    const Vec3 up = glm::normalize(transform_vector(world_from_camera, {0, 1, 0}));
    const Quat turn =
        glm::angleAxis(motion.x * angle, up) * glm::angleAxis(motion.y * angle, right);
    Transform turned = transform;
    turned.position = center + turn * (transform.position - center);
    turned.rotation = glm::normalize(turn * transform.rotation);
    return turned;
}

Transform facing_light(const Transform& transform, const Vec3& center, const Vec3& direction) {
    Transform turned = transform;
    turned.position = center + glm::distance(transform.position, center) * direction;
    const Vec3 up = std::abs(direction.y) > 0.999f ? Vec3(0, 0, 1) : Vec3(0, 1, 0);
    turned.rotation = glm::quatLookAt(-direction, up);
    return turned;
}

void LightDrag::drag(
    World& world, UndoStack& undo, const Vec3& center, const Vec2& motion, float height,
    const Affine& world_from_camera) {
    const bool begins = !std::as_const(world).has<Transform>(light_);
    const Vec3 to_camera = transform_point(world_from_camera, Vec3(0)) - center;
    const std::optional<Entity> light =
        begins ? brightest_light(world, center, normalize_or(to_camera, {0, 0, 1})) : light_;
    if (!light || motion == Vec2(0)) {
        return;
    }
    const Transform transform = *std::as_const(world).find<Transform>(*light);
    const Affine to_parent = parent_from_world(world, *light);
    Edit edit = edit_of(
        world, *light,
        turned_light(
            transform, transform_point(to_parent, center), motion, height,
            to_parent * world_from_camera));
    apply_edit_value(world, edit, edit.after);
    if (begins) {
        undo.record(std::move(edit));
    } else {
        undo.extend(std::move(edit));
    }
    light_ = *light;
}

void face_light(World& world, UndoStack& undo, const Vec3& center, const Vec3& direction) {
    if (const std::optional<Entity> light = brightest_light(world, center, direction)) {
        const Transform transform = *std::as_const(world).find<Transform>(*light);
        const Affine to_parent = parent_from_world(world, *light);
        Edit edit = edit_of(
            world, *light,
            facing_light(
                transform, transform_point(to_parent, center),
                glm::normalize(transform_vector(to_parent, direction))));
        apply_edit_value(world, edit, edit.after);
        undo.record(std::move(edit));
    }
}

}  // namespace limn
