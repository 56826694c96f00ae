#pragma once

#include "content/bake/relief_map.h"
#include "ecs/base/result.h"

#include <string>

namespace limn {

/// Writes the first `channels` of a map, 1 (gray), 3 or 4: NAME.png with 8 bits, or 16 if `bits` is
/// more, or NAME.exr with floats. The file appears complete or not at all.
[[nodiscard]] Status
write_map(const std::string& path, const BakedMap& map, int channels, int bits);

/// "NAME_ending.png" of "NAME.png".
[[nodiscard]] std::string with_ending(const std::string& path, const std::string& ending);

}  // namespace limn
