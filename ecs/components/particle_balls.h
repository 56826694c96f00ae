#pragma once

#include "ecs/reflect.h"

namespace limn {

// Techniques: particle.interparticle

/// Particles of the emitter are balls of equal mass that bump into each other
/// (particle.interparticle), not into those of other emitters. In a crowd each collides with 64
/// others at most, on the GPU with 30. There all pairs of a pass move at once: two that meet part
/// as on the CPU, crowds only on average.
struct ParticleBalls {
    float radius = 0.05f;
    float bounce = 0.5f;
};

LIMN_FIELDS(ParticleBalls) {
    LIMN_FIELD(radius, "of each ball; that of particle_collision is independent", "m", 0.0001, 100);
    LIMN_FIELD(
        bounce, "coefficient of restitution: fraction of the approach speed that is kept", "", 0,
        1);
}

}  // namespace limn
