#pragma once

#include "ecs/any_component.h"
#include "ecs/prefab.h"

#include <cstdint>
#include <vector>

namespace limn {

// What a level does by the clock: a lamp that is switched on after two seconds, a stone that falls
// into the pool every half second. Events are content, as levels are, and do not change while they
// happen: which are due follows from the number of the step alone, so that a world restored from a
// snapshot goes on as the one it was taken from.

/// One field of a component or resource.
struct FieldEdit {
    const FieldInfo* field = nullptr;
    std::uint32_t offset = 0;  ///< from the start of the component [bytes]
};

enum class EventAction : std::uint8_t {
    Set,      ///< fields get the values of `value`; a component that is missing is added first
    Impulse,  ///< numbers grow by those of `value`, within their ranges; rotations are turned
              ///< further
    Spawn,    ///< one copy of `prefab`
    Destroy,  ///< `entity` and everything below it
};

/// One thing that happens. What is aimed at an entity that is gone does not.
struct ScriptAction {
    EventAction action = EventAction::Set;
    bool is_resource = false;      ///< `value` is a resource, else a component of `entity`
    Entity entity;                 ///< of all but Spawn
    AnyComponent value;            ///< of Set and Impulse
    std::vector<FieldEdit> edits;  ///< which fields of `value` count
    Prefab prefab;                 ///< of Spawn
};

struct ScriptEvent {
    double time = 0.0;        ///< since the level began [s]: in the step that begins nearest to it
    double every = 0.0;       ///< from one time to the next [s], at least one step
    std::uint32_t times = 1;  ///< how often
    std::vector<ScriptAction> actions;
};

/// Resource: all events of a level, those of one step happen in this order.
struct EventList {
    std::vector<ScriptEvent> events;
};

/// Whether the event happens in step number `frame` of length `step` [s].
[[nodiscard]] bool is_due(const ScriptEvent& event, std::uint64_t frame, float step);

}  // namespace limn
