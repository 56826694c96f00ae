#pragma once

#include "ecs/entity.h"

#include <cstdint>
#include <string>

namespace limn {

class World;

// What the inspector tells of a particle emitter, and does to it beside editing its fields.

struct EmitterCounts {
    std::uint64_t alive = 0;  ///< on the GPU: that may be
    std::uint64_t capacity = 0;
    std::uint64_t dropped = 0;  ///< births for which there was no room
    std::uint64_t born = 0;     ///< of all time
    bool on_gpu = false;
};

/// All 0 before the first step.
[[nodiscard]] EmitterCounts count_particles(const World& world, Entity emitter);

/// "no room for 12 births of 2 emitters: ..." for the status; empty: none was dropped.
[[nodiscard]] std::string describe_drops(const World& world);

/// The emitter begins anew in the next step, prewarmed if it is so.
void restart_emitter(World& world, Entity emitter);

/// Another seed, not 0: the next of a sequence without short cycles.
[[nodiscard]] std::uint32_t next_seed(std::uint32_t seed);

}  // namespace limn
