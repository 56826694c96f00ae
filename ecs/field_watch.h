#pragma once

#include "ecs/any_component.h"
#include "ecs/entity.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace limn {

class World;

// Calls before and after a field of a component is set by hand (engine.param-notify): in the
// inspector and by its undo, by `--set`, and when a level's file has changed. Systems write whole
// columns, which is followed by versions instead (Query::since).
//
//     watch_field<ParticleEmitter>(world, "seed", [](World& there, const FieldNote& note) {
//         if (note.phase == FieldPhase::After) { restart_emitter(there, note.entity); }
//     });

enum class FieldPhase : std::uint8_t {
    Before,  ///< the entity still has the previous value
    After,   ///< it has the new one
};

struct FieldNote {
    Entity entity;
    const ComponentInfo* component = nullptr;
    const FieldInfo* field = nullptr;
    FieldPhase phase = FieldPhase::Before;
};

/// May read and write components, not add, remove or destroy.
using FieldHandler = std::function<void(World&, const FieldNote&)>;

/// Resource: the handlers, in the order in which they were added.
struct FieldWatches {
    struct Watch {
        ComponentId component;
        std::string field;
        FieldHandler handler;
    };
    std::vector<Watch> watches;
    bool calling = false;  ///< handlers run; what they write calls none
};

template <>
struct ComponentTraits<FieldWatches> : DefaultTraits {
    static constexpr bool saved = false;
};

void watch_field(World& world, const ComponentInfo& info, std::string field, FieldHandler handler);
template <typename T>
void watch_field(World& world, std::string field, FieldHandler handler) {
    watch_field(world, component_info<T>(), std::move(field), std::move(handler));
}

/// Replaces a component, which the entity must have, and calls the handlers of the fields whose
/// values differ: all with Before, in the order of the fields, then all with After.
void write_fields(World& world, Entity entity, AnyComponent value);

/// Whether the fields at `a` and `b` have the same value, with all their elements.
[[nodiscard]] bool equal_fields(const FieldInfo& field, const void* a, const void* b);

/// The fields of `a` whose values differ in `b`, of the same type.
[[nodiscard]] std::vector<const FieldInfo*>
changed_fields(const AnyComponent& a, const AnyComponent& b);

}  // namespace limn
