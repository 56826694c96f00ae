#pragma once

#include "content/load/files/json_document.h"
#include "ecs/base/result.h"

#include <memory>
#include <string>
#include <vector>

namespace limn {

// Libraries of effects: a level can use the images, materials, paths, meshes and prefabs of the
// files in its "include" as its own.
//
//     "include": ["fire.effect.json"]
//
// Files are searched beside the level, then in the `effects` folder next to each folder of levels
// (level_list.h). Definitions of the level override included ones of the same name, and later files
// override earlier ones. Included files have no "include" of their own.

/// Names that positions in included files point to (SourcePosition::file).
using SourceFiles = std::vector<std::shared_ptr<const std::string>>;

/// Adds the sections of all included files to `level`, which was read from `path`. Fails with file
/// and position if a file is not found or has other sections.
[[nodiscard]] Result<SourceFiles>
include_files(JsonValue& level, const std::string& path, const JsonLimits& limits);

}  // namespace limn
