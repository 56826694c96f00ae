#pragma once

#include "ecs/base/result.h"

#include <string>

namespace limn {

/// `limn levels`: name and title of every level, one per line.
[[nodiscard]] Status run_levels();

/// `limn shows [ID]`: the techniques that levels show, a line each; or how to see one. An empty
/// `id` lists them all.
[[nodiscard]] Status run_shows(const std::string& id);

/// `limn components [NAME]`: what levels are made of, with fields, units, ranges and defaults as
/// levels write them; or only NAME. With `all` also what only systems use;
/// with `schema` the JSON Schema of a level file instead.
[[nodiscard]] Status run_components(const std::string& name, bool schema, bool all);

}  // namespace limn
