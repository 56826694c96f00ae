#pragma once

#include "ecs/base/result.h"

namespace limn {

/// `limn levels`: name and title of every level, one per line.
[[nodiscard]] Status run_levels();

/// `limn components`: every component with its fields, units, ranges and defaults; with `schema`
/// the JSON Schema of a level file.
[[nodiscard]] Status run_components(bool schema);

}  // namespace limn
