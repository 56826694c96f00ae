#pragma once

#include "ecs/base/depth_sort.h"
#include "ecs/base/math.h"
#include "render/gpu/buffer.h"
#include "render/gpu/buffer_texture.h"
#include "render/gpu/program.h"
#include "render/graph/frame_graph.h"

#include <cstdint>
#include <optional>

namespace limn {

// Back-to-front order of an emitter's particles on the GPU: Batcher's bitonic sort (1968), a whole
// one each frame; or, after the first, a few of its passes (Latta, "Building a Million Particle
// System", GDC 2004), with the order of the last one that has ended shown meanwhile
// (particle.sort-amortised). Its keys are distances from where the camera will be halfway through
// that time if it moves on as it does, so that a steady camera finds the order half a sort old or
// young, not one to two sorts old. Particles are taken to stay where they are.

/// Particles of an emitter that may be alive: numbers in the order of births.
struct ParticleWindow {
    std::uint32_t first = 0;  ///< the oldest, low word
    std::uint32_t count = 0;
};

/// The camera that they are sorted for.
struct ParticleSortView {
    Vec3 eye = {0, 0, 0};       ///< [m]
    Vec3 forward = {0, 0, -1};  ///< unit
};

/// The view `frames` after `now`, if it goes on as from `previous`, a frame ago; `now` after a cut.
[[nodiscard]] ParticleSortView
predict_sort_view(const ParticleSortView& previous, const ParticleSortView& now, float frames);

/// What to do in a frame.
struct ParticleSortPlan {
    bool read_keys = false;
    std::uint32_t first_pass = 0;  ///< of bitonic_pass_at()
    std::uint32_t last_pass = 0;   ///< one after the last
    std::uint32_t size = 0;        ///< entries, a power of two
    float ahead = 0;               ///< half the time for which the order will be shown [frames]
};

/// The order of an emitter's particles as far as it is known.
struct GpuParticleSort {
    gpu::Buffer entries[2]{};  ///< being sorted; to be shown
    gpu::Buffer instances{};   ///< in order, as ParticleInstance
    BufferTexture texels = BufferTexture("sorted particles", GL_R32UI);  ///< of `instances`
    std::uint32_t capacity = 0;                                          ///< entries
    std::uint32_t next_pass = 0;             ///< 0: the next frame reads keys
    ParticleWindow sorting{};                ///< when keys were read
    std::optional<ParticleWindow> shown{};   ///< when the keys of the order to be shown were read
    int current = 0;                         ///< of `entries`: being sorted
    ParticleSortPlan plan{};                 ///< of this frame
    std::uint32_t count = 0;                 ///< to draw
    std::optional<ParticleSortView> view{};  ///< of the previous frame
};

/// Entries of a sort of `count` particles.
[[nodiscard]] std::uint32_t sort_size(std::uint32_t count);

/// Decides what to do for these particles; `passes`: at most so many, 0: a whole sort.
void plan_particle_sort(const ParticleWindow& now, std::uint32_t passes, GpuParticleSort& sort);

struct ParticleSortPrograms {
    const gpu::Program* keys = nullptr;
    const gpu::Program* pass = nullptr;
    const gpu::Program* local = nullptr;
    const gpu::Program* gather = nullptr;

    [[nodiscard]] static Result<ParticleSortPrograms> create(gpu::Device& device);
};

/// Does it, for the particles in `instances`.
void run_particle_sort(
    PassContext& context, const ParticleSortPrograms& programs, const ParticleWindow& now,
    const gpu::Buffer& instances, const ParticleSortView& view, GpuParticleSort& sort);

}  // namespace limn
