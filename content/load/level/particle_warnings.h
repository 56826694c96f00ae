#pragma once

#include "content/load/level/scene_warnings.h"

#include <cstdint>
#include <string>
#include <vector>

namespace limn {

/// Of find_scene_warnings: emitters from which nothing can come, sources and surfaces that are not
/// there, flipbooks finer than their image, what particles of the GPU cannot do, bodies that cannot
/// move.
void find_particle_warnings(const World& world, std::vector<SceneWarning>& warnings);

/// A line for each emitter that has had no room for births.
[[nodiscard]] std::vector<SceneWarning> find_dropped_births(const World& world);

}  // namespace limn
