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
// to and whose values are new there. That depends on the kinds of the commands and on the archetype
// the entity is in, not on the entity, so it is worked out once and kept. The values of shared
// components are the exception: each combination of them has a plan of its own.

/// What commands say of a component that can be disabled.
enum class Enabling : std::uint8_t { Keep, Enable, Disable };

/// The commands become one change: the last value wins, Set only replaces, and after Destroy
/// nothing matters.
struct ComponentChange {
    const ComponentInfo* info;
    std::int32_t command = -1;  ///< which one has the new value; -1: none has
    std::uint32_t offset = 0;   ///< of the value in its record [bytes]
    bool was_present = false;   ///< before
    bool is_present = false;    ///< afterwards
    bool was_removed = false;   ///< at some time in between
    Enabling enabling = Enabling::Keep;

    [[nodiscard]] bool gains() const { return is_present && (!was_present || was_removed); }
    [[nodiscard]] bool loses() const { return was_present && (!is_present || was_removed); }
    /// Whether the value decides the archetype.
    [[nodiscard]] bool sets_shared() const {
        return info->storage == Storage::Shared && is_present && command >= 0;
    }
};

/// A value that nobody needs in the end, and that has a destructor.
struct DroppedValue {
    const ComponentInfo* info;
    std::uint32_t command;
    std::uint32_t offset;
};

/// Whether a sparse component is there differs from entity to entity.
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
    /// Some command has the value of a shared component. Such a plan has no target; those of
    /// with_shared have, and are kept here by it.
    bool sets_shared = false;
    mutable std::map<const Archetype*, std::unique_ptr<ChangePlan>> by_target;

    [[nodiscard]] bool is_for(const Archetype* from, std::span<const CommandKind> kinds) const;
};

/// The plans of a world. They stay where they are until clear_if_stale().
class ChangePlans {
  public:
    explicit ChangePlans(World& world) : world_(world) {}

    /// `source` is nullptr for entities that are created.
    const ChangePlan& find(Archetype* source, std::span<const CommandKind> commands) {
        if (last_ != nullptr && last_->is_for(source, commands)) {
            return *last_;
        }
        return find_or_make(source, commands);
    }
    /// Of a plan that sets shared components: the one for the values in these records, one for each
    /// command.
    const ChangePlan& with_shared(const ChangePlan& plan, std::span<std::byte* const> records);
    /// Between two uses: forgets the plans if the archetypes began anew or there are many.
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
