#pragma once

#include "ecs/archetype.h"
#include "ecs/base/check.h"
#include "ecs/entity_table.h"
#include "ecs/shared_values.h"
#include "ecs/sparse_set.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

namespace limn {

// What a query sees of a world: slots, archetypes, sparse sets, the clock of change versions, and
// the lock that makes a structural change during an iteration a mistake with a message.

/// Versions older than this are forgotten (made equal to it) before differences could overflow.
inline constexpr std::uint32_t kMaxVersionAge = 3u << 29;
/// `since` of a system that never ran, relative to the version it runs at: all is new to it.
inline constexpr std::uint32_t kNeverRan = 0x7fffffffu;

static_assert(kMaxRows <= kMaxRowsOfSlot);

/// Counts from 1.
[[nodiscard]] std::uint32_t next_epoch();

struct WorldCore {
    EntityTable entities;
    BlockPool blocks;
    std::vector<std::unique_ptr<Archetype>> archetypes;  ///< in the order of their creation
    std::vector<std::unique_ptr<SparseSet>> sparse;      ///< by ComponentId; null: never used
    SharedValues shared;
    std::vector<SparseSet*> sparse_list;  ///< those in use, in the order of their first use
    mutable std::atomic<std::uint32_t> version = 1;  ///< of what is changed now
    mutable std::atomic<int> iterations = 0;         ///< > 0: the structure is locked
    /// Of `archetypes` from when they last began anew; no other world has had the same, so that a
    /// system can tell worlds apart.
    std::uint32_t epoch = next_epoch();
    std::uint32_t times_forgotten = 0;  ///< counts how often old versions were

    [[nodiscard]] std::uint32_t now() const { return version.load(std::memory_order_relaxed); }
    [[nodiscard]] SparseSet* sparse_set(ComponentId id) const {
        return id < sparse.size() ? sparse[id].get() : nullptr;
    }
    void check_unlocked() const {
        LIMN_CHECK_NOTE(
            iterations.load(std::memory_order_relaxed) == 0,
            "structural change while iterating or inside a system; record it with Commands");
    }
};

/// Who locks the structure while a query iterates.
enum class IterationLock : std::uint8_t {
    System,  ///< whoever runs the system has done it
    Plain,   ///< the query; nobody else uses the world
    Shared,  ///< the query; others may read the world at the same time
};

class IterationGuard {
  public:
    IterationGuard(const WorldCore& core, IterationLock lock) : core_(core), lock_(lock) { add(1); }
    IterationGuard(const IterationGuard&) = delete;
    IterationGuard& operator=(const IterationGuard&) = delete;
    ~IterationGuard() { add(-1); }

  private:
    void add(int count) {
        if (lock_ == IterationLock::Plain) {
            // A plain addition: half the cost of a small query would be the locked one.
            core_.iterations.store(
                core_.iterations.load(std::memory_order_relaxed) + count,
                std::memory_order_relaxed);
        } else if (lock_ == IterationLock::Shared) {
            core_.iterations.fetch_add(count, std::memory_order_relaxed);
        }
    }
    const WorldCore& core_;
    IterationLock lock_;
};

}  // namespace limn
