#pragma once

#include "ecs/base/result.h"

#include <string>
#include <vector>

namespace limn {

/// `limn quality`: becomes the program `limn-quality` beside this one, with these arguments. It is
/// a program of its own so that this one does not contain the oracles. Returns only if that fails.
[[nodiscard]] Status run_quality(std::vector<std::string> arguments);

}  // namespace limn
