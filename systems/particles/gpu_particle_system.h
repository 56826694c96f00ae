#pragma once

#include "ecs/commands.h"
#include "ecs/components/gpu_particles.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/particles.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "systems/particles/gpu_shapes.h"
#include "systems/particles/particle_obstacles.h"
#include "systems/particles/step_context.h"

namespace limn {

/// Adds GpuParticles to every emitter that runs on the GPU and has none, and removes them from
/// all others.
void add_gpu_particles(
    Query<const ParticleEmitter, Without<GpuParticles>> bare,
    Query<const ParticleEmitter, const GpuParticles> emitters, Commands commands);

/// Records a step. After update_transforms and find_particle_obstacles.
void record_gpu_particles(
    Query<
        const ParticleEmitter, Optional<const ParticleMotion>, const WorldTransform,
        const PreviousWorldTransform, Optional<const ParticleCollision>,
        Optional<const ParticleWrap>, GpuParticles>
        emitters,
    Res<const ParticleObstacles> obstacles, Res<GpuShapes> shapes, ParticleEnvironment environment);

}  // namespace limn
