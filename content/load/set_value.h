#pragma once

#include "ecs/base/result.h"

#include <string>
#include <string_view>

namespace limn {

class World;

/// `--set path=value`: changes one field of a loaded scene.
///
///     lamp.point_light.intensity = 20       entity, component, field; fields of structs by further
///     dots exposure.ev = -1                      resource, field materials.gold.roughness = 0.4 a
///     material by name
///
/// `value` is JSON as a level has it; what is no JSON is taken as a string, so that words and
/// colors need no quotes: `materials.gold.base_color = #ffcc80`. All entities of the name are
/// changed.
[[nodiscard]] Status set_value(World& world, std::string_view path, std::string_view value);

}  // namespace limn
