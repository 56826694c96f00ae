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
#include <utility>
#include <vector>

namespace limn {

struct ParticleBalls;
struct ParticleCollision;
struct ParticleEmitter;
class World;

// Particles that the GPU moves (particle.gpu-state, particle.gpu-update): for each emitter a ring
// of slots, 36 bytes each, to which particle_update.comp applies the steps that the systems have
// recorded (systems/particles/gpu_particle_system.h), and a list of instances to draw, oldest
// first.
//
// To scale the cost down, only every `stride`th particle by number is simulated and drawn. A larger
// stride keeps a subset of those; for a smaller one all recorded steps are simulated again.
//
// Steps of balls that bump into each other take dozens of dispatches each. In a window
// (FrameRequest::paced) those of a pool that starts over are spread over frames: it shows its past
// in fast motion until it has caught up, and then, if none of its balls has died meanwhile, the
// same bits as if it had never been behind.

/// Layout of the texels of steps.
struct ParticleStepTexels {
    int steps = 0;            ///< number of steps
    int runs = 0;             ///< texel of the first run of births
    int forces = 0;           ///< texel of the first force
    int colliders = 0;        ///< texel of the first collider
    int places = 0;           ///< texel of the first place of a birth
    bool has_shapes = false;  ///< some colliders are height fields or meshes
};

/// What balls that bump into each other need (particle_balls.comp).
struct GpuBalls {
    gpu::Buffer entries{};    ///< key and index of each
    gpu::Buffer near{};       ///< neighbors of each
    gpu::Buffer motion[2]{};  ///< positions and velocities, read and written in turn
    std::uint32_t size = 0;   ///< entries
    std::uint32_t slots = 0;  ///< of near and motion
    float radius = 0;         ///< of this frame [m]; 0: none
    float bounce = 0;
    float wall_radius = -1;  ///< against colliders [m]; < 0: they hit none
    /// Of each step to simulate: particles from the oldest on that are born, and its length [s].
    std::vector<std::pair<std::uint32_t, float>> steps{};
};

struct GpuParticlePool {
    gpu::Buffer state{};      ///< two vec4 a slot
    gpu::Buffer bits{};       ///< a word a slot
    gpu::Buffer instances{};  ///< as ParticleInstance
    BufferTexture steps = BufferTexture("particle steps", GL_RGBA32F);
    BufferTexture texels = BufferTexture("particles", GL_R32UI);  ///< of `instances`
    std::uint32_t capacity = 0;
    std::uint64_t done = 0;  ///< number of the first step that is not simulated yet
    std::uint64_t seen = 0;  ///< steps that were recorded in the last frame; 0: starts over

    // Of this frame.
    bool used = false;
    std::uint32_t look = 0;
    std::uint32_t stride = 1;  ///< a power of two
    std::uint32_t first = 0;   ///< number of the oldest particle, low word
    std::uint32_t count = 0;   ///< number of particles to move and draw
    ParticleStepTexels layout{};
    bool sorted = false;
    GpuParticleSort sort{};
    bool closed_form = false;  ///< states are those at birth
    Vec3 gravity = {0, 0, 0};  ///< of the last step [m/s^2]
    std::uint32_t old = 0;     ///< number of particles born before the steps to simulate
    /// The step to simulate, if it is the only one and has only gravity and drag.
    std::optional<ParticleStep> plain{};
    std::optional<Steering> steering{};  ///< if that step has it, too
    float collide_depth = 0;             ///< as ParticleCollision::collide_depth
    GpuBalls balls{};
};

/// The smallest power of two, up to 1024, that leaves at most this fraction of the particles.
[[nodiscard]] std::uint32_t particle_stride(float fraction);

/// The time and the camera that particles are drawn for.
struct GpuParticleView {
    float back = 0;             ///< time before the end of the last step [s]
    Vec3 eye = {0, 0, 0};       ///< [m]
    Vec3 forward = {0, 0, -1};  ///< unit
    PreviousDepth depth{};      ///< for particles with a collide_depth
};

/// The shapes of all colliders, each at a place of its own in a buffer.
class GpuShapeList {
  public:
    /// Before the emitters of a frame: drops shapes that the previous frame did not use, if any
    /// were new in it.
    void begin_frame();
    /// The first texel of a shape. 0 if it is null.
    [[nodiscard]] std::uint32_t find_or_add(const GpuShape& shape);
    /// Uploads new ones; all of them if the buffer has to grow.
    void upload();
    void bind(gpu::Device& device) const;
    /// Texels uploaded so far.
    [[nodiscard]] std::uint64_t uploaded() const { return uploaded_; }

  private:
    struct Entry {
        GpuShape shape{};
        std::uint32_t first = 0;
        bool used = false;
        bool is_new = true;  ///< not in the buffer yet
    };
    std::vector<Entry> entries_{};  ///< by their places
    bool has_grown_ = false;        ///< since the beginning of the frame
    std::uint64_t uploaded_ = 0;
    std::uint32_t capacity_ = 0;  ///< of the buffer [texels]
    gpu::Buffer buffer_{};
    BufferTexture texels_ = BufferTexture("particle shapes", GL_RGBA32F);
};

/// Packs at most `max_steps` of the recorded steps, from number `from` on, into texels, laid out as
/// in particle_gpu.h.
/// `collision` is null if the particles do not collide.
[[nodiscard]] std::vector<Vec4> pack_particle_steps(
    const ParticleEmitter& emitter, const ParticleCollision* collision,
    const GpuParticles& particles, std::uint64_t from, std::size_t max_steps, GpuShapeList& shapes,
    ParticleStepTexels& layout);

class GpuParticlePools {
  public:
    [[nodiscard]] static Result<GpuParticlePools> create(gpu::Device& device);

    /// Before the emitters of a frame are added: drops all pools if the world is another one or was
    /// reloaded.
    void begin_frame(const World& world);
    /// Adds every `stride`th particle of an emitter, drawn with look number `look`. `sort_passes`:
    /// none: in the order of births; 0: a whole sort; otherwise that many passes of a sort.
    /// `paced`: a pool of balls that is behind catches up in several frames.
    void
    add(FrameData& frame, Entity entity, const ParticleEmitter& emitter,
        const GpuParticles& particles, std::uint32_t look,
        std::optional<std::uint32_t> sort_passes = std::nullopt,
        const ParticleCollision* collision = nullptr, std::uint32_t stride = 1,
        const ParticleBalls* balls = nullptr, bool paced = false);
    /// After all emitters have been added: drops the pools of others.
    void drop_unused();
    /// Adds the passes that move and sort the particles; only the first call in a frame counts.
    void update(FrameGraph& graph, const GpuParticleView& view);
    /// Whether some particles of this frame collide with the depth of the previous frame.
    [[nodiscard]] bool collides_with_depth() const;

    [[nodiscard]] const std::map<std::uint64_t, std::unique_ptr<GpuParticlePool>>& pools() const {
        return pools_;
    }

  private:
    bool can_sort(gpu::Device& device);

    /// Programs for particles born during the steps to simulate and for those born before.
    struct Programs {
        const gpu::Program* births = nullptr;
        const gpu::Program* old = nullptr;
    };
    /// Those that collide with shapes or with depth are loaded when they are first needed; null if
    /// they cannot be.
    const Programs* find_programs(gpu::Device& device, bool has_shapes, bool has_depth);
    /// Moves particles of all steps, or those of a step alone.
    void move(
        gpu::Device& device, const GpuParticlePool& pool, float back, bool has_depth,
        int only_step = -1);
    bool can_collide_balls(gpu::Device& device);
    /// Step by step, with the collisions of balls after each.
    void move_balls(gpu::Device& device, GpuParticlePool& pool, float back, bool has_depth);

    Programs programs_[2][2]{};              ///< by whether they collide with shapes, with depth
    const gpu::Program* plain_ = nullptr;    ///< for steps with only gravity and drag
    const gpu::Program* steered_ = nullptr;  ///< and steering
    GpuShapeList shapes_{};

    struct BallPrograms {
        const gpu::Program* keys = nullptr;
        const gpu::Program* near = nullptr;
        const gpu::Program* mutual = nullptr;
        const gpu::Program* push[2]{};  ///< by whether some colliders are shapes
        const gpu::Program* speed = nullptr;
        const gpu::Program* apply = nullptr;
    };
    BallPrograms ball_programs_{};                         ///< loaded when they are first needed
    std::optional<ParticleSortPrograms> sort_programs_{};  ///< compiled when something is sorted
    std::uint32_t epoch_ = 0;                              ///< of the world
    bool updated_ = false;                                 ///< in this frame
    std::map<std::uint64_t, std::unique_ptr<GpuParticlePool>> pools_{};  ///< by entity
};

}  // namespace limn
