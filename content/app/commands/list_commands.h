#pragma once

#include "ecs/base/result.h"

#include <string>

namespace limn {

// Shown by `limn components`: engine.type-registry
// Shown by `limn components point_light`: engine.param-desc

/// `limn levels`: name and title of every level, one per line.
[[nodiscard]] Status run_levels();

/// `limn components [NAME]`: what levels are made of, with fields, units, ranges and defaults as
/// levels write them; or only NAME. With `all` also what only systems use;
/// with `schema` the JSON Schema of a level file instead.
[[nodiscard]] Status run_components(const std::string& name, bool schema, bool all);

}  // namespace limn
