#pragma once

#include <string>
#include <vector>

namespace limn {

class World;

/// What has no effect in a scene that was just loaded, a line each: a shadow without a light, an
/// ocean without water, a follower without a path, a second active camera ... Nothing of it is an
/// error: a component may wait for an event that adds what it needs.
[[nodiscard]] std::vector<std::string> find_scene_warnings(const World& world);

}  // namespace limn
