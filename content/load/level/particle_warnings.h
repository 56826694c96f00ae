#pragma once

#include "content/load/level/scene_warnings.h"

#include <cstdint>
#include <string>
#include <vector>

namespace limn {

/// Part of find_scene_warnings: emitters that emit nothing, missing sources and surfaces, flipbooks
/// finer than their image, features that GPU particles lack, bodies that cannot move.
void find_particle_warnings(const World& world, std::vector<SceneWarning>& warnings);

/// A line for each emitter that dropped new particles because it was full.
[[nodiscard]] std::vector<SceneWarning> find_dropped_births(const World& world);

}  // namespace limn
