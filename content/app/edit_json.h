#pragma once

#include "content/app/undo.h"
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

/// The entity as a level has it: its name and every component that levels may set.
[[nodiscard]] std::string entity_as_json(const World& world, Entity entity);

/// The edited components, resources and materials with their present values: what a level's file
/// has to be changed to. Nameless entities are left out; removed components are null.
[[nodiscard]] std::string edits_as_json(const World& world, std::span<const Edit> edits);

}  // namespace limn
