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

// Births where particles of another emitter are born, fly, hit or die (ParticleSource).

/// A birth by another particle.
struct ParticleSpawn {
    Vec3 position = {0, 0, 0};
    Vec3 velocity = {0, 0, 0};  ///< that is added to the emitter's own
    Vec3 axis = {0, 0, 0};      ///< unit: +y of the shape and directions; 0: as the emitter's
    float age = 0;              ///< at the end of the step [s]
};

/// Appends to `spawns` the births in a step by the parent's particles, in their order; the parent
/// has moved, but its dead are not removed yet; `hits` are sorted by particle. At most `room`;
/// returns how many were dropped. Positions are extrapolated along the last velocity.
std::uint64_t find_spawns(
    const ParticleSource& source, const ParticleEmitter& emitter, const ParticlePool& parent,
    std::span<const ParticleHit> hits, float dt, std::size_t room, Random& random,
    std::vector<ParticleSpawn>& spawns);

}  // namespace limn
