#pragma once

#include "content/load/level_show.h"
#include "content/load/level_update.h"
#include "content/load/model_view.h"
#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/entity.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace limn {

class MadeAssets;
class World;

// Loads the SCENE of `limn play SCENE` into a world: a level by name, a level file or a model (glTF
// or Wavefront OBJ), which gets what is needed to look at it (model_view.h).

struct SceneOptions {
    std::optional<std::uint64_t> seed = {};  ///< overrides the level's
    ShowChoice show = {};                    ///< only levels have shows
    MadeAssets* made = nullptr;              ///< what levels loaded before have generated
    ModelViewOptions model = {};             ///< only models
};

struct LoadedScene {
    std::string name;       ///< "gallery": the file's, without folder and extension
    std::string title;      ///< one line to display; may be empty
    std::string path;       ///< of the file
    Bounds bounds;          ///< initial world-space bounds of everything drawn; may be empty
    Entity camera;          ///< the camera to render from, never null
    double duration = 0.0;  ///< of the longest camera path [s]; 0: none
    std::vector<LevelShow> shows;
    std::optional<LevelShow> show;      ///< the chosen one
    LevelFields fields;                 ///< of a level, for update_level
    std::optional<ModelView> model;     ///< of a model by itself
    std::vector<std::string> variants;  ///< of its materials: choices for ModelViewOptions
};

/// Fills `world`, which afterwards has the resources Assets, Environment, Rendering, Exposure,
/// FrameTime, RandomSeed and EventList. Registers all components. On failure, `world` is unchanged,
/// but where a show names a camera that the level does not have.
[[nodiscard]] Result<LoadedScene>
load_scene(World& world, const std::string& scene, const SceneOptions& options = {});

}  // namespace limn
