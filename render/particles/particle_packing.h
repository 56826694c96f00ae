#pragma once

#include "ecs/base/math.h"
#include "ecs/components/particles.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace limn {

// Packs the instances of particles for the vertex shader: 28 bytes from nine arrays, every frame.
// There is a SIMD version for the machine's widest vectors (Highway, dispatched at run time) and a
// plain one.

/// The words of kParticleWords in particle_gpu.h.
struct ParticleInstance {
    Vec3 position;
    std::uint32_t look_and_life = 0;   ///< look in the high half; fraction of the life, of 65,535
    std::uint32_t velocity_xy = 0;     ///< two halfs, the first in the low bits
    std::uint32_t velocity_z_age = 0;  ///< two halfs; a negative age: dead
    std::uint32_t random = 0;

    /// Velocity [m/s] and age [s].
    [[nodiscard]] Vec4 motion() const;
};

/// What is the same for all particles of a pool.
struct ParticlePacking {
    std::uint32_t look = 0;     ///< 0 .. 65,535
    float back = 0;             ///< time before the end of the step [s]
    Vec3 observer = {0, 0, 0};  ///< velocity that is subtracted [m/s]
};

/// Writes the particles as they are `back` seconds before the end of the step, without those not
/// born by then; `out` has room for all. Returns how many it has written.
std::size_t pack_particles(
    const ParticlePool& pool, const ParticlePacking& packing, std::span<ParticleInstance> out);
std::size_t pack_particles_scalar(
    const ParticlePool& pool, const ParticlePacking& packing, std::span<ParticleInstance> out);

}  // namespace limn
