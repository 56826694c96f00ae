#pragma once

#include "ecs/base/result.h"

#include <string>

namespace limn {

/// `limn check SCENE`: loads it, simulates a second and draws a frame. Prints every warning and
/// error as it occurs; fails if there was an error. Without OpenGL nothing is drawn, and the output
/// says so.
[[nodiscard]] Status run_check(const std::string& scene);

}  // namespace limn
