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

/// Private data of World that needs more headers.
struct World::Internals {
    struct KnownSystem {
        const void* type;
        const void* function;
        std::unique_ptr<System> system;
    };

    std::map<std::vector<ComponentId>, std::uint32_t> archetype_by_components;
    std::vector<std::unique_ptr<Observer>> observers;  ///< in registration order
    std::vector<KnownSystem> systems;
    std::mutex query_mutex;               ///< protects World::queries_ while the world is const
    std::unique_ptr<CommandFlush> flush;  ///< null while in use, and before first use
    FlushStats flush_stats;
    /// Old large archetypes whose memory is reused while a snapshot is restored.
    std::vector<std::unique_ptr<Archetype>> spare_archetypes;
};

}  // namespace limn
