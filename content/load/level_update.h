#pragma once

#include "content/load/level_include.h"
#include "content/load/level_nodes.h"
#include "content/load/level_show.h"
#include "ecs/any_component.h"
#include "ecs/base/result.h"
#include "ecs/entity.h"

#include <cstddef>
#include <string>
#include <vector>

namespace limn {

class MadeAssets;
class World;

// Effects that follow their files: when a level or what it includes has changed on disk, the living
// entities get the fields that are different now, and keep all else, so that an emitter goes on
// with the particles that it has.

/// What the files of a level say of its entities. Empty for a level of more than 20,000 entities.
struct LevelFields {
    std::vector<std::string> files;                     ///< the level first, then what it includes
    std::vector<Entity> entities;                       ///< in the level's order
    std::vector<std::vector<AnyComponent>> components;  ///< of each, before it was spawned
    std::vector<std::string> assets;                    ///< names of all, which indices refer to
    std::vector<NodeChange> node_changes;               ///< of glTF files
};

/// Loads the level anew and sets the components whose values in the files are others than before,
/// and the level's events. Returns how many components that were. Fails, and changes nothing, with
/// the loader's error, or where the level has other entities, kinds of components, changes of glTF
/// nodes or assets now, which only loading it again can bring. `world` held nothing else when the
/// level was spawned.
[[nodiscard]] Result<std::size_t> update_level(
    World& world, LevelFields& fields, const ShowChoice& choice = {}, MadeAssets* made = nullptr);

}  // namespace limn
