#pragma once

#include "content/load/component_json.h"
#include "ecs/base/result.h"

#include <string_view>

namespace limn {

class World;

/// `--set path=value`: changes one field of a loaded scene.
///
///     lamp.point_light.intensity = 20  entity, component, field; further dots for fields of
///     structs exposure.ev = -1                 resource, field; made if the scene has none
///     materials.gold.roughness = 0.4   a material by name
///
/// `value` is JSON as a level has it; what is no JSON is taken as a string, so that words and
/// colors need no quotes: `materials.gold.base_color = #ffcc80`. All entities of that name are
/// changed. When it fails, nothing is.
[[nodiscard]] Status set_value(World& world, std::string_view path, std::string_view value);

/// Names of the entities and assets of a world, for reading and writing components as JSON. The
/// world must outlive them.
[[nodiscard]] FindNames find_names_in(const World& world);
[[nodiscard]] GiveNames give_names_of(const World& world);

}  // namespace limn
