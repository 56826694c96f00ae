#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

/// Where an entity is, relative to its parent or, without one, to the world.
struct Transform {
    Vec3 position = {0, 0, 0};     ///< [m]
    Quat rotation = {1, 0, 0, 0};  ///< unit
    Vec3 scale = {1, 1, 1};        ///< not 0
};

/// world_from_local after the last step of the simulation; written by update_transforms alone.
struct WorldTransform {
    Affine world;
};

/// world_from_local one simulation step earlier, equal to WorldTransform in the step of the spawn
/// and after a Teleport: rendering interpolates between the two and takes the velocity from them.
struct PreviousWorldTransform {
    Affine world = {{Vec4(0), Vec4(0), Vec4(0)}};  ///< all 0: no step has been taken yet
};

/// A copy of a prefab stands elsewhere and has no past: add_world_transforms gives it both anew.
template <>
struct ComponentTraits<WorldTransform> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};
template <>
struct ComponentTraits<PreviousWorldTransform> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

/// Tag: the entity jumped; its next step has no velocity. Removed by update_transforms.
struct Teleport {};

/// Turns the entity about a fixed axis in its own space.
struct Spin {
    Vec3 axis = {0, 1, 0};
    float speed = 0.5f;  ///< [rad/s]
};

/// Moves the entity on a closed path about where it was placed: offset_i = amplitude_i
/// sin(frequency_i t + phase_i).
struct Sway {
    Vec3 center = {0, 0, 0};         ///< rest position, relative to the parent [m]
    Vec3 amplitude = {0, 0.25f, 0};  ///< [m]
    Vec3 frequency = {1, 1, 1};      ///< [rad/s]
    Vec3 phase = {0, 0, 0};          ///< [rad]
};

template <typename Visitor>
void visit_fields(Transform& transform, Visitor&& visit) {
    visit("position", transform.position, {.doc = "relative to the parent", .unit = "m"});
    visit(
        "rotation", transform.rotation,
        {.doc = "unit quaternion x y z w, or Euler angles [yaw, pitch, roll] in degrees"});
    visit("scale", transform.scale, {.doc = "along each local axis, not 0"});
}

template <typename Visitor>
void visit_fields(Spin& spin, Visitor&& visit) {
    visit("axis", spin.axis, {.doc = "axis of the rotation in local space"});
    visit("speed", spin.speed, {.doc = "angular speed", .unit = "rad/s", .min = -100, .max = 100});
}

template <typename Visitor>
void visit_fields(Sway& sway, Visitor&& visit) {
    visit("center", sway.center, {.doc = "rest position", .unit = "m"});
    visit("amplitude", sway.amplitude, {.doc = "reach along each axis", .unit = "m"});
    visit(
        "frequency", sway.frequency, {.doc = "angular frequency along each axis", .unit = "rad/s"});
    visit("phase", sway.phase, {.doc = "phase along each axis", .unit = "rad"});
}

}  // namespace limn
