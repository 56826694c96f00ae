#pragma once

#include "ecs/components/gpu_particles.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/particle_mesh.h"
#include "ecs/components/particle_surface.h"
#include "ecs/components/particles.h"
#include "ecs/components/trail.h"
#include "ecs/components/transform.h"
#include "ecs/components/water_spray.h"
#include "ecs/param_group.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "systems/particles/particle_collision.h"
#include "systems/particles/particle_deaths.h"
#include "systems/particles/particle_sources.h"
#include "systems/particles/step_context.h"
#include "systems/particles/surface_births.h"

#include <cstdint>
#include <vector>

namespace limn {

// The emitters of a step and what each needs for it (particle_system.h).

using EmitterQuery = Query<
    const ParticleEmitter, Optional<const ParticleMotion>, const WorldTransform,
    const PreviousWorldTransform, Optional<const SprayDrops>, Optional<const ParticleSource>,
    Optional<const ParticleSurface>, Optional<const ParticleMesh>,
    Optional<const ParticleCollision>, Optional<const ParticleWrap>, Optional<const ParticleLook>,
    Optional<const ParticleLight>, ParticlePool>;

/// Emitters on the GPU that are born by the particles of others.
using GpuChildren = Query<const ParticleEmitter, const ParticleSource, GpuParticles>;

/// The components that refer to the particles of an emitter, as one parameter of a system.
struct ParticleFollowers {
    Query<const ParticleSource> sources;
    Query<const Trail> trails;
    GpuChildren gpu_children;
};
template <>
struct SystemParam<ParticleFollowers>
    : ParamGroup<ParticleFollowers, Query<const ParticleSource>, Query<const Trail>, GpuChildren> {
};

/// Surfaces that particles are born on, as one parameter of a system.
struct BirthSurfaces {
    MeshQuery meshes;
    Query<const Pose> poses;
    Query<const MorphWeights> morphs;
    Res<const Assets> assets;
};
template <>
struct SystemParam<BirthSurfaces> : ParamGroup<
                                        BirthSurfaces, MeshQuery, Query<const Pose>,
                                        Query<const MorphWeights>, Res<const Assets>> {};

/// The components of an emitter; those that may be null are optional.
struct EmitterRow {
    Entity entity{};
    const ParticleEmitter* emitter = nullptr;
    const ParticleMotion* motion = nullptr;
    const WorldTransform* now = nullptr;
    const PreviousWorldTransform* previous = nullptr;
    const SprayDrops* drops = nullptr;
    const ParticleSource* source = nullptr;
    const ParticleSurface* surface = nullptr;
    const ParticleMesh* mesh = nullptr;
    const ParticleCollision* collision = nullptr;  ///< null if particles wrap
    const ParticleWrap* wrap = nullptr;
    ParticlePool* pool = nullptr;
    OrderedBy order{};

    [[nodiscard]] std::uint64_t subject() const { return subject_of(*emitter, entity); }
};

inline constexpr std::uint32_t kNoParent = 0xffffffff;

/// An emitter with the inputs and results of its step.
struct EmitterStep {
    EmitterRow row{};
    EmitterPose pose{};
    MotionStep motion{};
    SurfaceSource surface{};
    float rate_scale = 1;
    std::uint32_t parent = kNoParent;     ///< index of the emitter that row.source refers to
    std::vector<ParticleHit> hits{};      ///< of its particles in this step
    std::vector<ParticleSpawn> spawns{};  ///< births by the particles of its parent

    [[nodiscard]] bool sticks() const {
        return row.collision != nullptr && row.collision->action == CollisionAction::Stick;
    }
};

/// Without its surface.
[[nodiscard]] EmitterStep
make_emitter_step(const EmitterRow& row, const MotionStep& motion, const StepContext& context);

/// The emitters of a step, grouped by how they are simulated.
struct EmitterSteps {
    /// Few particles that hit nothing, and that no other emitter depends on.
    std::vector<EmitterRow> independent{};
    std::vector<EmitterStep> others{};
    std::vector<std::uint32_t> children{};  ///< of `others`, those with a ParticleSource
};

/// `may_hit`: whether there is anything that particles may hit.
[[nodiscard]] EmitterSteps find_emitter_steps(
    EmitterQuery& emitters, const ParticleFollowers& followers, const BirthSurfaces& surfaces,
    bool may_hit, const StepContext& context);

/// Births by the clock of the emitter, by its bursts and by drops of spray, after those of its
/// prewarming. None if it has a ParticleSource.
void emit_particles(EmitterStep& step, const StepContext& context);

/// Removes the dead particles from `first` on; keeps the order if something depends on it.
void remove_dead(const EmitterRow& row, std::size_t first);

}  // namespace limn
