#pragma once

#include "content/load/component_json.h"
#include "ecs/base/result.h"
#include "ecs/components/script.h"

#include <functional>

namespace limn {

// What happens at which time of a level (ecs/components/script.h):
//
//     {
//       "at": 2.0,                                   // seconds since the level began
//       "every": 0.5, "times": 10,                   // again: ten times in all
//       "set": {"lamp": {"point_light": {"enabled": false}}},       // fields get a value
//       "set_resources": {"exposure": {"ev": -1}},
//       "impulse": {"lamp": {"transform": {"position": [0, 1, 0]}}},  // numbers grow, rotations
//       turn further "spawn": [NODE, ...],                        // each a new root "destroy":
//       ["old lamp"]                      // with what is below it
//     }
//
// The parts of one event happen in the order in which they are written.

/// Reads an entity of "spawn" and what is below it.
using ReadPrefab = std::function<Result<Prefab>(const JsonValue& node, const JsonPlace& place)>;

[[nodiscard]] Result<ScriptEvent> read_event(
    const JsonValue& json, const JsonPlace& place, const FindNames& names,
    const ReadPrefab& read_prefab);

}  // namespace limn
