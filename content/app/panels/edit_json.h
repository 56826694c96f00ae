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

/// The entity as a level has it: its name, the fields of its components that differ from their
/// defaults, without what systems keep, and its children likewise; a second "glow" is "glow 2". A
/// node of a glTF file is in the "nodes" of the entity that places the file, without the components
/// that name assets or entities and without children.
[[nodiscard]] std::string entity_as_json(World& world, Entity entity);

/// What somebody who edits the entity should know, in a line: that edits_as_json leaves its edits
/// out, or how it keeps those of a copy that `repeat` made. Empty for others.
[[nodiscard]] std::string edit_note(const World& world, Entity entity);

/// The edited fields of components, resources and materials with their present values, as a level
/// has them: what its file has to be changed to. Children are in the "nodes" of their outermost
/// parent, copies that `repeat` made in an event. Nameless entities and children of copies are left
/// out; removed components are null.
[[nodiscard]] std::string edits_as_json(const World& world, std::span<const Edit> edits);

}  // namespace limn
