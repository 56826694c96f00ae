#pragma once

#include "ecs/command_flush.h"
#include "ecs/flush_stats.h"
#include "ecs/system.h"
#include "ecs/world.h"

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace limn {

/// What the world keeps out of its header.
struct World::Internals {
    struct KnownSystem {
        const void* type;
        const void* function;
        std::unique_ptr<System> system;
    };

    std::map<std::vector<ComponentId>, std::uint32_t> archetype_by_components;
    std::vector<std::unique_ptr<Observer>> observers;  ///< in the order they were registered
    std::vector<KnownSystem> systems;
    std::mutex query_mutex;               ///< of World::queries_ while the world is const
    std::unique_ptr<CommandFlush> flush;  ///< null while in use, and before the first
    FlushStats flush_stats;
    /// While a snapshot is restored: large archetypes of before, for their memory.
    std::vector<std::unique_ptr<Archetype>> spare_archetypes;
};

}  // namespace limn
