#pragma once

#include <string>
#include <vector>

namespace limn {

// What a level file may hold beside components, resources and generators: the keys of the file
// itself, of entities, events ... for `limn components`. From the JSON Schema, so that whatever is
// accepted is listed.

struct LevelKey {
    std::string path;  ///< "vary.NAME.from"; NAME is any, [] an item of a list
    std::string type;  ///< "list", "number"
    std::string doc;
};

struct LevelKeys {
    std::string name;  ///< "event"
    std::vector<LevelKey> keys;
};

/// All kinds of objects with keys of their own. Components and resources must be registered.
[[nodiscard]] std::vector<LevelKeys> list_level_keys();

}  // namespace limn
