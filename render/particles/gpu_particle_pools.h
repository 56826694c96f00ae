#pragma once

#include "ecs/components/gpu_particles.h"
#include "ecs/entity.h"
#include "render/frame_data.h"
#include "render/gpu/buffer.h"
#include "render/gpu/buffer_texture.h"
#include "render/gpu/program.h"
#include "render/particles/gpu_particle_sort.h"
#include "render/particles/previous_depth.h"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace limn {

struct ParticleCollision;
struct ParticleEmitter;
class World;

// Particles that the GPU moves (particle.gpu-state, particle.gpu-update): for each emitter a ring
// of slots, 36 bytes each, that particle_update.comp brings up to date with the steps that the
// systems have recorded (systems/particles/gpu_particle_system.h), and a list of what to draw,
// oldest first.
//
// Where a million are too many, only every `stride`th particle by its number is simulated and
// drawn. A larger stride keeps a part of those; for a smaller one all recorded steps are simulated
// again.

/// Where the parts of the texels of steps begin.
struct ParticleStepTexels {
    int steps = 0;      ///< how many
    int runs = 0;       ///< texel of the first run of births
    int forces = 0;     ///< texel of the first force
    int colliders = 0;  ///< texel of the first collider
};

struct GpuParticlePool {
    gpu::Buffer state{};      ///< two vec4 a slot
    gpu::Buffer bits{};       ///< a word a slot
    gpu::Buffer instances{};  ///< as ParticleInstance
    BufferTexture steps = BufferTexture("particle steps", GL_RGBA32F);
    BufferTexture texels = BufferTexture("particles", GL_R32UI);  ///< of `instances`
    std::uint32_t capacity = 0;
    std::uint64_t done = 0;  ///< number of the first step that is not done

    // Of this frame.
    bool used = false;
    std::uint32_t look = 0;
    std::uint32_t stride = 1;  ///< a power of two
    std::uint32_t first = 0;   ///< number of the oldest particle, low word
    std::uint32_t count = 0;   ///< to move and draw
    ParticleStepTexels layout{};
    bool sorted = false;
    GpuParticleSort sort{};
    bool closed_form = false;  ///< states are those of birth
    Vec3 gravity = {0, 0, 0};  ///< of the last step [m/s^2]
    std::uint32_t old = 0;     ///< of `count`, born before the steps to do
    /// The one step to do, if nothing but gravity and drag moves them in it.
    std::optional<ParticleStep> plain{};
    float collide_depth = 0;  ///< as ParticleCollision::collide_depth
};

/// The stride that leaves this fraction of the particles, or less: 1 .. 1024.
[[nodiscard]] std::uint32_t particle_stride(float fraction);

/// The instant and the camera that they are drawn for.
struct GpuParticleView {
    float back = 0;             ///< before the end of the last step [s]
    Vec3 eye = {0, 0, 0};       ///< [m]
    Vec3 forward = {0, 0, -1};  ///< unit
    PreviousDepth depth{};      ///< what those with a collide_depth collide with
};

/// The texels of the steps from `from` on, as particle_gpu.h has them, without those that `from` is
/// beyond. `collision`: null: they do not collide.
[[nodiscard]] std::vector<Vec4> pack_particle_steps(
    const ParticleEmitter& emitter, const ParticleCollision* collision,
    const GpuParticles& particles, std::uint64_t from, ParticleStepTexels& layout);

class GpuParticlePools {
  public:
    [[nodiscard]] static Result<GpuParticlePools> create(gpu::Device& device);

    /// Before those of a frame are added: drops all pools of another world, or of one that was
    /// reloaded.
    void begin_frame(const World& world);
    /// An emitter's particles, every `stride`th, drawn with the look of this number. `sort_passes`:
    /// none: as they were born; 0: sorted; otherwise so many passes of a sort.
    void
    add(FrameData& frame, Entity entity, const ParticleEmitter& emitter,
        const GpuParticles& particles, std::uint32_t look,
        std::optional<std::uint32_t> sort_passes = std::nullopt,
        const ParticleCollision* collision = nullptr, std::uint32_t stride = 1);
    /// After they have been added: drops all others.
    void drop_unused();
    /// Adds the passes that move and sort them, once in a frame.
    void update(FrameGraph& graph, const GpuParticleView& view);
    /// Whether some of this frame collide with the depth of the previous one.
    [[nodiscard]] bool meets_depth() const;

    [[nodiscard]] const std::map<std::uint64_t, std::unique_ptr<GpuParticlePool>>& pools() const {
        return pools_;
    }

  private:
    bool can_sort(gpu::Device& device);
    bool can_meet_depth(gpu::Device& device);

    /// For those born in the steps to do; those born before; those that collide with depth,
    /// likewise, loaded when there are some; those of a plain step.
    struct Programs {
        const gpu::Program* births = nullptr;
        const gpu::Program* old = nullptr;
        const gpu::Program* depth_births = nullptr;
        const gpu::Program* depth_old = nullptr;
        const gpu::Program* plain = nullptr;
    };
    void move(gpu::Device& device, const GpuParticlePool& pool, float back, bool has_depth) const;

    Programs programs_{};
    std::optional<ParticleSortPrograms> sort_programs_{};  ///< compiled when something is sorted
    std::uint32_t epoch_ = 0;                              ///< of the world
    bool updated_ = false;                                 ///< in this frame
    std::map<std::uint64_t, std::unique_ptr<GpuParticlePool>> pools_{};  ///< by entity
};

}  // namespace limn
