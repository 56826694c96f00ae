#pragma once

#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

/// Resource: the simulation's time. No system reads a clock.
struct FrameTime {
    float step = 1.0f / 60.0f;  ///< length of a step [s], constant within a level
    double time = 0.0;
    std::uint64_t frame = 0;
};

LIMN_FIELDS(FrameTime) {
    LIMN_FIELD(step, "length of a step", "s", 1e-4, 1);
    LIMN_FIELD(time, "time at the end of the step", "s", 0);
    LIMN_FIELD(frame, "number of steps so far");
}

/// Resource: seed of all random numbers of the simulation, which are also keyed by entity, system
/// and frame.
struct RandomSeed {
    std::uint64_t seed = 1;
};

LIMN_FIELDS(RandomSeed) {
    LIMN_FIELD(seed, "seed of all random numbers");
}

}  // namespace limn
