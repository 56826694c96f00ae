#pragma once

#include "content/load/gltf_load.h"
#include "content/load/json_document.h"
#include "content/load/level_entities.h"
#include "content/make/make_mesh.h"
#include "content/make/patterns.h"
#include "ecs/any_component.h"
#include "ecs/base/result.h"
#include "ecs/components/script.h"
#include "ecs/components/surface.h"
#include "ecs/prefab.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

class World;

// A level is JSON with comments, NAME.level.json. All of its parts may be missing:
//
//     {
//       "title": "One line for people",
//       "resources": {                          // any registered resource, by name
//         "environment": {"sky": "studio"}, "exposure": {"ev": 0.5},
//         "random_seed": {"seed": 7}, "frame_time": {"step": 0.01}
//       },
//       "images": {                             // files lie in the level's own folder or below it
//         "floor": {"make": "marble", "size": 512},   // -> floor.base_color, floor.normal,
//         floor.orm "leaf": {"file": "leaf.png"},               // color; data has "srgb": false
//       },
//       "materials": {                          // fields of Material, and:
//         "gold": {"base_color": "#ffd27a", "metalness": 1, "roughness": 0.2},
//         "dull gold": {"like": "gold", "roughness": 0.6},      // a copy of an earlier one
//         "marble": {"pattern": "floor", "tiling": [4, 4]}      // all images of a made one
//       },
//       "meshes": {"pot": {"make": "teapot", "divisions": 12},
//                  "fox": {"make": "creature"}},   // with skeleton and skin "fox", "fox.run" ...
//       "prefabs": {"lamp": NODE},
//       "entities": [NODE, ...],
//       "events": [EVENT, ...]
//     }
//
// A NODE is an entity and what is below it. Every entity has a Transform.
//
//     {
//       "name": "lamp 1",          // unique among its neighbors; no '.'
//       "prefab": "lamp",          // begins as a copy of it; what follows is changed in it
//       "transform": {"position": [0, 2, 0], "rotation": [90, 0, 0]},
//       "point_light": {"color": "#ffcc80", "intensity": 30},
//       "spin": null,              // the prefab's is left out
//       "gltf": "fox.glb",         // its roots become children
//       "clip_player": {"clip": "Run"},     // a clip of that file
//       "repeat": REPEAT,          // as many of it, with what is below it
//       "children": [NODE, ...]    // after those of the prefab
//     }
//
// Components by name: content/load/component_json.h. A field that is an entity names one of the
// same prefab, or else one of the level. A `sway` without center swings about where its entity
// stands. A `deformed` or `joint_attachment` without character follows the entity it is on, or the
// nearest above, that has a `skeleton` or `morph_weights`. A glTF file with joints or morph targets
// makes its entity a character (gltf_spawn.h). A repeated entity called "post" becomes "post[0]",
// "post[1]" ... REPEAT and the ways its copies differ are in level_repeat.h, EVENT is in
// level_events.h; `limn components --schema` prints it all as JSON Schema.
//
// Loading has three steps, so that a bad file leaves nothing half done: parse_level reads and
// checks the text and touches nothing else; load_level_assets reads the files it names and makes
// its meshes and images; spawn_level puts it into a world and cannot fail.

/// What a file may cost.
struct LevelLimits {
    JsonLimits json = {};
    EntityLimits entities = {};
    std::uint64_t max_vertices = std::uint64_t{1} << 25;  ///< of the meshes made
    std::uint64_t max_pixels = std::uint64_t{1} << 27;    ///< of all images
    GltfLimits gltf = {};
};

/// A mesh to make.
struct LevelMesh {
    std::string name;
    const MeshKind* kind = nullptr;
    AnyComponent parameters;
};

/// An image to load, or the three images of a pattern to make.
struct LevelImage {
    std::string name;
    SourcePosition at;
    const PatternKind* pattern = nullptr;  ///< null: a file
    AnyComponent parameters;
    std::string file;  ///< relative to the level
    bool srgb = true;
    std::uint32_t index = 0;  ///< of the (first) image in Level::assets
};

struct Level {
    std::string file;   ///< as it was named, for messages
    std::string name;   ///< "gallery"
    std::string title;  ///< may be empty
    std::vector<AnyComponent> resources;
    std::vector<LevelMesh> meshes;
    std::vector<LevelImage> images;
    std::vector<GltfUse> gltfs;
    /// Everything that is there at the start; roots have no Parent. Assets are indices into
    /// `assets`.
    Prefab entities;
    /// Entities outside the action's own prefab are level_entity(number in `entities`).
    EventList events;

    /// Names of skeletons, skins and clips in components, which hold their places here until
    /// load_level_assets has read the files that they are in.
    std::vector<std::string> late_names;

    Assets assets;  ///< materials after parse_level, the rest after load_level_assets
    std::vector<GltfScene> scenes;  ///< one for each of `gltfs`, after load_level_assets
};

/// Reads and checks `text`. `file` begins the messages and gives the level its name. Components
/// must be registered (ecs/components/all.h).
[[nodiscard]] Result<Level>
parse_level(std::string_view text, const std::string& file, const LevelLimits& limits = {});

/// Fills `assets` and `scenes`; files are looked for under `folder`.
[[nodiscard]] Status
load_level_assets(Level& level, const std::string& folder, const LevelLimits& limits = {});

/// Both, for the file `path`.
[[nodiscard]] Result<Level> load_level(const std::string& path, const LevelLimits& limits = {});

/// Puts the level into the world: assets behind those there are, resources replaced, entities
/// created in one batch, EventList inserted. Returns the entities in the order of `level.entities`.
std::vector<Entity> spawn_level(World& world, Level level);

}  // namespace limn
