#pragma once

#include "ecs/base/math.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <array>
#include <cstdint>

namespace limn {

/// Tag: characters with a FootPlant stand on it, on the triangles of its mesh or on its
/// HeightField; without them, on its local plane y = 0.
struct Walkable {};

/// With a Skeleton of a person, or of anything with joints of those names: its feet stand on
/// Walkable entities below, and its hips are lowered until both reach. Clips are made for a level
/// floor at the character's origin.
struct FootPlant {
    float weight = 1.0f;
    float step = 0.45f;
    float align = 0.8f;
    float speed = 14.0f;
    float softness = 0.02f;
};

LIMN_FIELDS(FootPlant) {
    LIMN_FIELD(weight, "from the animated feet, 0, to the ground, 1", "", 0, 1);
    LIMN_FIELD(step, "highest step up or down", "m", 0, 10);
    LIMN_FIELD(align, "share of the slope that the feet take on", "", 0, 1);
    LIMN_FIELD(
        speed, "rate at which a foot follows the ground that it passes over", "1/s", 0, 1000);
    LIMN_FIELD(softness, "last part of the reach over which knees straighten", "m", 0, 1);
}

/// What the left and the right foot stand on.
struct FootContacts {
    std::array<Entity, 2> grounds{};  ///< none: nothing within a step
    std::array<Vec3, 2> points{};     ///< in the ground's space, so that it carries the foot
    std::array<float, 2> lifts{};     ///< above the level floor, in the character's space
    std::array<Vec3, 2> normals = {Vec3(0, 1, 0), Vec3(0, 1, 0)};
    std::array<Vec3, 2> slopes = {Vec3(0, 1, 0), Vec3(0, 1, 0)};  ///< normals that grounds carry
    std::array<std::uint16_t, 2> feet = {0xffff, 0xffff};
};

LIMN_FIELDS(FootContacts) {
    LIMN_FIELD(grounds, "entities below the left and the right foot");
    LIMN_FIELD(points, "where they stand, in the grounds' spaces", "m");
    LIMN_FIELD(lifts, "height above the level floor, in the character's space", "m");
    LIMN_FIELD(normals, "of the ground, in the character's space");
    LIMN_FIELD(slopes, "the same in the grounds' spaces");
    LIMN_FIELD(feet, "indices of the joints");
}

}  // namespace limn
