#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

/// Placement of an entity relative to its parent, or to the world if it has none.
struct Transform {
    Vec3 position = {0, 0, 0};
    Quat rotation = {1, 0, 0, 0};
    Vec3 scale = {1, 1, 1};
};

LIMN_FIELDS(Transform) {
    LIMN_FIELD(position, "relative to the parent", "m");
    LIMN_FIELD(rotation, "unit quaternion x y z w, or Euler angles [yaw, pitch, roll] in degrees");
    LIMN_FIELD(scale, "scale along each local axis, not 0");
}

/// world_from_local after the last simulation step; only update_transforms writes it.
struct WorldTransform {
    Affine world;
};

/// world_from_local one simulation step earlier, equal to WorldTransform in the step of the spawn
/// and in that of a jump. Rendering interpolates between the two and derives velocities from them.
struct PreviousWorldTransform {
    Affine world = {{Vec4(0), Vec4(0), Vec4(0)}};  ///< all 0: no step has been taken yet
};

/// Not copied with a prefab, since an instance has another position and no history:
/// add_world_transforms adds both.
template <>
struct ComponentTraits<WorldTransform> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};
template <>
struct ComponentTraits<PreviousWorldTransform> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

/// Tag: the entity was moved discontinuously, at the beginning of the next step, which yields no
/// velocity. Removed by update_transforms.
struct Teleport {};

/// Sparse: an entity that teleports keeps its position among the others, and so in all lists.
template <>
struct ComponentTraits<Teleport> : DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};

/// Rotates the entity about a fixed axis in its local space.
struct Spin {
    Vec3 axis = {0, 1, 0};
    float speed = 0.5f;
};

LIMN_FIELDS(Spin) {
    LIMN_FIELD(axis, "rotation axis in local space");
    LIMN_FIELD(speed, "angular speed", "rad/s", -100, 100);
}

/// Oscillates the entity about a rest position: offset_i = amplitude_i sin(frequency_i t +
/// phase_i).
struct Sway {
    Vec3 center = {0, 0, 0};
    Vec3 amplitude = {0, 0.25f, 0};
    Vec3 frequency = {1, 1, 1};
    Vec3 phase = {0, 0, 0};
};

/// Split: sway_positions loads each field for many entities at once.
template <>
struct ComponentTraits<Sway> : DefaultTraits {
    static constexpr Storage storage = Storage::Split;
};

LIMN_FIELDS(Sway) {
    LIMN_FIELD(center, "rest position, relative to the parent", "m");
    LIMN_FIELD(amplitude, "amplitude along each axis", "m");
    LIMN_FIELD(frequency, "angular frequency along each axis", "rad/s");
    LIMN_FIELD(phase, "phase along each axis", "rad");
}

}  // namespace limn
