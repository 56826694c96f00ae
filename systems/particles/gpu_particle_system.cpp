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

/// Records a step with its births.
void record_step(
    const ParticleEmitter& emitter, float scale, GpuParticleStep step, Random random,
    GpuParticles& particles) {
    const float dt = step.motion.step.dt;
    drop_expired(emitter, dt, particles);
    const std::uint64_t window = particles.clock.born - particles.oldest();
    const std::size_t room = birth_room(emitter, window, particles.clock);
    step.first = particles.clock.born;
    find_births(emitter, scale, dt, room, random, particles.clock, step.births);
    for (const BirthRun& run : step.births) {
        step.count += run.count;
    }
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
        Optional<const ParticleWrap>, GpuParticles>
        emitters,
    Res<const ParticleObstacles> obstacles, Res<GpuShapes> shapes,
    ParticleEnvironment environment) {
    const StepContext context = find_step_context(environment);
    std::optional<std::vector<GpuCollider>> colliders;  // found when they are first needed
    emitters.each([&](Entity entity, const ParticleEmitter& emitter, const ParticleMotion* motion,
                      const WorldTransform& now, const PreviousWorldTransform& previous,
                      const ParticleCollision* collision, const ParticleWrap* wrap,
                      GpuParticles& particles) {
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
        const float scale = screen_coverage(emitter, now.world, context.eye);
        if (is_unused(particles.clock)) {
            for (int i = 0; i < prewarm_steps(emitter, context.dt); ++i) {
                const Random random = prewarm_random(context.seed, subject, i);
                record_step(emitter, scale, step, random, particles);
            }
        }
        const Random random = births_random(context.seed, subject, context.time.frame);
        record_step(emitter, scale, step, random, particles);
        const Random oldest = attributes_random(context.seed, subject, particles.oldest());
        particles.counter = oldest.counter();
        particles.key = oldest.key();
    });
}

}  // namespace limn
