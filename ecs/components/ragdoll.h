#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <string>
#include <vector>

namespace limn {

// Bodies that physics moves: a character that is pushed, falls down and comes to rest, then gets up
// into its animation again.
// Techniques: char.dynamics

/// With a Skeleton: while active, its bones are rigid capsules on ball joints that fall, collide
/// with ParticleColliders, Walkable entities and other active ragdolls, float in water, and are
/// moved by force fields.
/// Limits of the joints are the skeleton's freedoms, or those of a person. When it becomes active,
/// the bones have the velocities of the animation. When it becomes inactive, an entity without
/// parent moves to where its body lies, and the pose goes over into the animation.
struct Ragdoll {
    bool active = false;
    float mass = 75.0f;
    float thickness = 1.0f;
    float friction = 0.6f;
    float bounce = 0.0f;
    float damping = 3.0f;
    float gravity = 1.0f;
    float stiffness = 0.0f;
    float collapse = 0.15f;
    float get_up = 1.2f;
    float fields = 1.0f;
    float buoyancy = 1.03f;
    float water_drag = 2.5f;
    bool meets = true;
    float trip_speed = 0.0f;
    float trip_field = 0.0f;
    Vec3 push = {0, 0, 0};
    std::string push_joint{};
};

LIMN_FIELDS(Ragdoll) {
    LIMN_FIELD(active, "physics moves it; otherwise the animation");
    LIMN_FIELD(mass, "of the whole body", "kg", 0.001, 1e6);
    LIMN_FIELD(thickness, "factor on the radii of the capsules", "", 0.1, 10);
    LIMN_FIELD(friction, "coefficient of friction (Coulomb)", "", 0, 10);
    LIMN_FIELD(bounce, "fraction of the impact speed that is kept, outward", "", 0, 1);
    LIMN_FIELD(damping, "rate at which joints slow down", "1/s", 0, 1000);
    LIMN_FIELD(gravity, "factor on 9.81 m/s^2 downwards", "", -100, 100);
    LIMN_FIELD(
        stiffness, "of muscles that hold the animated pose: 0 limp, but for `collapse`, 1 stiff",
        "", 0, 1);
    LIMN_FIELD(
        collapse,
        "time in which the muscles give way after the switch; for six times as long who falls "
        "bends "
        "knees and hips and puts the arms ahead; 0: limp at once",
        "s", 0, 60);
    LIMN_FIELD(
        get_up, "time in which it gets into a crouch, then up into the animation again", "s", 0,
        60);
    LIMN_FIELD(fields, "factor on the accelerations of each force_field", "", -100, 100);
    LIMN_FIELD(
        buoyancy, "density of water over that of the body; 0: falls through water", "", 0, 100);
    LIMN_FIELD(water_drag, "rate at which what is under water slows down", "1/s", 0, 100);
    LIMN_FIELD(meets, "touches other ragdolls that are active");
    LIMN_FIELD(
        trip_speed, "becomes active when a collider of at least this speed touches it; 0: never",
        "m/s", 0, 1e4);
    LIMN_FIELD(
        trip_field, "becomes active when force fields accelerate it by this much; 0: never",
        "m/s^2", 0, 1e6);
    LIMN_FIELD(
        push, "velocity that it gains in the next step, which sets this to 0; starts it", "m/s",
        -1000, 1000);
    LIMN_FIELD(push_joint, "name of the joint that is pushed; empty: the whole body");
}

/// State of a Ragdoll: its capsules, one entry each in all lists, parents first.
struct RagdollState {
    std::vector<std::uint16_t> joints{};  ///< of the skeleton; empty: never active yet
    std::vector<Vec3> positions{};        ///< of the centers of mass, in the world [m]
    std::vector<Quat> rotations{};        ///< of the joints, in the world
    std::vector<Vec3> velocities{};       ///< [m/s]
    std::vector<Vec3> spins{};            ///< angular velocities, in the world [rad/s]
    std::vector<float> slack{};   ///< by which joints were beyond their limits at the switch [rad]
    std::vector<Vec3> centers{};  ///< of mass, in the joints' spaces, in the world's scale [m]
    Affine character_from_world{};  ///< in this step
    float weight = 0.0f;            ///< 0: the animation, 1: physics
    float time = 0.0f;              ///< since it became active [s]
    float still = 0.0f;             ///< for which it has hardly moved [s]; it sleeps from 0.5 s
    std::uint32_t contacts = 0;     ///< when it fell asleep
    std::uint32_t is_active = 0;
};

LIMN_FIELDS(RagdollState) {
    LIMN_FIELD(joints, "indices of the joints that have capsules");
    LIMN_FIELD(positions, "of the centers of mass, in the world", "m");
    LIMN_FIELD(rotations, "of the joints, in the world");
    LIMN_FIELD(velocities, "of the centers of mass", "m/s");
    LIMN_FIELD(spins, "angular velocities", "rad/s");
    LIMN_FIELD(slack, "by which joints may exceed their limits: less and less", "rad");
    LIMN_FIELD(centers, "of mass, in the joints' spaces", "m");
    LIMN_FIELD(character_from_world, "of this step");
    LIMN_FIELD(weight, "of physics, 0: the animation", "", 0, 1);
    LIMN_FIELD(time, "since it became active", "s");
    LIMN_FIELD(still, "time for which it has hardly moved", "s");
    LIMN_FIELD(contacts, "touching capsules when it fell asleep");
    LIMN_FIELD(is_active, "whether physics moves it");
}

/// Not copied with a prefab: an instance has no history.
template <>
struct ComponentTraits<RagdollState> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
