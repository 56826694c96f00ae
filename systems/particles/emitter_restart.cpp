#include "systems/particles/emitter_restart.h"

#include "ecs/components/gpu_particles.h"
#include "ecs/components/particles.h"
#include "ecs/field_watch.h"
#include "ecs/world.h"

// Techniques: engine.param-notify
// Shown by `limn play vale`: engine.param-notify

namespace limn {

void restart_emitter(World& world, Entity emitter) {
    if (world.has<ParticlePool>(emitter)) {
        world.get<ParticlePool>(emitter) = {};
    }
    if (world.has<GpuParticles>(emitter)) {
        world.get<GpuParticles>(emitter) = {};
    }
}

void watch_emitter_seeds(World& world) {
    watch_field<ParticleEmitter>(world, "seed", [](World& there, const FieldNote& note) {
        if (note.phase == FieldPhase::After) {
            restart_emitter(there, note.entity);
        }
    });
}

}  // namespace limn
