#pragma once

#include "ecs/components/force_field.h"
#include "ecs/components/gpu_particles.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "systems/particles/particle_kernels.h"

#include <span>
#include <vector>

namespace limn {

/// All ForceFields at an instant [s], in world space. Their directions do not scale.
[[nodiscard]] std::vector<Force>
find_forces(const Query<const ForceField, const WorldTransform>& fields, double time);

/// Acceleration by one of them [m/s^2] at a place, of a particle with this velocity.
[[nodiscard]] Vec3 acceleration(const Force& force, const Vec3& place, const Vec3& velocity);

/// v += share * dt * the sum of all accelerations.
void push_particles(
    const ParticleBlock& block, std::span<const Force> forces, float share, float dt);

}  // namespace limn
