#include "systems/particles/gpu_particle_system.h"

#include "systems/particles/emitter_pose.h"
#include "systems/particles/particle_births.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

// Techniques: particle.circular-list, particle.gpu-init, particle.gpu-state, particle.gpu-update,
//     particle.gpu-update-mrt, particle.linear-window, particle.million

namespace limn {
namespace {

constexpr double kMemory = 60;  // how long steps are kept, if particles live that long [s]
constexpr std::size_t kShapeMemory = 1 << 26;  // of colliders that change from step to step [bytes]

/// Drops the cohorts whose particles will all be dead at the end of the coming step, and the steps
/// that no living particle was born in.
void drop_expired(const ParticleEmitter& emitter, float dt, GpuParticles& particles) {
    const auto longest = static_cast<double>(
        finite_or(emitter.life, 0) + std::abs(finite_or(emitter.life_spread, 0)));
    const double end = particles.time;  // a step late: rounding must not drop living particles
    const auto alive = std::find_if(
        particles.cohorts.begin(), particles.cohorts.end(),
        [&](const ParticleCohort& cohort) { return end - cohort.born <= longest; });
    particles.cohorts.erase(particles.cohorts.begin(), alive);

    const double memory = std::min(longest, kMemory);
    double age = static_cast<double>(dt);
    std::size_t kept = 0;
    while (kept < particles.kept().size() && age <= memory + static_cast<double>(dt)) {
        age +=
            static_cast<double>(particles.steps[particles.steps.size() - 1 - kept].motion.step.dt);
        ++kept;
    }
    particles.expired = particles.steps.size() - kept;
    if (particles.expired > kept) {
        const auto begin = particles.steps.begin();
        particles.steps.erase(begin, begin + static_cast<std::ptrdiff_t>(particles.expired));
        particles.expired = 0;
    }
}

/// What is born in a step beside the births of the rate and of bursts, and where those are.
struct StepBirths {
    std::uint64_t seed = 0;
    std::uint64_t subject = 0;
    float scale = 1;                         ///< on the rate
    bool by_others = false;                  ///< by a ParticleSource alone
    const SurfaceSource* surface = nullptr;  ///< null: at the emitter
    const SprayDrops* drops = nullptr;       ///< or null
};

void find_step_births(
    const ParticleEmitter& emitter, const StepBirths& births, Random random, GpuParticleStep& step,
    GpuParticles& particles) {
    const float dt = step.motion.step.dt;
    const std::uint64_t window = particles.clock.born - particles.oldest();
    if (births.by_others) {
        step.places.swap(particles.spawns);
        step.count = static_cast<std::uint32_t>(step.places.size());
        return;
    }
    EmitterClock& clock = particles.clock;
    find_births(
        emitter, births.scale, dt, birth_room(emitter, window, clock), random, clock, step.births);
    for (const BirthRun& run : step.births) {
        step.count += run.count;
    }
    if (births.surface != nullptr && step.count > 0) {
        step.places = place_on_surface(
            *births.surface, dt, births.seed, births.subject, step.first, step.births);
        if (step.places.empty()) {
            clock.dropped += step.count;
            step.births.clear();
            step.count = 0;
        }
        clock.dropped += static_cast<std::uint64_t>(
            std::count_if(step.places.begin(), step.places.end(), [](const GpuBirthPlace& place) {
                return place.kind == GpuBirthKind::None;
            }));
    }
    if (births.drops != nullptr && emitter.active) {
        EmitterClock then = clock;  // after the other births
        then.born += step.count;
        const std::size_t before = step.places.size();
        place_drops(
            emitter, births.drops->drops, birth_room(emitter, window + step.count, then), clock,
            step.places);
        step.count += static_cast<std::uint32_t>(step.places.size() - before);
    }
}

/// Records a step with its births.
void record_step(
    const ParticleEmitter& emitter, const StepBirths& births, GpuParticleStep step, Random random,
    GpuParticles& particles) {
    const float dt = step.motion.step.dt;
    drop_expired(emitter, dt, particles);
    step.first = particles.clock.born;
    find_step_births(emitter, births, random, step, particles);
    particles.spawns.clear();
    particles.time += static_cast<double>(dt);
    if (step.count > 0) {
        particles.cohorts.push_back({step.first, particles.time});
    }
    particles.clock.born += step.count;
    const bool has_colliders = !step.colliders.empty();
    particles.steps.push_back(std::move(step));
    ++particles.step;
    if (has_colliders) {
        limit_shape_memory(kShapeMemory, particles.steps);
    }
}

}  // namespace

void add_gpu_particles(
    Query<const ParticleEmitter, Without<GpuParticles>> bare,
    Query<const ParticleEmitter, const GpuParticles> emitters, Commands commands) {
    bare.each([&](Entity entity, const ParticleEmitter& emitter) {
        if (runs_on_gpu(emitter)) {
            commands.add(entity, GpuParticles{});
        }
    });
    emitters.each([&](Entity entity, const ParticleEmitter& emitter, const GpuParticles&) {
        if (!runs_on_gpu(emitter)) {
            commands.remove<GpuParticles>(entity);
        }
    });
}

void record_gpu_particles(
    Query<
        const ParticleEmitter, Optional<const ParticleMotion>, const WorldTransform,
        const PreviousWorldTransform, Optional<const ParticleCollision>,
        Optional<const ParticleWrap>, Optional<const ParticleSource>,
        Optional<const ParticleSurface>, Optional<const ParticleMesh>, Optional<const SprayDrops>,
        GpuParticles>
        emitters,
    BirthSurfaces surfaces, Res<const ParticleObstacles> obstacles, Res<GpuShapes> shapes,
    ParticleEnvironment environment) {
    const StepContext context = find_step_context(environment);
    std::optional<std::vector<GpuCollider>> colliders;  // found when they are first needed
    emitters.each([&](Entity entity, const ParticleEmitter& emitter, const ParticleMotion* motion,
                      const WorldTransform& now, const PreviousWorldTransform& previous,
                      const ParticleCollision* collision, const ParticleWrap* wrap,
                      const ParticleSource* source, const ParticleSurface* surface,
                      const ParticleMesh* mesh, const SprayDrops* drops, GpuParticles& particles) {
        const std::uint64_t subject = subject_of(emitter, entity);
        GpuParticleStep step;
        step.pose = emitter_pose(now, previous);
        step.inherited = inherited_velocity(emitter, step.pose, context.dt);
        step.motion = find_emitter_motion(motion, wrap, now.world, context);
        if (collision != nullptr && wrap == nullptr && !step.motion.step.closed_form) {
            if (!colliders) {
                colliders = find_gpu_colliders(*obstacles, *shapes);
            }
            step.colliders = *colliders;
        }
        std::optional<SurfaceSource> on;
        if (surface != nullptr && source == nullptr) {
            on = find_surface_source(
                *surface, mesh, entity, step.pose, surfaces.meshes, surfaces.poses, surfaces.morphs,
                *surfaces.assets);
        }
        StepBirths births = {
            .seed = context.seed,
            .subject = subject,
            .scale = screen_coverage(emitter, now.world, context.eye),
            .by_others = source != nullptr,
            .surface = on ? &*on : nullptr};
        if (is_unused(particles.clock) && source == nullptr) {
            for (int i = 0; i < prewarm_steps(emitter, context.dt); ++i) {
                const Random random = prewarm_random(context.seed, subject, i);
                record_step(emitter, births, step, random, particles);
            }
        }
        births.drops = drops;
        const Random random = births_random(context.seed, subject, context.time.frame);
        record_step(emitter, births, step, random, particles);
        const Random oldest = attributes_random(context.seed, subject, particles.oldest());
        particles.counter = oldest.counter();
        particles.key = oldest.key();
    });
}

}  // namespace limn
