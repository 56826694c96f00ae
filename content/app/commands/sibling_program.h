#pragma once

#include "ecs/base/result.h"

#include <string>
#include <string_view>
#include <vector>

namespace limn {

// Shown by `limn quality fakephong`: fakephong.blinn-path, fakephong.metric-analytic,
//     fakephong.results
// Shown by `limn quality skinning`: char.skin-cpu

/// Replaces this process by the program of that name in its folder: `limn quality` is
/// `limn-quality`, `limn bench particles` is `limn-bench-particles`, so that this program contains
/// neither oracles nor references. `command` is for the error, as "limn quality". Returns only if
/// that fails.
[[nodiscard]] Status
run_sibling(std::string_view command, const std::string& name, std::vector<std::string> arguments);

}  // namespace limn
