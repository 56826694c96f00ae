#pragma once

#include "ecs/archetype.h"
#include "ecs/command_buffer.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

namespace limn {

class World;

// What a list of commands does to an entity, apart from the values: which archetype its row moves
// to and which components get new values. That depends only on the kinds of the commands and on the
// entity's archetype, so it is computed once and cached. The values of shared components are the
// exception: each combination of them has its own plan.

/// Effect of commands on the enable bit of a component.
enum class Enabling : std::uint8_t { Keep, Enable, Disable };

/// All commands for one component folded into one change: the last value wins, Set only replaces,
/// and after Destroy nothing matters.
struct ComponentChange {
    const ComponentInfo* info;
    std::int32_t command = -1;  ///< index of the command with the new value; -1: none
    std::uint32_t offset = 0;   ///< of the value in its record [bytes]
    bool was_present = false;   ///< before the commands
    bool is_present = false;    ///< after them
    bool was_removed = false;   ///< at some point in between
    Enabling enabling = Enabling::Keep;

    [[nodiscard]] bool gains() const { return is_present && (!was_present || was_removed); }
    [[nodiscard]] bool loses() const { return was_present && (!is_present || was_removed); }
    /// Whether the value determines the archetype.
    [[nodiscard]] bool sets_shared() const {
        return info->storage == Storage::Shared && is_present && command >= 0;
    }
};

/// An overwritten value whose destructor must be called.
struct DroppedValue {
    const ComponentInfo* info;
    std::uint32_t command;
    std::uint32_t offset;
};

/// Change of a sparse component, whose presence differs from entity to entity.
struct SparseChange {
    ComponentChange if_absent;
    ComponentChange if_present;
    std::vector<DroppedValue> dropped_if_absent;
    std::vector<DroppedValue> dropped_if_present;
};

struct ChangePlan {
    Archetype* source = nullptr;  ///< nullptr: the entity is created
    Archetype* target = nullptr;  ///< nullptr: it is destroyed
    std::vector<CommandKind> commands;
    std::vector<ComponentChange> table;
    std::vector<SparseChange> sparse;
    std::vector<DroppedValue> dropped;
    /// Some command has the value of a shared component. Such a plan has no target itself; the
    /// plans made by with_shared() do, and are cached here.
    bool sets_shared = false;
    mutable std::map<const Archetype*, std::unique_ptr<ChangePlan>> by_target;

    [[nodiscard]] bool is_for(const Archetype* from, std::span<const CommandKind> kinds) const;
};

/// The plan cache of a world. References stay valid until clear_if_stale().
class ChangePlans {
  public:
    explicit ChangePlans(World& world) : world_(world) {}

    /// `source` is nullptr for entities to create.
    const ChangePlan& find(Archetype* source, std::span<const CommandKind> commands) {
        if (last_ != nullptr && last_->is_for(source, commands)) {
            return *last_;
        }
        return find_or_make(source, commands);
    }
    /// For a plan that sets shared components: the plan for the values in `records`, one per
    /// command.
    const ChangePlan& with_shared(const ChangePlan& plan, std::span<std::byte* const> records);
    /// Empties the cache if the world's archetypes were reset or it has grown too large.
    void clear_if_stale();

  private:
    const ChangePlan& find_or_make(Archetype* source, std::span<const CommandKind> commands);
    [[nodiscard]] std::unique_ptr<ChangePlan>
    make(Archetype* source, std::span<const CommandKind> commands);
    [[nodiscard]] Archetype&
    find_target(const ChangePlan& plan, std::span<std::byte* const> records);

    World& world_;
    const ChangePlan* last_ = nullptr;
    std::vector<std::unique_ptr<ChangePlan>> plans_;
    std::vector<std::uint32_t> slots_;  ///< hash table: 1 + index into plans_, 0: free
    std::uint32_t epoch_ = 0;
    std::size_t commands_ = 0;  ///< in all plans
};

}  // namespace limn
