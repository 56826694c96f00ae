#pragma once

#include "content/app/panels/undo.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <span>
#include <string>

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
/// of the level's file. Children are in the "nodes" of their outermost ancestor, copies made by
/// `repeat` in an event. Unnamed entities and children of copies are left out; removed components
/// are null. What was made is below its parent, what was deleted in an event; a comment says what
/// to move.
[[nodiscard]] std::string edits_as_json(World& world, std::span<const Edit> edits);

}  // namespace limn
