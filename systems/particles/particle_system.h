#pragma once

#include "ecs/commands.h"
#include "ecs/components/particles.h"
#include "ecs/query.h"
#include "systems/particles/emitter_step.h"
#include "systems/particles/particle_contacts.h"
#include "systems/particles/step_context.h"

namespace limn {

// Births, motion and deaths of particles (particle.system), after Reeves (1983): new particles are
// born and get their attributes, all move, the dead are removed. A step runs in phases, each of
// them parallel over emitters or over blocks of 1,024 particles:
//
//     emit       births by rate, bursts and spray
//     move       motion and collisions; hits are recorded
//     ripple     hits on water
//     spawn      what particles of a parent give birth to: recorded, while its dead are still there
//     retire     the dead are removed
//     add        the recorded births
//
// An emitter of few particles that hit nothing and that no other emitter depends on does its whole
// step at once. Results do not depend on the number of threads.
//
// Particles are neither entities nor rows of archetypes but arrays of a component of their emitter:
// nothing refers to one particle, so handles and change versions would only cost memory and time;
// and a pool is saved, hashed, copied and freed with its emitter.

/// Adds a ParticlePool to every ParticleEmitter that runs on the CPU and lacks one, and takes it
/// from the others. Before update_particles, with a sync point in between.
void add_particle_pools(
    Query<const ParticleEmitter, Without<ParticlePool>> emitters,
    Query<const ParticleEmitter, const ParticlePool> pools, Commands commands);

/// A step of all particles; the ripples that they leave in water count from the next step on. After
/// update_transforms and find_particle_obstacles.
void update_particles(
    EmitterQuery emitters, ParticleFollowers followers, BirthSurfaces birth_surfaces,
    ContactSurfaces contact_surfaces, ParticleEnvironment environment);

}  // namespace limn
