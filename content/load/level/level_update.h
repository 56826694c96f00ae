#pragma once

#include "content/load/level/level_include.h"
#include "content/load/level/level_nodes.h"
#include "content/load/level/level_show.h"
#include "ecs/any_component.h"
#include "ecs/base/result.h"
#include "ecs/components/motion_graph.h"
#include "ecs/components/surface.h"
#include "ecs/entity.h"

#include <cstdint>
#include <string>
#include <vector>

namespace limn {

class MadeAssets;
class World;

// Hot reload of fields: when a level or an included file has changed on disk, the running level's
// entities get the fields that differ, and keep everything else, so that an emitter keeps its
// particles.

/// The entities of a level as its files define them. Empty for levels of more than 20,000 entities.
struct LevelFields {
    std::vector<std::string> files;                     ///< the level first, then included files
    std::vector<Entity> entities;                       ///< in the level's order
    std::vector<std::vector<AnyComponent>> components;  ///< of each, before spawning
    std::vector<std::string> assets;                    ///< names of all, which indices refer to
    std::vector<AnyComponent> resources;
    std::vector<Material> materials;
    std::vector<MotionGraphData> motion_graphs;  ///< of the world: also those that were removed
    std::vector<NodeChange> node_changes;        ///< of glTF files
};

enum class LevelPart : std::uint8_t { Component, Resource, Material, MotionGraph };

/// Fields of a component, resource, material or motion graph whose values in the files have
/// changed.
struct LevelChange {
    LevelPart part = LevelPart::Component;
    Entity entity;                         ///< of a Component
    std::uint32_t material = 0;            ///< index into Assets, or of a motion graph
    AnyComponent now;                      ///< the values in the files
    std::vector<const FieldInfo*> fields;  ///< the changed ones, at least one
};

/// Loads the level again and sets the fields of components, resources and materials whose values in
/// the files have changed, and the level's events; also applies what new events set at the start of
/// the level. Motion graphs that have changed are replaced in the next step (MotionGraphs::edits),
/// new ones are added, and those that were removed stay unused. Returns the changes. Fails, and
/// changes nothing, with the loader's error, or if entities, kinds of components, changes of glTF
/// nodes, assets or what events remove at the start differ, which needs a reload. `world` must have
/// been empty when the level was spawned.
[[nodiscard]] Result<std::vector<LevelChange>> update_level(
    World& world, LevelFields& fields, const ShowChoice& choice = {}, MadeAssets* made = nullptr);

/// Copies the changed fields to `value`, of the same type.
void adopt_change(const LevelChange& change, AnyComponent& value);

/// The same for one type.
[[nodiscard]] bool same_value(const AnyComponent& a, const AnyComponent& b);

}  // namespace limn
