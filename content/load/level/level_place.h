#pragma once

#include "ecs/base/result.h"
#include "ecs/prefab.h"

#include <string>
#include <vector>

namespace limn {

class World;

// Prefabs of a level that is loaded already, to place more instances of them (the inspector's
// "Place ...", and `place` of `limn edit`).

/// Names of the prefabs of the level's file and of what it includes, sorted.
[[nodiscard]] Result<std::vector<std::string>> prefab_names(const std::string& path);

/// An instance called `name`, to spawn in the world that was loaded from the file. Fails if the
/// file has no such prefab, or if the prefab uses a glTF file.
[[nodiscard]] Result<Prefab> read_instance(
    const World& world, const std::string& path, const std::string& prefab,
    const std::string& name);

}  // namespace limn
