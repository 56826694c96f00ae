#pragma once

#include "ecs/base/result.h"

#include <string>

namespace limn {

/// `limn info`: what is in a level, a glTF file or a picture.
[[nodiscard]] Status run_info(const std::string& file);

}  // namespace limn
