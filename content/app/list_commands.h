#pragma once

#include "ecs/base/result.h"

#include <string>

namespace limn {

/// `limn levels`: name and title of every level, one per line.
[[nodiscard]] Status run_levels();

/// `limn shows [ID]`: the techniques that levels show, a line each; or how to see one. An empty
/// `id` lists them all.
[[nodiscard]] Status run_shows(const std::string& id);

/// `limn components`: every component with its fields, units, ranges and defaults; with `schema`
/// the JSON Schema of a level file.
[[nodiscard]] Status run_components(bool schema);

}  // namespace limn
