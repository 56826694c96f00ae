#pragma once

#include "ecs/reflect.h"

namespace limn {

// Techniques: particle.interparticle

/// Particles of the emitter are balls of equal mass that bump into each other
/// (particle.interparticle), not into those of other emitters. On the CPU only. In a crowd each
/// meets 64 others at most.
struct ParticleBalls {
    float radius = 0.05f;
    float bounce = 0.5f;
};

LIMN_FIELDS(ParticleBalls) {
    LIMN_FIELD(radius, "of each ball; that of particle_collision is apart", "m", 0.0001, 100);
    LIMN_FIELD(bounce, "share of the speed toward each other that is kept, apart", "", 0, 1);
}

}  // namespace limn
