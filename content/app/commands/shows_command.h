#pragma once

#include "ecs/base/result.h"

#include <string>
#include <vector>

namespace limn {

/// `limn shows [WORDS]`: the techniques whose id and names (technique_names.h) have all of the
/// words, a line each; or how to see the only one. Without words it lists all.
[[nodiscard]] Status run_shows(const std::vector<std::string>& words);

}  // namespace limn
