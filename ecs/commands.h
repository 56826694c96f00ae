#pragma once

#include "ecs/command_buffer.h"
#include "ecs/query_terms.h"
#include "ecs/reflect.h"

#include <cstddef>
#include <new>
#include <type_traits>
#include <utility>

namespace limn {

// Deferred structural changes: a system records them, also from the tasks of par_chunks and
// par_each (but not from your own threads, whose order is undefined: the sync point stops), and the
// next sync point applies them. The order is that of the systems in the schedule, then chunks, then
// calls, for any number of threads, so entity handles are deterministic. All commands for one
// entity become at most one move; commands for an entity destroyed by then are dropped.
//
//     void update_spray(Query<const Nozzle> nozzles, Commands commands) {
//         nozzles.par_each([&](const Nozzle& nozzle) {
//             const Entity drop = commands.create(Drop{nozzle.exit}, Velocity{nozzle.speed});
//             commands.create(Splash{}, Parent{drop});
//         });
//     }
//
// create() returns a placeholder, valid for further commands in the same run of the same system and
// in the Entity fields (of LIMN_FIELDS) of their components, where it is replaced by the final
// handle. It is not a handle: to the world it is stale.
//
// Row order is deterministic too. Archetype by archetype, in creation order, the rows that leave it
// are appended to their new archetypes in their current order; then the gaps are filled, the lowest
// first, with the rows beyond the new end (Archetype::close_gaps). New entities come last, in the
// order of their create().
//
// Consecutive commands of the same kind are cheapest: recording appends to an array, and adjacent
// rows move together, a whole archetype by exchanging columns.

class Commands {
  public:
    explicit Commands(CommandBuffer& buffer) : buffer_(&buffer) {}

    /// Each component type at most once.
    template <typename... Ts>
    Entity create(Ts&&... components) const {
        using Layout = detail::RecordLayoutOf<true, std::remove_cvref_t<Ts>...>;
        std::byte* values = nullptr;
        const Entity entity = buffer_->create(record_layout<std::remove_cvref_t<Ts>...>, values);
        [[maybe_unused]] std::size_t position = 0;
        (put(values + Layout::kPacking.offsets[position++], std::forward<Ts>(components)), ...);
        return entity;
    }
    void destroy(Entity entity) const { buffer_->record(CommandOp::Destroy, entity, key_layout<>); }
    /// Adds the component or replaces its value.
    template <typename T>
    void add(Entity entity, T component = T{}) const {
        put(buffer_->record(CommandOp::Add, entity, record_layout<T>), std::move(component));
    }
    /// Replaces the value if the entity has the component at the sync point.
    template <typename T>
    void set(Entity entity, T component) const {
        put(buffer_->record(CommandOp::Set, entity, record_layout<T>), std::move(component));
    }
    template <typename T>
    void remove(Entity entity) const {
        buffer_->record(CommandOp::Remove, entity, key_layout<T>);
    }
    /// Enables or disables the component (Storage::Toggle) if the entity has it at the sync point.
    /// Adding it afterwards enables it.
    template <typename T>
    void enable(Entity entity) const {
        set_enabled<T>(entity, true);
    }
    template <typename T>
    void disable(Entity entity) const {
        set_enabled<T>(entity, false);
    }
    template <typename T>
    void set_enabled(Entity entity, bool enabled) const {
        static_assert(
            detail::is_toggle<T>, "T cannot be disabled: its storage is not Storage::Toggle");
        buffer_->record(enabled ? CommandOp::Enable : CommandOp::Disable, entity, key_layout<T>);
    }

    // ---- type-erased
    // ------------------------------------------------------------------------------

    void add_default(Entity entity, ComponentId id) const;
    void add_copy(Entity entity, ComponentId id, const void* value) const;
    void remove(Entity entity, ComponentId id) const;
    void set_enabled(Entity entity, ComponentId id, bool enabled) const;

  private:
    template <typename T>
    static void put(std::byte* room, T&& component) {
        using Value = std::remove_cvref_t<T>;
        static_assert(
            detail::Component<Value>, "components are values, not pointers, arrays or entities");
        if constexpr (!std::is_empty_v<Value>) {
            ::new (static_cast<void*>(room)) Value(std::forward<T>(component));
        }
    }

    CommandBuffer* buffer_;
};

}  // namespace limn
