#pragma once

#include "content/app/panels/undo.h"
#include "content/load/files/json_document.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <optional>
#include <span>
#include <string>
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

/// The edited fields of components, resources and materials with their current values, as a patch
/// of the level's file, in which "entities" is an array. Children are in the "nodes" of their
/// outermost ancestor, copies made by `repeat` in an event, which also destroys what was deleted;
/// removed components are null. What was made is below its parent if that is a root, or else moved.
struct LevelEdits {
    /// To another parent, which a patch cannot say.
    struct Move {
        std::string entity;                 ///< its name, or ""
        std::optional<std::string> parent;  ///< likewise; none: it is a root now
    };

    JsonValue patch;
    std::vector<Move> moves;
    std::vector<std::string> left_out;  ///< edits of what a level cannot refer to: "edits of ..."
};

[[nodiscard]] LevelEdits level_edits(World& world, std::span<const Edit> edits);

/// `"lamp" to the children of "post"`
[[nodiscard]] std::string describe_move(const LevelEdits::Move& move);

/// The patch; comments say what was left out, and what to move in the file.
[[nodiscard]] std::string edits_as_json(World& world, std::span<const Edit> edits);

}  // namespace limn
