#pragma once

#include "ecs/commands.h"
#include "ecs/components/camera.h"
#include "ecs/components/force_field.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/particles.h"
#include "ecs/components/time.h"
#include "ecs/components/trail.h"
#include "ecs/components/transform.h"
#include "ecs/components/water_ripples.h"
#include "ecs/components/water_spray.h"
#include "ecs/components/weather.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "systems/particles/particle_obstacles.h"
#include "systems/particles/surface_births.h"
#include "systems/water/water_query.h"

#include <cstdint>

namespace limn {

// Births, motion and deaths of particles (particle.system), in Reeves' order: new ones are born and
// get their attributes, all move, those whose time is up go. Bits do not depend on the number of
// threads: blocks of 1,024 particles move, pools lose their dead. An emitter of few particles that
// meet nothing and give birth to none does all of that at once.
//
// Particles are neither entities nor rows of archetypes but arrays of a component of their emitter:
// nothing refers to one particle, so handles and change versions would only cost memory and time;
// and a pool is saved, hashed, copied and freed with its emitter.

/// Adds a ParticlePool to every ParticleEmitter that runs on the CPU and lacks one, and takes it
/// from the others. Before update_particles, with a sync point in between.
void add_particle_pools(
    Query<const ParticleEmitter, Without<ParticlePool>> emitters,
    Query<const ParticleEmitter, const ParticlePool> pools, Commands commands);

/// A step of all particles, and the ripples that they leave in water, from the next step on. After
/// update_transforms.
void update_particles(
    Query<
        const ParticleEmitter, Optional<const ParticleMotion>, const WorldTransform,
        const PreviousWorldTransform, Optional<const SprayDrops>, Optional<const ParticleSource>,
        Optional<const ParticleSurface>, Optional<const ParticleMesh>,
        Optional<const ParticleCollision>, Optional<const ParticleWrap>,
        Optional<const ParticleLook>, Optional<const ParticleLight>, ParticlePool>
        emitters,
    Query<const ParticleSource> sources, Query<const Trail> trails, MeshQuery meshes,
    Query<const Pose> poses, Query<const MorphWeights> morphs, Res<const Assets> assets,
    Res<const ParticleObstacles> obstacles, WaterQuery waters,
    Query<const ParticleCollider> colliders, Query<RippleState> ripples,
    Query<const ForceField, const WorldTransform> fields,
    Query<const Camera, const WorldTransform> cameras, Res<const WeatherState> gusts,
    OptionalRes<const Weather> weather, Res<const RandomSeed> seed, Res<const FrameTime> time);

}  // namespace limn
