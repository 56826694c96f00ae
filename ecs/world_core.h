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

// The part of a world that queries use: slots, archetypes, sparse sets, the change version counter,
// and the lock that detects structural changes during an iteration.

/// Older versions are clamped to this age before differences could overflow.
inline constexpr std::uint32_t kMaxVersionAge = 3u << 29;
/// For a system that never ran, `since` is its version minus this: everything counts as changed.
inline constexpr std::uint32_t kNeverRan = 0x7fffffffu;

static_assert(kMaxRows <= kMaxRowsOfSlot);

/// Counts from 1.
[[nodiscard]] std::uint32_t next_epoch();

struct WorldCore {
    EntityTable entities;
    BlockPool blocks;
    std::vector<std::unique_ptr<Archetype>> archetypes;  ///< in creation order
    std::vector<std::unique_ptr<SparseSet>> sparse;      ///< by ComponentId; null: never used
    SharedValues shared;
    std::vector<SparseSet*> sparse_list;             ///< those in use, in the order of first use
    mutable std::atomic<std::uint32_t> version = 1;  ///< assigned to current changes
    mutable std::atomic<int> iterations = 0;         ///< > 0: the structure is locked
    /// Changes whenever `archetypes` is reset; unique among all worlds, so that a system can
    /// distinguish worlds.
    std::uint32_t epoch = next_epoch();
    std::uint32_t version_clamp_count = 0;  ///< how often old versions were clamped

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
    System,  ///< the caller that runs the system
    Plain,   ///< the query; no other thread uses the world
    Shared,  ///< the query; other threads may read the world concurrently
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
            // Not an atomic increment, which would be half the cost of a small query.
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
