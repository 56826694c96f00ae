#pragma once

#include "ecs/base/math.h"
#include "ecs/components/particles.h"
#include "render/buffer_texture.h"
#include "render/particle_packing.h"
#include "render/shaders/particle_gpu.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Particles and their looks as shaders read them (particle_gpu.h).

static_assert(sizeof(ParticleInstance) == 16 * layout::kParticleTexels);

/// The record of a look in particle_gpu.h.
using LookRecord = std::array<Vec4, layout::kLookTexels>;

/// `layer`: of the texture array that its image is in; -1: a soft disc.
[[nodiscard]] LookRecord make_look_record(const ParticleLook& look, int layer);

/// Appends the particles that exist `back` seconds before the end of the step, where they are then.
/// Streaks show velocities relative to `observer` [m/s].
void append_particles(
    const ParticlePool& pool, std::uint32_t look, float back,
    std::vector<ParticleInstance>& instances, const Vec3& observer = {0, 0, 0});

/// Distance of its corners from its middle [m] at most, if its size is in meters and it is no
/// streak.
[[nodiscard]] float reach_of(const ParticleInstance& instance, const LookRecord& look);

/// Particles that follow one another in the order and have images of one texture array.
struct ParticleRun {
    std::uint32_t array = 0;  ///< of ImagePool
    int first = 0;
    int count = 0;
};

/// All that is drawn but what the GPU moves, for effects that draw it once more; published in
/// collect(), until the end of the frame.
struct ParticleSprites {
    std::span<const ParticleInstance> instances;
    std::span<const LookRecord> looks;
    std::span<const std::uint32_t> arrays;  ///< of each look's image, in ImagePool
    const BufferTexture* look_texels = nullptr;
};

}  // namespace limn
