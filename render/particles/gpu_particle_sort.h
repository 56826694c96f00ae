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
// sort each frame; or, after the first one, a few passes per frame (Latta, "Building a Million
// Particle System", GDC 2004), while the order of the last finished sort is shown
// (particle.sort-amortised). The keys of such a sort are distances from the predicted position of
// the camera halfway through the time for which its order will be shown: under a steady camera the
// order is off by at most half a sort, instead of being one to two sorts old. Particles are assumed
// to stay where they are.

/// The range of an emitter's particles that may be alive, by birth number.
struct ParticleWindow {
    std::uint32_t first = 0;  ///< the oldest, low word
    std::uint32_t count = 0;
};

/// The camera that particles are sorted for.
struct ParticleSortView {
    Vec3 eye = {0, 0, 0};       ///< [m]
    Vec3 forward = {0, 0, -1};  ///< unit
};

/// Extrapolates the view by `frames` from `previous`, a frame ago, and `now`; returns `now` after a
/// cut.
[[nodiscard]] ParticleSortView
predict_sort_view(const ParticleSortView& previous, const ParticleSortView& now, float frames);

/// The work of a frame.
struct ParticleSortPlan {
    bool read_keys = false;
    std::uint32_t first_pass = 0;  ///< of bitonic_pass_at()
    std::uint32_t last_pass = 0;   ///< one after the last
    std::uint32_t size = 0;        ///< entries, a power of two
    float ahead = 0;               ///< frames to predict the view ahead
};

/// The state of sorting an emitter's particles.
struct GpuParticleSort {
    gpu::Buffer entries[2]{};  ///< one is being sorted, the other one is shown
    gpu::Buffer instances{};   ///< in order, as ParticleInstance
    BufferTexture texels = BufferTexture("sorted particles", GL_R32UI);  ///< of `instances`
    std::uint32_t capacity = 0;                                          ///< entries
    std::uint32_t next_pass = 0;             ///< 0: the next frame reads keys
    ParticleWindow sorting{};                ///< at the time the keys were read
    std::optional<ParticleWindow> shown{};   ///< the same for the order that is shown
    int current = 0;                         ///< index of the `entries` being sorted
    ParticleSortPlan plan{};                 ///< of this frame
    std::uint32_t count = 0;                 ///< to draw
    std::optional<ParticleSortView> view{};  ///< of the previous frame
};

/// Number of entries in a sort of `count` particles.
[[nodiscard]] std::uint32_t sort_size(std::uint32_t count);

/// Plans the work of this frame; `passes`: maximum number of passes, 0: a whole sort.
void plan_particle_sort(const ParticleWindow& now, std::uint32_t passes, GpuParticleSort& sort);

struct ParticleSortPrograms {
    const gpu::Program* keys = nullptr;
    const gpu::Program* pass = nullptr;
    const gpu::Program* local = nullptr;
    const gpu::Program* gather = nullptr;

    [[nodiscard]] static Result<ParticleSortPrograms> create(gpu::Device& device);
};

/// Sorts `size` = sort_size() entries, key and index, that are bound to kSortEntriesBinding.
void sort_entries(gpu::Device& device, const ParticleSortPrograms& programs, std::uint32_t size);

/// Executes the plan for the particles in `instances`.
void run_particle_sort(
    PassContext& context, const ParticleSortPrograms& programs, const ParticleWindow& now,
    const gpu::Buffer& instances, const ParticleSortView& view, GpuParticleSort& sort);

}  // namespace limn
