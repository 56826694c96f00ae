#pragma once

#include "ecs/components/force_field.h"
#include "ecs/components/gpu_particles.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "systems/particles/particle_kernels.h"

#include <span>
#include <vector>

namespace limn {

/// All ForceFields at `time` [s], in world space. The scale of their entities does not count.
[[nodiscard]] std::vector<Force>
find_forces(const Query<const ForceField, const WorldTransform>& fields, double time);

/// Acceleration of a particle [m/s^2] by one of them.
[[nodiscard]] Vec3 acceleration(const Force& force, const Vec3& position, const Vec3& velocity);

/// v += scale * dt * the sum of all accelerations.
void apply_forces(const ParticleBlock& block, std::span<const Force> forces, float scale, float dt);

}  // namespace limn
