#pragma once

#include "content/load/files/json_document.h"

#include <map>
#include <string>

namespace limn {

// New names of entities in a level's file, and in all that refers to them: fields of components and
// resources, events, and shows. A copy made by `repeat` is "post[2]" of the entity "post".
//
// Inside a prefab and its instances, names are those of the prefab's own entities first. Names that
// a prefab of the level uses are therefore not renamed: it would be unclear which entity is meant.

/// New names by old ones.
using EntityNames = std::map<std::string, std::string>;

/// Whether some prefab of the level, or what an event spawns, has an entity of this name.
[[nodiscard]] bool is_prefab_name(const JsonValue& level, const std::string& name);

/// Whether fields, events or shows of the level refer to an entity of this name.
[[nodiscard]] bool is_referred_to(const JsonValue& level, const std::string& name);

/// Renames all of them at once, so that two can swap their names.
void rename_entities(JsonValue& level, const EntityNames& names);

}  // namespace limn
