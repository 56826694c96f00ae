#pragma once

#include "ecs/base/math.h"
#include "ecs/base/rng.h"
#include "ecs/components/particles.h"
#include "systems/particles/particle_collision.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Sub-emitters: particles that are born where those of another emitter, the parent, are born, fly,
// hit or die (ParticleSource).

/// The birth of a particle at one of the parent's.
struct ParticleSpawn {
    Vec3 position = {0, 0, 0};
    Vec3 velocity = {0, 0, 0};  ///< that is added to the emitter's own
    Vec3 axis = {0, 0, 0};      ///< unit: +y of the shape and directions; 0: as the emitter's
    float age = 0;              ///< at the end of the step [s]
};

/// Appends to `spawns` the births of a step, in the order of the parent's particles. Those have
/// moved already, but the dead among them are not removed yet; `hits` are sorted by their index.
/// Appends at most `room` and returns how many more there would have been. Births within the step
/// lie on the straight line along the parent particle's last velocity.
std::uint64_t find_spawns(
    const ParticleSource& source, const ParticleEmitter& emitter, const ParticlePool& parent,
    std::span<const ParticleHit> hits, float dt, std::size_t room, Random& random,
    std::vector<ParticleSpawn>& spawns);

}  // namespace limn
