#pragma once

#include "content/load/level/level_load.h"
#include "ecs/base/result.h"

namespace limn {

/// Resolves Level::deferred_names to asset indices after all files are read: the names of
/// skeletons, skins and clips, which glTF files and generated meshes define. Searches the entity's
/// own glTF file first, then the generated meshes, then the glTF files in order. Indices count the
/// level's assets, then those of `scenes`. Fails on unknown names, with a line for each.
[[nodiscard]] Status resolve_deferred_names(Level& level);

}  // namespace limn
