#pragma once

#include "ecs/commands.h"
#include "ecs/components/gpu_particles.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/particle_mesh.h"
#include "ecs/components/particle_surface.h"
#include "ecs/components/particles.h"
#include "ecs/components/transform.h"
#include "ecs/components/water_spray.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "systems/particles/emitter_step.h"
#include "systems/particles/gpu_shapes.h"
#include "systems/particles/particle_obstacles.h"
#include "systems/particles/step_context.h"

namespace limn {

/// Adds GpuParticles to every emitter that runs on the GPU and has none, and removes them from
/// all others.
void add_gpu_particles(
    Query<const ParticleEmitter, Without<GpuParticles>> bare,
    Query<const ParticleEmitter, const GpuParticles> emitters, Commands commands);

/// Records a step. After update_transforms, find_particle_obstacles and update_particles, which
/// finds births by particles of other emitters.
void record_gpu_particles(
    Query<
        const ParticleEmitter, Optional<const ParticleMotion>, const WorldTransform,
        const PreviousWorldTransform, Optional<const ParticleCollision>,
        Optional<const ParticleWrap>, Optional<const ParticleSource>,
        Optional<const ParticleSurface>, Optional<const ParticleMesh>, Optional<const SprayDrops>,
        GpuParticles>
        emitters,
    BirthSurfaces surfaces, Res<const ParticleObstacles> obstacles, Res<GpuShapes> shapes,
    ParticleEnvironment environment);

}  // namespace limn
