#pragma once

#include "content/load/level_load.h"
#include "ecs/base/result.h"

namespace limn {

/// Puts indices of assets in the place of Level::late_names, once all files are read: the names of
/// skeletons, skins and clips, which the level's glTF files and made meshes bring. Looks in the
/// file of the entity itself first, then in what the level makes, then in its files in their order.
/// The indices count the level's assets, then those of `scenes`. Fails at a name that nobody has.
[[nodiscard]] Status resolve_late_names(Level& level);

}  // namespace limn
