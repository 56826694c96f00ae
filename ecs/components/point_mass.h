#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

// Bodies idealized as points that have a mass: cannonballs, rockets (particle.projectile,
// particle.variable-mass). Each is an entity that gravity, force fields and what stands beside it
// here move, and that carries trails, emitters and lights with it.
// Techniques: particle.projectile, particle.variable-mass

/// Moves its entity, which must not have a parent. With a ParticleCollision it hits what particles
/// hit, but not water; "kill" destroys it with its children, and "stick" ends its flight.
struct PointMass {
    Vec3 velocity = {0, 0, 0};
    float mass = 5;
    float gravity = 1;
    float fields = 1;
    bool aim = false;
};

LIMN_FIELDS(PointMass) {
    LIMN_FIELD(velocity, "in world space", "m/s", -1e4, 1e4);
    LIMN_FIELD(mass, "of the whole; 0: nothing moves it", "kg", 0, 1e9);
    LIMN_FIELD(gravity, "factor on 9.81 m/s^2 downwards", "", -100, 100);
    LIMN_FIELD(fields, "factor on the accelerations of each force_field", "", -100, 100);
    LIMN_FIELD(aim, "local -z turns along the flight");
}

/// Air resistance of a PointMass, 1/2 density coefficient area |v| v against its velocity relative
/// to the air. (The book has the square of the area; it is linear.)
struct AirDrag {
    float coefficient = 0.47f;
    float radius = 0.1f;
    float density = 1.225f;
    float weather = 0;
};

LIMN_FIELDS(AirDrag) {
    LIMN_FIELD(coefficient, "of drag; a sphere: 0.47", "", 0, 100);
    LIMN_FIELD(radius, "of the cross-section, a disc", "m", 0, 1e3);
    LIMN_FIELD(density, "of the air", "kg/m^3", 0, 1e5);
    LIMN_FIELD(weather, "fraction of the wind of the resource weather", "", 0, 10);
}

/// What becomes of the momentum of the mass that leaves.
enum class MassForm : std::uint8_t {
    Rocket,    ///< it leaves at the velocity `exhaust`: thrust (Tsiolkovsky 1903)
    Momentum,  ///< it stays with the rest, as d(m v)/dt = F is often read: no thrust
};

/// A PointMass that burns fuel, until only `dry_mass` is left.
struct VariableMass {
    float burn_rate = 1;
    float dry_mass = 1;
    Vec3 exhaust = {0, 0, 300};
    MassForm form = MassForm::Rocket;
};

LIMN_FIELDS(VariableMass) {
    LIMN_FIELD(burn_rate, "mass that leaves in a second", "kg/s", 0, 1e9);
    LIMN_FIELD(dry_mass, "mass without fuel", "kg", 0.001, 1e9);
    LIMN_FIELD(
        exhaust, "its velocity relative to the body, along the local axes", "m/s", -1e5, 1e5);
    LIMN_FIELD(
        form,
        .doc = "rocket: exhaust takes its momentum along; momentum: what is left keeps all of it",
        .values = "rocket momentum");
}

}  // namespace limn
