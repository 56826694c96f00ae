#pragma once

#include "ecs/base/math.h"
#include "ecs/base/rng.h"
#include "ecs/components/force_field.h"
#include "ecs/components/particles.h"
#include "ecs/reflect.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace limn {

// Particles that the GPU moves (particle.gpu-state, particle.circular-list). The systems decide
// when and how many are born and what moves them, and record it step by step; whenever the renderer
// draws, the GPU simulates all recorded steps that it has not done yet
// (render/particles/gpu_particle_pools.h). Every living particle was born in a step that is still
// recorded, so the GPU can start over at any time.
// Techniques: particle.circular-list, particle.gpu-init, particle.gpu-state, particle.gpu-update,
//     particle.gpu-update-mrt, particle.million

/// What moves all particles of an emitter alike in a step.
struct ParticleStep {
    Vec3 gravity = {0, 0, 0};  ///< acceleration [m/s^2]
    Vec3 air = {0, 0, 0};      ///< velocity that drag leads to [m/s]
    float keep = 1;  ///< fraction of the velocity relative to the air that is left: exp(-drag dt)
    float dt = 0;    ///< [s]
    float old_weight = 0.5f;  ///< of the old velocity against the new one in the change of position
    bool closed_form = false;  ///< positions follow from births and ages

    [[nodiscard]] float old_dt() const { return dt * old_weight; }
    [[nodiscard]] float new_dt() const { return dt - old_dt(); }
};

/// Curl noise (Bridson et al. 2007 in the form grad a x grad b, which is free of divergence).
struct Turbulence {
    float strength = 1;  ///< acceleration [m/s^2], about its root mean square
    float size = 1;      ///< extent of a whirl [m]
    Vec3 drift_a = {
        0, 0, 0};  ///< of the two fields, in whirls: their relative motion changes the whirls
    Vec3 drift_b = {0, 0, 0};
    std::uint32_t seed = 0;
};

/// Accelerations around an axis and toward it.
struct Vortex {
    Vec3 origin = {0, 0, 0};
    Vec3 axis = {0, 1, 0};  ///< unit
    float around = 0;       ///< [m/s^2]
    float toward = 0;       ///< [m/s^2]
};

/// Turns directions into circles around an axis, and takes speed (particle.gpu-update).
struct Steering {
    Vec3 origin = {0, 0, 0};
    Vec3 axis = {0, 1, 0};  ///< unit
    float orbit = 0;        ///< 0 .. 1
    float loss = 0;         ///< [m/s]
};

/// A ForceField at an instant, in world space.
struct Force {
    ForceKind kind = ForceKind::Push;
    Vec3 origin = {0, 0, 0};
    Vec3 axis = {0, 1, 0};  ///< unit
    float strength = 0;     ///< as ForceField::strength
    float speed = 0;        ///< along the axis [m/s]
    float radius = 0;       ///< [m]; 0: unbounded
};

/// What moves the particles of an emitter in a step: a ParticleMotion at an instant.
struct MotionStep {
    ParticleStep step{};
    Turbulence turbulence{};
    Vortex vortex{};
    Steering steering{};
    std::vector<Force> forces{};  ///< of the fields around
    float force_scale = 1;
    Vec3 wrap_center = {0, 0, 0};
    Vec3 wrap_size = {0, 0, 0};  ///< as ParticleWrap; 0: none [m]
};

/// Births at equal intervals.
struct BirthRun {
    float first = 0;    ///< instant, as a fraction 0 .. 1 of the step
    float spacing = 0;  ///< likewise
    std::uint32_t count = 0;

    [[nodiscard]] float at(std::uint32_t i) const {
        return std::clamp(first + static_cast<float>(i) * spacing, 0.0f, 1.0f);
    }
};

/// The transforms of an emitter at both ends of a step.
struct EmitterPose {
    Affine before;
    Affine now;
};

enum class GpuColliderKind : std::uint32_t { Plane, Sphere, Box, Heights, Mesh };

/// The heights of a field or the triangles of a mesh, as the GPU reads them
/// (systems/particles/gpu_shapes.h). Steps share it while it does not change.
using GpuShape = std::shared_ptr<const std::vector<Vec4>>;

/// What the GPU's particles hit in a step, in world space. Water is for the CPU.
struct GpuCollider {
    GpuColliderKind kind = GpuColliderKind::Plane;
    Vec4 rows[3] = {};      ///< plane: normal, offset [m]; sphere: center, radius [m], then 1 if
                            ///< it is hollow; box, mesh: of the matrix box_from_world or
                            ///< shape_from_world; heights: origin, then size of a cell [m]
    Vec3 half = {0, 0, 0};  ///< of a box [m]; of heights: points along x and z; of a mesh: number
                            ///< of nodes, largest coordinate [m]
    GpuShape shape{};       ///< of heights and meshes
};

/// How a birth is made whose place is not the emitter's.
enum class GpuBirthKind : std::uint32_t {
    None,     ///< it is not: where a volume has no point
    Surface,  ///< the emitter's shape at a point of a ParticleSurface, at its instant of the step
    Spawn,    ///< at a particle of another emitter, at the end of the step (ParticleSource)
    Turned,   ///< likewise, with the shape turned
    Drop,     ///< a drop of spray, at a random instant of the step
};

/// The place of a birth.
struct GpuBirthPlace {
    GpuBirthKind kind = GpuBirthKind::None;
    Vec3 position = {0, 0, 0};  ///< in world space [m]
    Vec3 velocity = {0, 0, 0};  ///< that is added; of a drop all of it [m/s]
    Quat turn = {1, 0, 0, 0};   ///< of the emitter's shape: of Surface and Turned
    float age = 0;              ///< at the end of the step: of Spawn and Turned [s]
};

/// A step for the GPU.
struct GpuParticleStep {
    std::uint64_t first = 0;  ///< number of its first birth, of all time
    std::uint32_t count = 0;  ///< births
    std::vector<BirthRun> births{};
    std::vector<GpuBirthPlace> places{};  ///< of its last births
    EmitterPose pose{};
    Vec3 inherited = {0, 0, 0};  ///< velocity that is added at birth [m/s]
    MotionStep motion{};
    std::vector<GpuCollider> colliders{};  ///< none if its particles do not collide
};

/// Particles born in one step.
struct ParticleCohort {
    std::uint64_t first = 0;  ///< number of the first
    double born = 0;          ///< end of that step, on the clock of GpuParticles [s]
};

/// Beside a ParticleEmitter that runs on the GPU, instead of a ParticlePool. Particle n is in slot
/// n modulo the capacity.
struct GpuParticles {
    EmitterClock clock{};
    double time = 0;                        ///< of all steps [s]
    std::vector<ParticleCohort> cohorts{};  ///< those that may live, oldest first
    std::vector<GpuParticleStep> steps{};   ///< the first `expired` of them are no longer needed
    std::size_t expired = 0;
    std::vector<GpuBirthPlace> spawns{};  ///< by particles of another emitter in this step
    std::uint64_t step = 0;               ///< number of the step after the last of `steps`
    PhiloxCounter counter{};  ///< of the attributes of the oldest particle; its number counts
    PhiloxKey key{};          ///< likewise

    [[nodiscard]] std::span<const GpuParticleStep> kept() const {
        return std::span(steps).subspan(expired);
    }
    /// The oldest particle that may be alive.
    [[nodiscard]] std::uint64_t oldest() const {
        return cohorts.empty() ? clock.born : cohorts.front().first;
    }
};

/// Derived from the emitter while it runs.
template <>
struct ComponentTraits<GpuParticles> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
