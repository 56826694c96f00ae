#pragma once

#include "ecs/entity.h"

#include <cstdint>
#include <string>

namespace limn {

class World;

// What the inspector shows of a particle emitter, and its controls besides the fields.

struct EmitterCounts {
    std::uint64_t alive = 0;  ///< on the GPU: an upper bound
    std::uint64_t capacity = 0;
    std::uint64_t dropped = 0;  ///< new particles dropped because the emitter was full
    std::uint64_t born = 0;     ///< in total
    bool on_gpu = false;
};

/// All 0 before the first step.
[[nodiscard]] EmitterCounts count_particles(const World& world, Entity emitter);

/// "12 particles of 2 emitters dropped: ..." for the status line; empty: none.
[[nodiscard]] std::string describe_drops(const World& world);

/// Another nonzero seed, from a full-period sequence.
[[nodiscard]] std::uint32_t next_seed(std::uint32_t seed);

}  // namespace limn
