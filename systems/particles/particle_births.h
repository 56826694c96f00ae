#pragma once

#include "ecs/base/math.h"
#include "ecs/base/rng.h"
#include "ecs/components/gpu_particles.h"
#include "ecs/components/particles.h"
#include "ecs/components/water_spray.h"
#include "systems/particles/particle_sources.h"
#include "systems/particles/surface_births.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace limn {

// When and where particles are born. All random numbers are keyed by the emitter and the number of
// the birth, so they depend neither on the frame rate nor on what else is born.

/// How many more particles the capacity admits while `window` of them count as alive
/// (particle.linear-window).
[[nodiscard]] std::size_t
birth_room(const ParticleEmitter& emitter, std::uint64_t window, const EmitterClock& clock);

/// Whether a step certainly has no births: then find_births would only advance the clock by `dt`.
[[nodiscard]] bool
has_no_births(const ParticleEmitter& emitter, float dt, const EmitterClock& clock);

/// The births of a step: those of the rate in equal intervals that go on across steps, then those
/// of bursts. Advances the clock. `random` is for the spreads; `scale` is a factor on the rate. At
/// most `room` births; the others are added to `clock.dropped`.
void find_births(
    const ParticleEmitter& emitter, float scale, float dt, std::size_t room, Random& random,
    EmitterClock& clock, std::vector<BirthRun>& births);

/// Fraction 0 .. 1 of a 16 : 9 image that a ball in its center covers at `distance`, with the
/// vertical field of view `fov_y` [rad]; 1 from inside.
[[nodiscard]] float screen_coverage(float radius, float distance, float fov_y);

/// Adds a particle for every drop that waves have thrown up in this step (water.crest-spray,
/// water.impact-spray), at a random instant of the step; lifetimes are the emitter's. Drops over
/// capacity are counted in `clock.dropped`.
void add_drops(
    const ParticleEmitter& emitter, const std::vector<SprayDrop>& drops, const ParticleStep& step,
    std::uint64_t seed, std::uint64_t subject, ParticlePool& pool);

/// The part of the emitter's own velocity that is added at birth [m/s].
[[nodiscard]] Vec3
inherited_velocity(const ParticleEmitter& emitter, const EmitterPose& pose, float dt);

/// Adds a particle for every birth, where the emitter is at that instant, or on `surface` unless it
/// is null. Particles are moved back in time, so that a whole step brings them to where they should
/// be. If nothing can be born on the surface, the births are added to `clock.dropped`.
void add_particles(
    const ParticleEmitter& emitter, const EmitterPose& pose, const ParticleStep& step,
    const SurfaceSource* surface, std::uint64_t seed, std::uint64_t subject,
    const std::vector<BirthRun>& births, ParticlePool& pool);

/// Adds a particle for every birth by another one (ParticleSource), where it is at the end of the
/// step. `world` turns and scales the emitter's shape.
void add_spawns(
    const ParticleEmitter& emitter, const Affine& world, const std::vector<ParticleSpawn>& spawns,
    std::uint64_t seed, std::uint64_t subject, ParticlePool& pool);

// ---- places of births on the GPU, which draws the rest itself

/// Those of births `first`, `first` + 1 ... on a surface; empty if nothing can be born there.
[[nodiscard]] std::vector<GpuBirthPlace> place_on_surface(
    const SurfaceSource& surface, float dt, std::uint64_t seed, std::uint64_t subject,
    std::uint64_t first, const std::vector<BirthRun>& births);

/// Those of at most `room` drops; the others are added to `clock.dropped`.
void place_drops(
    const ParticleEmitter& emitter, const std::vector<SprayDrop>& drops, std::size_t room,
    EmitterClock& clock, std::vector<GpuBirthPlace>& places);

[[nodiscard]] GpuBirthPlace place_spawn(const ParticleSpawn& spawn);

}  // namespace limn
