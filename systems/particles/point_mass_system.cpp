#include "systems/particles/point_mass_system.h"

#include "ecs/base/gravity.h"
#include "systems/particles/force_fields.h"
#include "systems/particles/particle_motion.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

// Techniques: particle.projectile, particle.variable-mass

namespace limn {
namespace {

constexpr auto kPointGravity = static_cast<float>(kGravity);  // [m/s^2]
constexpr float kMinPointSpeed = 0.5f;  // below which a body keeps its aim [m/s]

float positive_or_zero(float value) {
    return std::max(finite_or(value, 0), 0.0f);
}

Vec3 finite_or_zero(const Vec3& v) {
    return is_finite(v) ? v : Vec3(0);
}

/// All that acts on a body but fields and wind.
PointMassForces find_forces_on(
    const PointMass& body, const Quat& turn, const AirDrag* drag, const VariableMass* fuel,
    float dt) {
    PointMassForces found;
    found.acceleration.y = -kPointGravity * finite_or(body.gravity, 1);
    if (drag != nullptr) {
        const float area = kPi * square(finite_or(drag->radius, 0));
        found.drag =
            0.5f * positive_or_zero(drag->density) * positive_or_zero(drag->coefficient) * area;
    }
    if (fuel != nullptr) {
        const float dry = std::max(finite_or(fuel->dry_mass, 1), 1e-3f);
        const float left = std::max(body.mass - dry, 0.0f);
        found.burned = std::min(positive_or_zero(fuel->burn_rate) * dt, left);
        found.exhaust = turn * finite_or_zero(fuel->exhaust);
        found.keeps_momentum = fuel->form == MassForm::Momentum;
    }
    return found;
}

/// Turns local -z along the flight, by the shortest rotation.
Quat aimed(const Quat& turn, const Vec3& velocity) {
    if (!(glm::length(velocity) > kMinPointSpeed)) {
        return turn;
    }
    return glm::normalize(Quat(turn * Vec3(0, 0, -1), glm::normalize(velocity)) * turn);
}

CollisionOptions point_options(const ParticleCollision& collision) {
    return {
        .radius = positive_or_zero(collision.radius),
        .action = collision.action == CollisionAction::Kill    ? ContactAction::Kill
                  : collision.action == CollisionAction::Stick ? ContactAction::Stick
                                                               : ContactAction::Bounce};
}

}  // namespace

PointMass step_point_mass(const PointMass& body, const PointMassForces& forces, float dt) {
    PointMass next = body;
    next.mass = body.mass - forces.burned;
    // Half of the accelerations and of the thrust, all of the drag (dv/dt = -k |v| v solved
    // exactly), the other half.
    Vec3 half = 0.5f * dt * forces.acceleration;
    if (!forces.keeps_momentum) {
        half += 0.5f * std::log(next.mass / body.mass) * forces.exhaust;
    }
    Vec3 relative = body.velocity + half - forces.air;
    const float mean_mass = 0.5f * (body.mass + next.mass);
    relative /= 1 + forces.drag / mean_mass * glm::length(relative) * dt;
    next.velocity = forces.air + relative + half;
    if (forces.keeps_momentum) {
        next.velocity *= body.mass / next.mass;
    }
    return next;
}

void update_point_masses(
    Query<
        PointMass, Transform, Optional<const AirDrag>, Optional<const VariableMass>,
        Optional<const ParticleCollision>, Without<Parent>>
        bodies,
    Query<const ForceField, const WorldTransform> fields, Res<const ParticleObstacles> obstacles,
    Res<const WeatherState> gusts, OptionalRes<const Weather> weather, Res<const FrameTime> time,
    Commands commands) {
    const float dt = std::min(time->step, kMaxParticleStep);
    const Vec3 wind = weather ? current_weather(*weather, *gusts).wind() : Vec3(0);
    const std::vector<Force> around = find_forces(fields, time->time);
    const std::span<const Collider> solid = obstacles->solid.colliders;
    bodies.each([&](Entity entity, PointMass& body, Transform& transform, const AirDrag* drag,
                    const VariableMass* fuel, const ParticleCollision* collision) {
        if (!(finite_or(body.mass, 0) > 0) || !is_finite(body.velocity)
            || !is_finite(transform.position)) {
            body.velocity = Vec3(0);
            return;
        }
        PointMassForces forces = find_forces_on(body, transform.rotation, drag, fuel, dt);
        forces.air = drag != nullptr ? finite_or(drag->weather, 0) * wind : Vec3(0);
        for (const Force& force : around) {
            forces.acceleration +=
                finite_or(body.fields, 0) * acceleration(force, transform.position, body.velocity);
        }
        PointMass next = step_point_mass(body, forces, dt);
        const Vec3 mean = 0.5f * (body.velocity + next.velocity);
        Vec3 position = transform.position + mean * dt;
        if (collision != nullptr && !solid.empty()) {
            const CollisionResult moved = move_with_collisions(
                transform.position, mean, dt, solid,
                {.bounce = collision->bounce, .friction = collision->friction},
                point_options(*collision));
            position = moved.position;
            if (moved.contacts > 0) {
                next.velocity = moved.velocity;
                if (collision->action == CollisionAction::Kill) {
                    commands.add(entity, Lifetime{.left = 0});  // with its children
                    return;
                }
                if (collision->action == CollisionAction::Stick) {
                    next.mass = 0;
                }
            }
        }
        if (!is_finite(position) || !is_finite(next.velocity)) {
            body.velocity = Vec3(0);
            return;
        }
        body = next;
        transform.position = position;
        if (body.aim) {
            transform.rotation = aimed(transform.rotation, body.velocity);
        }
    });
}

}  // namespace limn
