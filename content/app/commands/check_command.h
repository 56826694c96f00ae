#pragma once

#include "ecs/base/result.h"

#include <string>

namespace limn {

/// `limn check SCENE`: loads it, simulates a second and draws a frame. Every warning and error is
/// printed as it comes; fails where there was an error. Without OpenGL nothing is drawn, and that
/// is said.
[[nodiscard]] Status run_check(const std::string& scene);

}  // namespace limn
