#pragma once

#include <cstdint>

namespace limn {

/// Resource: the simulation's time. No system reads a clock.
struct FrameTime {
    float step = 1.0f / 60.0f;   ///< length of this step [s], the same for all steps of a level
    double time = 0.0;           ///< at the end of this step [s]
    std::uint64_t frame = 0;     ///< steps done before this one
};

/// Resource: what every random number of the simulation is keyed by, beside entity, system and frame.
struct RandomSeed {
    std::uint64_t seed = 1;
};

}  // namespace limn
