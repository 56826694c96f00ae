#pragma once

#include "ecs/commands.h"
#include "ecs/components/force_field.h"
#include "ecs/components/lifetime.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/point_mass.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/components/weather.h"
#include "ecs/hierarchy.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "systems/particles/particle_obstacles.h"

namespace limn {

// Flight of bodies that are points with a mass (book, appendix 8.1; particle.projectile,
// particle.variable-mass).
//
//     m dv/dt = F - 1/2 rho C A |v| v + u dm/dt,    dx/dt = v
//
// Each part is exact by itself: half of the accelerations, all of the drag, the other half (Strang
// 1968), so that neither a long step nor a light body reverses its flight. Second order in dt;
// exact for constant forces, and a rocket in space gains |u| ln(m0 / m1) whatever the step.

/// What acts on a body in a step.
struct PointMassForces {
    Vec3 acceleration = {0, 0, 0};  ///< of gravity and fields [m/s^2]
    Vec3 air = {0, 0, 0};           ///< velocity of the air [m/s]
    float drag = 0;                 ///< 1/2 density coefficient area [kg/m]
    float burned = 0;               ///< mass that leaves, less than all of it [kg]
    Vec3 exhaust = {0, 0, 0};       ///< its velocity relative to the body, in world space [m/s]
    bool keeps_momentum = false;    ///< of that mass: MassForm::Momentum
};

/// Velocity and mass after `dt` [s]; `body.mass` > 0.
[[nodiscard]] PointMass
step_point_mass(const PointMass& body, const PointMassForces& forces, float dt);

/// A step of all point masses, of at most kMaxParticleStep; their WorldTransforms follow in the
/// next step. Those whose mass, velocity or position is not finite stay and stop. After
/// find_particle_obstacles.
void update_point_masses(
    Query<
        PointMass, Transform, Optional<const AirDrag>, Optional<const VariableMass>,
        Optional<const ParticleCollision>, Without<Parent>>
        bodies,
    Query<const ForceField, const WorldTransform> fields, Res<const ParticleObstacles> obstacles,
    Res<const WeatherState> gusts, OptionalRes<const Weather> weather, Res<const FrameTime> time,
    Commands commands);

}  // namespace limn
