#pragma once

#include "content/load/level/level_include.h"
#include "content/load/level/level_nodes.h"
#include "content/load/level/level_show.h"
#include "ecs/any_component.h"
#include "ecs/base/result.h"
#include "ecs/components/surface.h"
#include "ecs/entity.h"

#include <cstdint>
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
    std::vector<AnyComponent> resources;
    std::vector<Material> materials;
    std::vector<NodeChange> node_changes;  ///< of glTF files
};

enum class LevelPart : std::uint8_t { Component, Resource, Material };

/// Fields of a component, resource or material that the files have other values for than before.
struct LevelChange {
    LevelPart part = LevelPart::Component;
    Entity entity;                         ///< of a Component
    std::uint32_t material = 0;            ///< index into Assets
    AnyComponent now;                      ///< what the files say
    std::vector<const FieldInfo*> fields;  ///< those that are others, at least one
};

/// Loads the level anew and sets the fields of components, resources and materials whose values in
/// the files are others than before, and the level's events; what new ones set at the start of the
/// level is set as well. Returns what has changed. Fails, and
/// changes nothing, with the loader's error, or where the level has other entities, kinds of
/// components, changes of glTF nodes or assets now, which only loading it again can bring. `world`
/// held nothing else when the level was spawned.
[[nodiscard]] Result<std::vector<LevelChange>> update_level(
    World& world, LevelFields& fields, const ShowChoice& choice = {}, MadeAssets* made = nullptr);

/// Copies the changed fields to `value`, of the same type.
void adopt_change(const LevelChange& change, AnyComponent& value);

/// Of one type.
[[nodiscard]] bool same_value(const AnyComponent& a, const AnyComponent& b);

}  // namespace limn
