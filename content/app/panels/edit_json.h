#pragma once

#include "content/app/panels/undo.h"
#include "content/load/files/json_document.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace limn {

class World;

// What the inspector copies: text to paste into a level file.

/// `"point_light": {...}`
[[nodiscard]] std::string
component_as_json(const World& world, const ComponentInfo& info, const void* value);

/// The entity as in a level: its name, the fields of its components that differ from their
/// defaults, without internal components, and its children likewise; a second "glow" is "glow 2". A
/// node of a glTF file is in the "nodes" of the entity that references the file, without components
/// that refer to assets or entities, and without children.
[[nodiscard]] std::string entity_as_json(World& world, Entity entity);

/// A one-line hint for whoever edits the entity: that edits_as_json leaves its edits
/// out, or how it writes those of a copy made by `repeat`. Empty for other entities.
[[nodiscard]] std::string edit_note(const World& world, Entity entity);

/// Names and parents of entities before the edits. What the edits made has the name that it has
/// now.
class BeforeEdits {
  public:
    BeforeEdits(const World& world, std::span<const Edit> edits);
    [[nodiscard]] std::string name(Entity entity) const;  ///< "" without one
    [[nodiscard]] Entity parent(Entity entity) const;
    /// For an entity whose new name is saved.
    void take_new_name(Entity entity) { names_.erase(entity); }

  private:
    const World& world_;
    std::unordered_map<Entity, std::string> names_;
    std::unordered_map<Entity, Entity> parents_;
};

/// Living entities of the level that have another name than before.
[[nodiscard]] std::vector<Entity>
renamed_entities(const World& world, std::span<const Edit> edits, const BeforeEdits& before);

/// Entities that the edits made, deleted or moved, and that are still so.
struct TreeEdits {
    std::vector<Entity> made;     ///< living; parents before their children
    std::vector<Entity> deleted;  ///< of the level, with all below; likewise
    std::vector<Entity> moved;    ///< living, of the level, to another parent
};
[[nodiscard]] TreeEdits
tree_edits(const World& world, std::span<const Edit> edits, const BeforeEdits& before);

/// The edited fields of what the level defines, with their current values, as changes of its file.
/// A child is in the "nodes" of its outermost ancestor if a file or a prefab created it; copies
/// made by `repeat` are changed by an event. Removed components are null.
struct LevelEdits {
    struct Change {
        Entity entity;
        JsonValue components;
    };

    std::vector<Change> entities;
    JsonValue patch;                    ///< "resources", "materials"
    JsonValue copies;                   ///< what an event at time 0 sets
    std::vector<std::string> left_out;  ///< "edits of ...": what a level cannot say
};
[[nodiscard]] LevelEdits
level_edits(const World& world, std::span<const Edit> edits, const BeforeEdits& before);

/// An entity as in a level, without its children. Others have the names that they had before.
[[nodiscard]] JsonValue
entity_without_children(World& world, Entity entity, const BeforeEdits& before);

/// A patch of the level's file, in which "entities" is an array. What was made is below its parent
/// if that is a root, what was deleted is destroyed by an event. Comments say what was left out,
/// and what to move in the file.
[[nodiscard]] std::string edits_as_json(World& world, std::span<const Edit> edits);

}  // namespace limn
