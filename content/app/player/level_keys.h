#pragma once

#include <string>
#include <vector>

namespace limn {

// Keys of a level file besides components, resources and generators: those of the file
// itself, of entities, events ... for `limn components`. Derived from the JSON Schema, so that all
// accepted keys are listed.

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
