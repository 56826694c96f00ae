#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/entity.h"
#include "ecs/prefab.h"

#include <string>
#include <vector>

namespace limn {

class World;

// Prefabs of a level that is loaded already, to place more instances of them (the inspector's
// "Place ...", and `place` of `limn edit`).

/// Names of the prefabs of the level's file and of what it includes, sorted.
[[nodiscard]] Result<std::vector<std::string>> prefab_names(const std::string& path);

/// A level's file, and the entities that it became.
struct PlacedLevel {
    std::string path;
    std::vector<Entity> entities = {};  ///< in the level's order (LevelFields)
};

/// An instance with the name of the prefab, its root at `position`, to spawn in the world that was
/// loaded from the file. One, even if the prefab has a `repeat`. Names that the prefab does not
/// define are those of the file, whatever the entities are called now. Fails if the file has no
/// such prefab, or if the prefab uses a glTF file.
[[nodiscard]] Result<Prefab> read_instance(
    const World& world, const PlacedLevel& level, const std::string& prefab, const Vec3& position);

}  // namespace limn
