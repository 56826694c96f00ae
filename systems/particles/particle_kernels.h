#pragma once

#include "ecs/base/math.h"
#include "ecs/components/gpu_particles.h"
#include "ecs/components/particles.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace limn {

// The inner loops over particles, one array per scalar. Kernels have a SIMD version for the
// machine's widest vectors (Highway, dispatched at run time) and a plain C++ one, `_scalar`, which
// also handles the remainder: the same operations in the same order, so the same bits.

/// Particles [first, first + count) of a pool.
struct ParticleBlock {
    float* x;
    float* y;
    float* z;
    float* vx;
    float* vy;
    float* vz;
    float* age;
    const float* life;
    std::size_t count;

    [[nodiscard]] ParticleBlock from(std::size_t first) const;
};
[[nodiscard]] ParticleBlock
particle_block(ParticlePool& pool, std::size_t first, std::size_t count);

/// v' = air + (v + g dt - air) keep, x' = x + dt mix(v', v, old_weight), age' = age + dt: with
/// old_weight = 1/2, exact for a constant acceleration without drag (particle.integrator). Returns
/// how many have reached the end of life.
std::size_t move_particles(const ParticleBlock& block, const ParticleStep& step);
std::size_t move_particles_scalar(const ParticleBlock& block, const ParticleStep& step);

/// Gradient of value noise in [-1, 1] on the integer lattice, with quintic interpolation.
[[nodiscard]] Vec3 noise_gradient(const Vec3& at, std::uint32_t seed);
[[nodiscard]] Vec3 curl_noise(const Vec3& at, const Turbulence& turbulence);
/// v += curl_noise(x) dt
void apply_turbulence(const ParticleBlock& block, const Turbulence& turbulence, float dt);
void apply_turbulence_scalar(const ParticleBlock& block, const Turbulence& turbulence, float dt);

/// v += dt (around * tangent - toward * radial), with the unit vectors around and away from the
/// axis; no change on the axis itself.
void apply_vortex(const ParticleBlock& block, const Vortex& vortex, float dt);

/// v' = mix(v / |v|, tangent, orbit) max(|v| - loss, 0); v' = 0 at rest, orbit = 0 on the axis.
void apply_steering(const ParticleBlock& block, const Steering& steering);
/// Wraps particles that have left the box of extents `size` about `center` to the opposite side
/// (engine.space-dust); an extent of 0 is unbounded.
void wrap_particles(const ParticleBlock& block, const Vec3& center, const Vec3& size);
void wrap_particles_scalar(const ParticleBlock& block, const Vec3& center, const Vec3& size);

}  // namespace limn
