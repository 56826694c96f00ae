#pragma once

#include "content/load/files/json_document.h"
#include "ecs/base/result.h"

#include <memory>
#include <string>
#include <vector>

namespace limn {

// Libraries of effects: a level names files in "include", whose images, materials, paths, meshes
// and prefabs it can use as its own.
//
//     "include": ["fire.effect.json"]
//
// A file is searched beside the level, then in the `effects` folder next to each folder of levels
// (level_list.h). What the level defines itself replaces what it includes by the same name, and a
// later file replaces an earlier one. Files that are included have no "include" of their own.

/// Names that positions in included files point to (SourcePosition::file).
using SourceFiles = std::vector<std::shared_ptr<const std::string>>;

/// Adds the sections of all included files to `level`, which was read from `path`. Fails with file
/// and position where a file is not found, or has other sections.
[[nodiscard]] Result<SourceFiles>
include_files(JsonValue& level, const std::string& path, const JsonLimits& limits);

}  // namespace limn
