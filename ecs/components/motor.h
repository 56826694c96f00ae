#pragma once

#include "ecs/base/math.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <array>
#include <cstdint>

namespace limn {

/// Moves its entity as its MoveIntent says: an upright capsule that walks on everything Walkable,
/// climbs steps, slides along walls, falls, wades and swims. Its origin is between its feet, and it
/// faces +z. Ground that moves and turns carries it along. A Parent only gives the place where it
/// begins: the motor takes the entity off it, and what it stands on carries it. If it is attached
/// to something by Attach, or later, it does not move by itself until it is detached.
struct CharacterMotor {
    float radius = 0.28f;
    float height = 1.75f;
    float step = 0.35f;
    float slope = radians(48.0f);
    float acceleration = 14.0f;
    float air_acceleration = 3.0f;
    float jump = 0.9f;
    float take_off = 0.0f;
    float turn = 9.0f;
    float swim_speed = 1.1f;
    float push = 80.0f;
};

LIMN_FIELDS(CharacterMotor) {
    LIMN_FIELD(radius, "of the capsule", "m", 0.01, 100);
    LIMN_FIELD(height, "from the soles to the crown", "m", 0.02, 200);
    LIMN_FIELD(step, "highest step that it climbs", "m", 0, 100);
    LIMN_FIELD(slope, "steepest ground that it stands on", "rad", 0, 1.57);
    LIMN_FIELD(acceleration, "on the ground", "m/s^2", 0, 1000);
    LIMN_FIELD(air_acceleration, "in the air and in water", "m/s^2", 0, 1000);
    LIMN_FIELD(jump, "height of a jump", "m", 0, 100);
    LIMN_FIELD(take_off, "time for which it crouches before it jumps", "s", 0, 1);
    LIMN_FIELD(turn, "largest speed of turning", "rad/s", 0, 100);
    LIMN_FIELD(swim_speed, "largest speed in water", "m/s", 0, 100);
    LIMN_FIELD(push, "mass with which it pushes loose bodies", "kg", 0, 1e6);
}

enum class MotorMode : std::uint32_t {
    Stand,  ///< on the ground, walking or not
    Fall,
    Swim,
};

/// How the ground below a character has moved it in the last step, before it moved by itself: what
/// was at `from` is at `to`, and what is around it has turned with it.
struct GroundRide {
    Vec3 from = Vec3(0);
    Vec3 to = Vec3(0);
    Quat turn = Quat(1, 0, 0, 0);
    float yaw = 0.0f;
};

LIMN_FIELDS(GroundRide) {
    LIMN_FIELD(from, "where the character was, in the world", "m");
    LIMN_FIELD(to, "where the ground has carried it", "m");
    LIMN_FIELD(turn, "of the ground");
    LIMN_FIELD(yaw, "turn of the character, which stays upright", "rad");
}

/// State of a CharacterMotor.
struct MotorState {
    Vec3 velocity = Vec3(0);
    Vec3 normal = Vec3(0, 1, 0);
    Vec3 wall = Vec3(0);
    Entity ground{};
    Vec3 point = Vec3(0);
    Quat ground_rotation = Quat(1, 0, 0, 0);
    GroundRide ride{};
    Vec3 drift = Vec3(0);
    Vec3 place = Vec3(0);
    std::uint32_t arrived = 0;
    std::uint32_t held = 0;
    float depth = -1.0f;
    float air_time = 0.0f;
    float gather = 0.0f;
    float above = -1.0f;
    MotorMode mode = MotorMode::Fall;
};

LIMN_FIELDS(MotorState) {
    LIMN_FIELD(velocity, "in the world, without that of the ground", "m/s");
    LIMN_FIELD(normal, "of the ground");
    LIMN_FIELD(wall, "normal of the wall toward which it wants to go; 0 0 0: none");
    LIMN_FIELD(ground, "entity that it stands on");
    LIMN_FIELD(point, "where, in the space of that entity", "m");
    LIMN_FIELD(ground_rotation, "of that entity, in the world");
    LIMN_FIELD(ride, "how that entity has moved it in the last step");
    LIMN_FIELD(
        drift, "velocity of what carries it, or of the ground that it has left in a jump or a fall",
        "m/s");
    LIMN_FIELD(place, "where it was left in the world", "m");
    LIMN_FIELD(
        arrived, "1: has come to ground whose velocity is still in its own, from other ground", "",
        0, 1);
    LIMN_FIELD(held, "1: is attached to something that carries it", "", 0, 1);
    LIMN_FIELD(depth, "of the water above the soles; < 0: none", "m");
    LIMN_FIELD(air_time, "since it last stood", "s");
    LIMN_FIELD(gather, "since it crouches for a jump", "s");
    LIMN_FIELD(above, "height over the ground while it falls; < 0: farther than 4 m", "m");
    LIMN_FIELD(mode, .doc = "what it does", .values = "stand fall swim");
}

/// With a CharacterMotor: the player moves it, relative to the camera.
struct Hero {
    float walk = 1.4f;
    float run = 4.2f;
    float reach = 1.1f;
    float throw_speed = 7.0f;
    float lost = 2.0f;
    Entity camera{};
    Entity carried{};
};

LIMN_FIELDS(Hero) {
    LIMN_FIELD(walk, "speed of walking", "m/s", 0, 100);
    LIMN_FIELD(run, "speed of running", "m/s", 0, 100);
    LIMN_FIELD(reach, "distance at which it picks up a loose body", "m", 0, 100);
    LIMN_FIELD(throw_speed, "of what it throws", "m/s", 0, 100);
    LIMN_FIELD(
        lost, "time of a fall toward nothing, after which it is back where it stood; 0: never", "s",
        0, 60);
    LIMN_FIELD(camera, "camera that its directions refer to, by name; none: the world");
    LIMN_FIELD(carried, "loose body that it carries");
}

/// State of a Hero.
struct HeroState {
    Vec3 aim = Vec3(0);
    float aiming = 0.0f;
    std::array<Vec3, 2> stood = {};
    float since_stood = 0.0f;
    std::uint32_t has_stood = 0;
};

LIMN_FIELDS(HeroState) {
    LIMN_FIELD(aim, "direction in which it is about to throw; 0 0 0: none");
    LIMN_FIELD(aiming, "time for which it has turned to throw", "s");
    LIMN_FIELD(stood, "places where it stood on ground at rest, an earlier and a later one", "m");
    LIMN_FIELD(since_stood, "time since the later of them", "s");
    LIMN_FIELD(has_stood, "1: they are set", "", 0, 1);
}

/// Not copied with a prefab: an instance has no history.
template <>
struct ComponentTraits<HeroState> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

/// A ball or a crate, handled as a ball: falls, rolls on what is Walkable, is pushed by characters
/// and carried and thrown by a Hero. Must not have a parent; its origin is its center.
struct LooseBody {
    float radius = 0.2f;
    float mass = 2.0f;
    float bounce = 0.4f;
    float friction = 0.6f;
    bool rolls = true;
};

LIMN_FIELDS(LooseBody) {
    LIMN_FIELD(radius, "of the ball", "m", 0.001, 100);
    LIMN_FIELD(mass, "of the body", "kg", 0.001, 1e6);
    LIMN_FIELD(bounce, "fraction of the normal speed that a hit keeps", "", 0, 1);
    LIMN_FIELD(friction, "deceleration on the ground, in proportion to gravity", "", 0, 10);
    LIMN_FIELD(rolls, "turns as it rolls; a crate does not");
}

/// State of a LooseBody.
struct LooseState {
    Vec3 velocity = Vec3(0);
    Entity carrier{};
    float held = 0.0f;
};

LIMN_FIELDS(LooseState) {
    LIMN_FIELD(velocity, "in the world", "m/s");
    LIMN_FIELD(carrier, "hero who carries it");
    LIMN_FIELD(held, "since it was picked up", "s");
}

}  // namespace limn
