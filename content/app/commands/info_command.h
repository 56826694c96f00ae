#pragma once

#include "ecs/base/result.h"

#include <string>

namespace limn {

// Shown by `limn info herd`: char.clip-layout
// Shown by `limn info museum`: engine.compact-data, engine.opt-vertex,
//     engine.render-object, shade.program-lifecycle
// Shown by `limn info my.level.json`: engine.object-text

/// `limn info`: prints the contents of a level, a glTF file, an image or the answers of viewers.
[[nodiscard]] Status run_info(const std::string& file);

}  // namespace limn
