#pragma once

#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

/// Resource: the simulation's time. No system reads a clock.
struct FrameTime {
    float step = 1.0f / 60.0f;  ///< length of this step [s], the same for all steps of a level
    double time = 0.0;          ///< at the end of this step [s]
    std::uint64_t frame = 0;    ///< steps done before this one
};

/// Resource: what every random number of the simulation is keyed by, beside entity, system and
/// frame.
struct RandomSeed {
    std::uint64_t seed = 1;
};

template <typename Visitor>
void visit_fields(FrameTime& time, Visitor&& visit) {
    visit("step", time.step, {.doc = "length of a step", .unit = "s", .min = 1e-4, .max = 1});
    visit("time", time.time, {.doc = "at the end of the step", .unit = "s", .min = 0});
    visit("frame", time.frame, {.doc = "steps done before"});
}

template <typename Visitor>
void visit_fields(RandomSeed& seed, Visitor&& visit) {
    visit("seed", seed.seed, {.doc = "what every random number is keyed by"});
}

}  // namespace limn
