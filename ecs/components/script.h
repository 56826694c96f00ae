#pragma once

#include "ecs/any_component.h"
#include "ecs/prefab.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// Events of a level: a lamp that is switched on after two seconds, a stone that drops into the pool
// every half second, sparks when a key is pressed. Events are immutable content, like levels: which
// ones are due follows from the step number and the input only, so that a world restored from a
// snapshot continues like the original.

/// One field of a component or resource.
struct FieldEdit {
    const FieldInfo* field = nullptr;
    std::uint32_t offset = 0;  ///< from the start of the component [bytes]
    int steps = 0;  ///< of an impulse on an enumeration or bool: to a later (earlier) value, cyclic
};

enum class EventAction : std::uint8_t {
    Set,      ///< assigns the fields of `value`; a missing component is added first
    Impulse,  ///< adds the fields of `value`, clamped to their ranges; rotations are multiplied,
              ///< enumerations and bools stepped through
    Spawn,    ///< creates an instance of `prefab`
    Destroy,  ///< destroys `entity` and its descendants
    Remove,   ///< removes the component of the type of `value`
};

/// One action of an event. Skipped if its entity no longer exists.
struct ScriptAction {
    EventAction action = EventAction::Set;
    bool is_resource = false;      ///< `value` is a resource, else a component of `entity`
    Entity entity;                 ///< for all actions but Spawn
    AnyComponent value;            ///< for Set and Impulse; for Remove, its type
    std::vector<FieldEdit> edits;  ///< the fields of `value` to apply
    Prefab prefab;                 ///< for Spawn
};

struct ScriptEvent {
    double time = 0.0;        ///< since the start of the level [s]; rounded to the nearest step
    double every = 0.0;       ///< period of repetitions [s], at least one step
    std::uint32_t times = 1;  ///< number of times it occurs
    std::string key;          ///< not at a time, but each time that this key is pressed
    bool on_release = false;  ///< or released
    std::vector<ScriptAction> actions;
};

/// Resource: all events of a level. Those of one step are executed in this order.
struct EventList {
    std::vector<ScriptEvent> events;
};

/// Name of the action (Input) that is in use while a key of the level's events is held.
[[nodiscard]] std::string key_action(std::string_view key);

/// Whether the event with a time occurs in step number `frame`, with steps of length `step` [s].
[[nodiscard]] bool is_due(const ScriptEvent& event, std::uint64_t frame, float step);

}  // namespace limn
