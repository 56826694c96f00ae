#pragma once

#include "content/load/level/scene_warnings.h"

#include <vector>

namespace limn {

/// Part of find_scene_warnings: regions and shapes of a wrinkle_surface that its mesh lacks, and
/// wrinkle maps and masks that do not align.
void find_wrinkle_warnings(const World& world, std::vector<SceneWarning>& warnings);

}  // namespace limn
