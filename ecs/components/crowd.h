#pragma once

#include "ecs/base/math.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

// Crowds: entities that walk to goals on the ground, in the plane of world x and z, without running
// into each other, and flocks. Both move the Transforms of roots, which face +z; the characters
// animate themselves.

/// To which side walkers turn that meet head-on or are blocked. All that meet should agree.
enum class PassingSide : std::uint8_t {
    Seeded,  ///< one of both for all, by random_seed
    Right,
    Left,
};

/// A walker, without a Parent: a disc that avoids others and CrowdObstacles. It goes to its
/// CrowdGoal or, without one, where its MoveIntent says. It stands on Walkable ground.
struct CrowdAgent {
    float radius = 0.3f;
    float speed = 1.3f;
    float max_speed = 1.8f;
    float horizon = 2.0f;
    float neighbor_distance = 5.0f;
    float priority = 1.0f;
    PassingSide side = PassingSide::Seeded;
    float turn_speed = 4.0f;
    float stride = 0.0f;
    float climb = 0.45f;
};

LIMN_FIELDS(CrowdAgent) {
    LIMN_FIELD(radius, "of the disc that others keep off", "m", 0.01, 100);
    LIMN_FIELD(speed, "at which it walks to its goal", "m/s", 0, 100);
    LIMN_FIELD(max_speed, "at most, to evade others", "m/s", 0.001, 100);
    LIMN_FIELD(horizon, "how far ahead it avoids others", "s", 0.05, 60);
    LIMN_FIELD(neighbor_distance, "up to which it sees others: the ten nearest", "m", 0.1, 1000);
    LIMN_FIELD(
        priority, "of two walkers, the one with more evades less; one that stands, a quarter of it",
        "", 0.01, 100);
    LIMN_FIELD(
        side, .doc = "to which it turns where others block it; seeded: one for all, by random_seed",
        .values = "seeded right left");
    LIMN_FIELD(turn_speed, "highest, of its heading", "rad/s", 0, 100);
    LIMN_FIELD(
        stride,
        "distance in one loop of its clip_player, whose time then follows the distance that "
        "it walks; 0: by time",
        "m", 0, 100);
    LIMN_FIELD(
        climb,
        "highest step up or down that it takes on walkable ground; where there is none so near, it "
        "keeps its height",
        "m", 0, 10);
}

/// Where a walker goes: to the entity `exit` or, without one, to `point`. It walks around what
/// blocks a crowd_space if the entity is a crowd_exit, else straight.
struct CrowdGoal {
    Vec3 point = {0, 0, 0};
    Entity exit{};
    float arrive = 0.3f;
};

LIMN_FIELDS(CrowdGoal) {
    LIMN_FIELD(point, "where it goes without an exit; y is ignored", "m");
    LIMN_FIELD(exit, "entity to which it goes");
    LIMN_FIELD(arrive, "distance at which it stops", "m", 0.01, 100);
}

/// A goal of many walkers: a disc at its entity's position. Those who arrive go on to `next`.
struct CrowdExit {
    float radius = 1.0f;
    Entity next{};
};

LIMN_FIELDS(CrowdExit) {
    LIMN_FIELD(radius, "within which walkers have arrived", "m", 0.05, 1000);
    LIMN_FIELD(next, "entity to which they go then; none: they stay");
}

/// What walkers go around: a box of the entity's x and z, or a disc.
struct CrowdObstacle {
    Vec2 size = {1, 1};
    bool round = false;
};

LIMN_FIELDS(CrowdObstacle) {
    LIMN_FIELD(size, "along the entity's x and z; round: x is the diameter", "m", 0.001, 10000);
    LIMN_FIELD(round, "a disc instead of a box");
}

/// A rectangle of the ground, of world x and z about its entity, in which walkers find their ways
/// to CrowdExits around CrowdObstacles, over a grid.
struct CrowdSpace {
    Vec2 size = {20, 20};
    float cell = 0.5f;
    float clearance = 0.4f;
};

LIMN_FIELDS(CrowdSpace) {
    LIMN_FIELD(size, "along world x and z", "m", 0.1, 10000);
    LIMN_FIELD(cell, "side of the grid's cells; at least a 1000th of the size", "m", 0.05, 100);
    LIMN_FIELD(clearance, "distance that ways keep from obstacles", "m", 0, 100);
}

/// State of a walker.
struct CrowdState {
    Vec2 velocity = {0, 0};
    float detour = 0;
};

LIMN_FIELDS(CrowdState) {
    LIMN_FIELD(velocity, "along world x and z", "m/s");
    LIMN_FIELD(detour, "how far it turns to its side, being blocked", "rad", 0, 1.25);
}

/// Not copied with a prefab: an instance has no history.
template <>
struct ComponentTraits<CrowdState> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
