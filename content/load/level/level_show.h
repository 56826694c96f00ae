#pragma once

#include "content/load/files/error_list.h"
#include "content/load/files/json_document.h"
#include "content/load/level/level_list.h"
#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

class World;

// Shows of a level: for each technique (an id of TECHNIQUES.md) a patch that shows it, and one that
// shows the level without it.
//
//     "shows": [
//       {
//         "technique": "water.fresnel-approx",
//         "text": "The trough mirrors as much as a rational approximation says.",
//         "set": {"entities": {"trough water": {"water_look": {"fresnel": "approximate"}}}},
//         "off": {"entities": {"trough water": {"water_look": {"fresnel": "angle"}}}},
//         "time": 2,                                      // [s]
//         "camera": {"position": [5, 2, 12], "look_at": [3, 0, 9]},   // or the name of a camera
//         "equal": false                                  // true: both must look the same
//       }
//     ]
//
// On is the level with `set`; off is that with `off` as well, or the plain level if there is no
// `off`. Both are patches of the level (level_patch.h).

/// A camera position, with the lens of the level's camera.
struct ShowCamera {
    Vec3 position = {0, 1, 4};
    Vec3 look_at = {0, 0, 0};
    float fov_y = 0.0f;
};

LIMN_FIELDS(ShowCamera) {
    LIMN_FIELD(position, "position", "m");
    LIMN_FIELD(look_at, "point at the center of the image", "m");
    LIMN_FIELD(fov_y, "full vertical field of view; 0 = that of the level's camera", "rad", 0, 3.1);
}

struct LevelShow {
    std::string technique;
    std::string text;   ///< one sentence
    JsonValue set;      ///< null: the level as it is
    JsonValue off;      ///< null: the level without `set`
    double time = 0.0;  ///< of the image [s]
    bool equal = false;
    std::string camera_name;           ///< empty: the level's
    std::optional<ShowCamera> camera;  ///< instead of a name
};

/// The chosen show of a level; none if `technique` is empty.
struct ShowChoice {
    std::string technique;
    bool off = false;
};

/// The shows of a level, in file order; at most one per technique. `file` is for messages.
[[nodiscard]] Result<std::vector<LevelShow>>
read_shows(const JsonValue& level, std::string_view file);
/// The same, but skips shows with errors and collects the errors.
[[nodiscard]] std::vector<LevelShow>
read_shows(const JsonValue& level, std::string_view file, ErrorList& errors);

/// Applies the patches of `show` for on or off to the level. Fails if a patch names an entity
/// that the level does not have.
[[nodiscard]] Status
apply_show(const LevelShow& show, bool off, std::string_view file, JsonValue& level);

/// Finds the chosen show in the level and applies it; fails if the level does not show the
/// technique. Does nothing if none is chosen.
[[nodiscard]] Result<std::optional<LevelShow>>
choose_show(const ShowChoice& choice, std::string_view file, JsonValue& level);

/// Sets the camera of the show: returns the one it names, or a new one with the lens of `camera`.
[[nodiscard]] Result<Entity> place_show_camera(World& world, const LevelShow& show, Entity camera);

struct FoundShow {
    LevelEntry level;
    LevelShow show;
};

/// The shows of all levels (level_list.h), by level. A level that cannot be read is an error.
[[nodiscard]] Result<std::vector<FoundShow>> list_shows();

/// The first show of the technique; the error suggests the most similar id.
[[nodiscard]] Result<FoundShow> find_show(std::string_view technique);

}  // namespace limn
