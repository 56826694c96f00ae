#pragma once

#include "ecs/entity.h"

#include <string>
#include <vector>

namespace limn {

class World;

/// One line, and what it is about.
struct SceneWarning {
    std::string text;
    Entity entity = {};  ///< null: no single entity
    int event = -1;      ///< index into the EventList; -1: none
};

/// What has no effect in a scene that was just loaded: a shadow without a light, an ocean without
/// water, a follower without a path, a second active camera ... Nothing of it is an error: a
/// component may wait for an event that adds what it needs.
[[nodiscard]] std::vector<SceneWarning> find_scene_warnings(const World& world);

}  // namespace limn
