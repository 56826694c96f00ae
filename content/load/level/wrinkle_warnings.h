#pragma once

#include "content/load/level/scene_warnings.h"

#include <vector>

namespace limn {

/// Part of find_scene_warnings: regions and shapes of a wrinkle_surface that its mesh lacks,
/// wrinkle maps and masks that do not align, ladders out of order, regions that respond twice.
void find_wrinkle_warnings(const World& world, std::vector<SceneWarning>& warnings);

}  // namespace limn
