#include "systems/particles/gpu_particles.h"

#include "systems/particles/emitter_place.h"
#include "systems/particles/particle_births.h"
#include "systems/particles/particle_motion.h"
#include "systems/particles/particle_system.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace limn {
namespace {

constexpr std::size_t kMostSteps = 65536;  // that are kept, however long particles live

/// Forgets the steps whose particles are all dead at the end of the one to come.
void drop_old_steps(const ParticleEmitter& emitter, float dt, GpuParticles& particles) {
    const float longest = finite_or(emitter.life, 0) + std::abs(finite_or(emitter.life_spread, 0));
    float age = dt;
    for (const GpuParticleStep& step : particles.kept()) {
        age += step.motion.step.dt;
    }
    while (!particles.kept().empty()) {
        age -= particles.kept().front().motion.step.dt;
        if (age <= longest && particles.kept().size() < kMostSteps) {
            break;
        }
        ++particles.forgotten;
    }
    if (particles.forgotten > particles.kept().size()) {
        const auto begin = particles.steps.begin();
        particles.steps.erase(begin, begin + static_cast<std::ptrdiff_t>(particles.forgotten));
        particles.forgotten = 0;
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
        const PreviousWorldTransform, GpuParticles>
        emitters,
    Query<const Camera, const WorldTransform> cameras, Res<const WeatherState> gusts,
    OptionalRes<const Weather> weather, Res<const RandomSeed> seed, Res<const FrameTime> time) {
    const float dt = std::min(time->step, kMaxParticleStep);
    const Vec3 wind = weather ? current_weather(*weather, *gusts).wind() : Vec3(0);
    const EmitterEye eye = find_eye(cameras);
    emitters.each([&](Entity entity, const ParticleEmitter& emitter, const ParticleMotion* motion,
                      const WorldTransform& now, const PreviousWorldTransform& previous,
                      GpuParticles& particles) {
        static const ParticleMotion kStill;
        drop_old_steps(emitter, dt, particles);
        const std::uint64_t subject = subject_of(emitter, entity);
        const Random oldest = attributes_random(seed->seed, subject, particles.oldest());
        particles.counter = oldest.counter();
        particles.key = oldest.key();
        GpuParticleStep step;
        step.first = particles.clock.born;
        step.place = place_of(now, previous);
        step.inherited = inherited_velocity(emitter, step.place, dt);
        step.motion = find_motion(motion != nullptr ? *motion : kStill, now.world, wind, dt, *time);
        const std::uint64_t window = particles.clock.born - particles.oldest();
        const std::uint64_t room = emitter.capacity > window ? emitter.capacity - window : 0;
        Random random = births_random(seed->seed, subject, time->frame);
        find_births(
            emitter, seen_share(emitter, now.world, eye), dt, room, random, particles.clock,
            step.births);
        for (const BirthRun& run : step.births) {
            step.count += run.count;
        }
        particles.clock.born += step.count;
        particles.steps.push_back(std::move(step));
        ++particles.step;
    });
}

}  // namespace limn
