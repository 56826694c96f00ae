#pragma once

#include "content/load/level/component_json.h"
#include "ecs/base/result.h"
#include "ecs/components/script.h"
#include "ecs/entity.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace limn {

class World;
struct Level;

// Changes that a level makes to the nodes of a glTF file: "nodes" of the entity with "gltf", by the
// names of the nodes.
//
//     {
//       "name": "left lamp", "gltf": "lamp.glb",
//       "nodes": {
//         "Bulb": {"point_light": {"intensity": 40}},  // other fields keep the file's values
//         "Glass": {"mesh_instance": {"material": "amber"}, "no_shadow": {}},
//         "Sun": {"directional_light": null},          // removes it
//         "skin": {"wrinkle_surface": {}}              // the part of a node with this material
//       }
//     }

/// Sets fields of a component of a node, or removes it.
struct NodeChange {
    std::uint32_t entity = 0;  ///< that references the file: index into the level's entities
    std::string node;
    SourcePosition at;                    ///< of the name
    const ComponentInfo* info = nullptr;  ///< of the component
    ScriptAction set;                     ///< without a value: removes it
};

/// Appends the changes of the object `json`, the "nodes" of `entity`. Names of entities are those
/// that the level has around that entity.
[[nodiscard]] Status read_node_changes(
    const JsonValue& json, std::uint32_t entity, const JsonLocation& location,
    const NameResolver& names, std::vector<NodeChange>& changes);

/// Fails if a file has no node of that name. Changed nodes become entities, even joints.
[[nodiscard]] Status find_changed_nodes(Level& level);

/// Changes the nodes below `entities`, which spawn_level has created. Changes all nodes of a name,
/// and all parts of multi-part nodes whose material has that name. A mesh_instance of a multi-part
/// node applies to each part.
void apply_node_changes(
    World& world, std::span<const NodeChange> changes, std::span<const Entity> entities);

}  // namespace limn
