#pragma once

#include "ecs/base/math.h"
#include "ecs/components/particles.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace limn {

// The inner loops over particles, one array per scalar. Every kernel has a SIMD version for the
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

/// What moves all particles of an emitter alike in a step.
struct ParticleStep {
    Vec3 gravity = {0, 0, 0};  ///< acceleration [m/s^2]
    Vec3 air = {0, 0, 0};      ///< velocity that drag leads to [m/s]
    float keep = 1;  ///< share of the velocity relative to the air that is left: exp(-drag dt)
    float dt = 0;    ///< [s]
};

/// v' = air + (v + g dt - air) keep, x' = x + (v + v') dt / 2, age' = age + dt. Exact for a
/// constant acceleration without drag (particle.integrator). Returns how many have reached the end
/// of life.
std::size_t move_particles(const ParticleBlock& block, const ParticleStep& step);
std::size_t move_particles_scalar(const ParticleBlock& block, const ParticleStep& step);

/// Curl noise (Bridson et al. 2007 in the form grad a x grad b, which is free of divergence).
struct Turbulence {
    float strength = 1;  ///< acceleration [m/s^2], about its root mean square
    float size = 1;      ///< extent of a whirl [m]
    Vec3 drift_a = {
        0, 0, 0};  ///< of the two fields, in whirls: their relative motion renews the whirls
    Vec3 drift_b = {0, 0, 0};
    std::uint32_t seed = 0;
};
/// Gradient of value noise in [-1, 1] on the integer lattice, with quintic interpolation.
[[nodiscard]] Vec3 noise_gradient(const Vec3& at, std::uint32_t seed);
[[nodiscard]] Vec3 curl_noise(const Vec3& at, const Turbulence& turbulence);
/// v += curl_noise(x) dt
void stir_particles(const ParticleBlock& block, const Turbulence& turbulence, float dt);
void stir_particles_scalar(const ParticleBlock& block, const Turbulence& turbulence, float dt);

/// v += dt (around * tangent - toward * radial), by the unit vectors around and away from an axis;
/// nothing on the axis itself.
struct Vortex {
    Vec3 origin = {0, 0, 0};
    Vec3 axis = {0, 1, 0};  ///< unit
    float around = 0;       ///< [m/s^2]
    float toward = 0;       ///< [m/s^2]
};
void whirl_particles(const ParticleBlock& block, const Vortex& vortex, float dt);

/// Puts particles that have left the box of extents `size` about `center` in at the other side
/// (engine.space-dust); an extent of 0 is unbounded.
void wrap_particles(const ParticleBlock& block, const Vec3& center, const Vec3& size);
void wrap_particles_scalar(const ParticleBlock& block, const Vec3& center, const Vec3& size);

/// Removes the particles with age >= life from `first` on; the others keep their order. Returns how
/// many are left.
std::size_t remove_dead(ParticlePool& pool, std::size_t first);
std::size_t remove_dead_scalar(ParticlePool& pool, std::size_t first);

}  // namespace limn
