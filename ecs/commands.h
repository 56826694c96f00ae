#pragma once

#include "ecs/command_buffer.h"
#include "ecs/query_terms.h"
#include "ecs/reflect.h"

#include <cstdint>
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

class Commands {
  public:
    explicit Commands(CommandBuffer& buffer) : buffer_(&buffer) {}

    template <typename... Ts>
    Entity create(Ts&&... components) const {
        const Entity entity = buffer_->create();
        (put(CommandOp::Add, entity, std::forward<Ts>(components)), ...);
        return entity;
    }
    void destroy(Entity entity) const { buffer_->record(CommandOp::Destroy, entity, 0); }
    /// Adds the component or replaces its value.
    template <typename T>
    void add(Entity entity, T component = T{}) const {
        put(CommandOp::Add, entity, std::move(component));
    }
    /// Replaces the value if the entity has the component by then.
    template <typename T>
    void set(Entity entity, T component) const {
        put(CommandOp::Set, entity, std::move(component));
    }
    template <typename T>
    void remove(Entity entity) const {
        buffer_->record(CommandOp::Remove, entity, component_id<T>);
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
        set_enabled(entity, component_id<T>, enabled);
    }

    // ---- without types
    // ----------------------------------------------------------------------------

    void add_default(Entity entity, ComponentId id) const;
    void add_copy(Entity entity, ComponentId id, const void* value) const;
    void remove(Entity entity, ComponentId id) const {
        buffer_->record(CommandOp::Remove, entity, id);
    }
    void set_enabled(Entity entity, ComponentId id, bool enabled) const {
        buffer_->record(enabled ? CommandOp::Enable : CommandOp::Disable, entity, id);
    }

  private:
    template <typename T>
    void put(CommandOp op, Entity entity, T&& component) const {
        using Value = std::remove_cvref_t<T>;
        static_assert(
            detail::Component<Value>, "components are values, not pointers, arrays or entities");
        if constexpr (std::is_empty_v<Value>) {
            buffer_->record(op, entity, component_id<Value>);
        } else {
            void* room =
                buffer_->record(op, entity, component_id<Value>, sizeof(Value), alignof(Value));
            ::new (room) Value(std::forward<T>(component));
        }
    }

    CommandBuffer* buffer_;
};

}  // namespace limn
