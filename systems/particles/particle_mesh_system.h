#pragma once

#include "ecs/commands.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/particle_mesh.h"
#include "ecs/components/particle_surface.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

// Transforms of particles that are meshes. A particle is recognized in the next step by its random
// bits, in the order of births: so each instance has its true previous transform, for velocities
// and for frames between steps.

/// Adds a ParticleMeshState to every ParticleMesh that lacks one. Before update_particle_meshes,
/// with a sync point in between.
void add_particle_mesh_states(
    Query<const ParticleMesh, Without<ParticleMeshState>> meshes, Commands commands);

/// A step of all of them. After update_particles.
void update_particle_meshes(
    Query<
        const ParticleMesh, const ParticlePool, const WorldTransform,
        Optional<const ParticleSurface>, Optional<const ParticleCollision>, ParticleMeshState>
        meshes,
    Res<const Assets> assets, Res<const FrameTime> time);

}  // namespace limn
