#pragma once

#include "ecs/command_buffer.h"
#include "ecs/query_terms.h"
#include "ecs/reflect.h"

#include <cstddef>
#include <new>
#include <type_traits>
#include <utility>

namespace limn {

// Structural changes for later: a system records them, also from the tasks of par_chunks and
// par_each (threads of your own have no order, and the sync point refuses them), and the next sync
// point applies them. The order is that of the systems in the schedule, then chunks, then calls,
// for any number of threads; so the entities get the same handles everywhere. All commands for one
// entity become at most one move; commands for an entity that is gone by then are dropped.
//
//     void update_spray(Query<const Nozzle> nozzles, Commands commands) {
//         nozzles.par_each([&](const Nozzle& nozzle) {
//             const Entity drop = commands.create(Drop{nozzle.exit}, Velocity{nozzle.speed});
//             commands.create(Splash{}, Parent{drop});
//         });
//     }
//
// create() returns a placeholder: it is good for further commands of the same run of the same
// system and for the Entity fields (of visit_fields) of components given to them, where the final
// handle takes its place. It is no handle: to the world it is stale.
//
// Where the rows go is defined too. Archetype by archetype, in the order of their creation, the
// rows that leave it are appended to their new archetypes in the order they had; then the gaps are
// filled, the lowest first, with the rows beyond the new end (Archetype::close_gaps). Entities that
// are created come last, in the order of their create().
//
// Commands of one kind in a row are cheapest: recording is to append to an array, and rows that are
// neighbors move together, a whole archetype by exchanging the columns.

class Commands {
  public:
    explicit Commands(CommandBuffer& buffer) : buffer_(&buffer) {}

    /// Each component once.
    template <typename... Ts>
    Entity create(Ts&&... components) const {
        using Layout = detail::RecordLayoutOf<true, std::remove_cvref_t<Ts>...>;
        std::byte* values = nullptr;
        const Entity entity = buffer_->create(record_layout<std::remove_cvref_t<Ts>...>, values);
        [[maybe_unused]] std::size_t position = 0;
        (put(values + Layout::kPlaces.offsets[position++], std::forward<Ts>(components)), ...);
        return entity;
    }
    void destroy(Entity entity) const { buffer_->record(CommandOp::Destroy, entity, key_layout<>); }
    /// Adds the component or replaces its value.
    template <typename T>
    void add(Entity entity, T component = T{}) const {
        put(buffer_->record(CommandOp::Add, entity, record_layout<T>), std::move(component));
    }
    /// Replaces the value if the entity has the component by then.
    template <typename T>
    void set(Entity entity, T component) const {
        put(buffer_->record(CommandOp::Set, entity, record_layout<T>), std::move(component));
    }
    template <typename T>
    void remove(Entity entity) const {
        buffer_->record(CommandOp::Remove, entity, key_layout<T>);
    }
    /// Enables or disables the component (Storage::Toggle) if the entity has it by then. Adding it
    /// afterwards enables it.
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

    // ---- without types
    // ----------------------------------------------------------------------------

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
