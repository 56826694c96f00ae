#pragma once

#include "content/load/level/component_json.h"
#include "ecs/base/result.h"
#include "ecs/components/script.h"

#include <functional>

namespace limn {

// Timed events of a level (ecs/components/script.h):
//
//     {
//       "at": 2.0,                   // seconds since the start of the level
//       "every": 0.5, "times": 10,   // repeated: ten times in total
//       "key": "G",                  // instead of a time: when this key is pressed, or "released":
//       "text": "strike the iron",   // shown in the help
//       // assigns fields
//       "set": {"lamp": {"point_light": {"enabled": false}, "spin": null}},  // null removes it
//       "set_resources": {"exposure": {"ev": -1}},
//       // adds to numbers, composes rotations, steps through enumerations and bools
//       "impulse": {"lamp": {"transform": {"position": [0, 1, 0]}}},
//       "impulse_resources": {"rendering": {"shading": 1}},
//       "spawn": [NODE, ...],        // each a new root
//       "destroy": ["old lamp"]      // with its descendants
//     }
//
// The actions of an event run in the order in which they are written.

/// Reads an entity of "spawn" and its descendants.
using ReadPrefab =
    std::function<Result<Prefab>(const JsonValue& node, const JsonLocation& location)>;

/// Reads the fields of a component that `json` names into the value and edits of `action`, which
/// is Set or Impulse.
[[nodiscard]] Status read_edits(
    const JsonValue& json, const ComponentInfo& info, const JsonLocation& location,
    const NameResolver& names, ScriptAction& action);

[[nodiscard]] Result<ScriptEvent> read_event(
    const JsonValue& json, const JsonLocation& location, const NameResolver& names,
    const ReadPrefab& read_prefab);

}  // namespace limn
