#pragma once

#include "content/load/files/json_document.h"
#include "content/load/level/component_json.h"
#include "ecs/base/result.h"

#include <string_view>

namespace limn {

// Changes of a level's file: what shows switch on and off, and what the inspector saves.

/// Applies a JSON merge patch (RFC 7386): objects merge, null removes a member, anything else
/// replaces it. A null for a member that is missing stays: it removes a prefab's component. An
/// object under "entities" or "children" has the names of entities as keys, and under the key "+"
/// an array of entities to add. Fails if it names an entity that the level does not have.
[[nodiscard]] Status
patch_level(JsonValue& level, const JsonValue& patch, const JsonLocation& location);

/// The first of these entities and their children with that name; null if there is none.
[[nodiscard]] JsonValue* find_entity_json(JsonValue& nodes, std::string_view name);

}  // namespace limn
