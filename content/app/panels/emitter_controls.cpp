#include "content/app/panels/emitter_controls.h"

#include "ecs/components/gpu_particles.h"
#include "ecs/components/particles.h"
#include "ecs/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace limn {

EmitterCounts count_particles(const World& world, Entity emitter) {
    EmitterCounts counts;
    if (const auto* const settings = world.find<ParticleEmitter>(emitter)) {
        counts.capacity = settings->capacity;
        counts.on_gpu = runs_on_gpu(*settings);
    }
    const EmitterClock* clock = nullptr;
    if (const auto* const pool = world.find<ParticlePool>(emitter)) {
        counts.alive = pool->size();
        clock = &pool->clock;
    } else if (const auto* const particles = world.find<GpuParticles>(emitter)) {
        counts.alive = std::min(particles->clock.born - particles->oldest(), counts.capacity);
        clock = &particles->clock;
    }
    if (clock != nullptr) {
        counts.born = clock->born;
        counts.dropped = clock->dropped;
    }
    return counts;
}

std::string describe_drops(const World& world) {
    std::uint64_t dropped = 0;
    std::size_t emitters = 0;
    world.query<const ParticleEmitter>().each([&](Entity entity, const ParticleEmitter&) {
        const std::uint64_t own = count_particles(world, entity).dropped;
        dropped += own;
        emitters += own > 0 ? 1 : 0;
    });
    if (dropped == 0) {
        return {};
    }
    return fmt::format(
        "{} particle{} of {} emitter{} dropped: raise particle_emitter.capacity", dropped,
        dropped == 1 ? "" : "s", emitters, emitters == 1 ? "" : "s");
}

std::uint32_t next_seed(std::uint32_t seed) {
    const std::uint32_t next = seed * 1664525u + 1013904223u;  // Knuth; full period
    return next != 0 ? next : 1;
}

}  // namespace limn
