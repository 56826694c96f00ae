#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/entity.h"

#include <cstdint>
#include <optional>
#include <string>

namespace limn {

class World;

// Whatever `limn play SCENE` may name, into a world: a level by name, a level file, a glTF file. A
// glTF without a level around it gets what it needs to be looked at: a camera that frames it
// (unless it has one), three lights if it has none, and the Studio surroundings.

struct SceneOptions {
    std::optional<std::uint64_t> seed;  ///< instead of the level's
};

struct LoadedScene {
    std::string name;       ///< "gallery": the file's, without folder and endings
    std::string title;      ///< one line for people; may be empty
    std::string path;       ///< of the file
    Bounds bounds;          ///< of what is drawn, world space, at the start; may be empty
    Entity camera;          ///< the one to look through, never null
    double duration = 0.0;  ///< of the longest camera path [s]; 0: none
};

/// Fills `world`, whose resources Assets, Environment, Exposure, FrameTime, RandomSeed and
/// EventList are there afterwards. Registers all components. The world is untouched if this fails.
[[nodiscard]] Result<LoadedScene>
load_scene(World& world, const std::string& scene, const SceneOptions& options = {});

}  // namespace limn
