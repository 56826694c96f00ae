#pragma once

#include "ecs/entity.h"

#include <string>
#include <string_view>
#include <vector>

namespace limn {

class World;

/// One line, and the entity or event that it is about.
struct SceneWarning {
    std::string text;
    Entity entity = {};  ///< null: no single entity
    int event = -1;      ///< index into the EventList; -1: none
};

/// What has no effect in a scene that was just loaded: a shadow without a light, an ocean without
/// water, a follower without a path, a second active camera ... None of these is an error: a
/// component may wait for an event that adds what it needs.
[[nodiscard]] std::vector<SceneWarning> find_scene_warnings(const World& world);

/// `entity "lamp"`, or its index.
[[nodiscard]] std::string label_of(const World& world, Entity entity);
/// Whether a component has this name; false for an empty one.
[[nodiscard]] bool has_component(const World& world, Entity entity, std::string_view name);

}  // namespace limn
