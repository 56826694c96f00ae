#pragma once

#include "content/load/files/json_document.h"
#include "content/load/gltf/gltf_load.h"
#include "content/load/level/level_entities.h"
#include "content/load/level/level_include.h"
#include "content/load/level/level_nodes.h"
#include "content/load/level/level_show.h"
#include "content/load/level/level_update.h"
#include "content/load/made_assets.h"
#include "content/make/make_mesh.h"
#include "content/make/patterns/patterns.h"
#include "ecs/any_component.h"
#include "ecs/base/result.h"
#include "ecs/components/input.h"
#include "ecs/components/motion_graph.h"
#include "ecs/components/script.h"
#include "ecs/components/surface.h"
#include "ecs/prefab.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

class World;

// A level is JSON with comments, NAME.level.json. Every part is optional:
//
//     {
//       "title": "One line to display",
//       "resources": {                          // any registered resource, by name
//         "environment": {"sky": "studio"}, "exposure": {"ev": 0.5},
//         "random_seed": {"seed": 7}, "frame_time": {"step": 0.01}
//       },
//       "images": {                             // files are in the level's folder or below it
//         // the three images floor.base_color, floor.normal, floor.orm
//         "floor": {"make": "marble", "size": 512},
//         "leaf": {"file": "leaf.png"},         // color; data has "srgb": false
//         // in blocks: BC5 for the tangent-space normals of a material, BC7 for all else
//         "wall": {"make": "bricks", "compress": true}
//       },
//       "materials": {                          // fields of Material, and:
//         "gold": {"base_color": "#ffd27a", "metalness": 1, "roughness": 0.2},
//         "dull gold": {"like": "gold", "roughness": 0.6},      // a copy of an earlier one
//         "marble": {"pattern": "floor", "tiling": [4, 4]}      // all maps of a pattern
//       },
//       "include": ["fire.effect.json"],        // its prefabs and their assets: level_include.h
//       "meshes": {"pot": {"make": "teapot", "divisions": 12},
//                  "fox": {"make": "creature"}},   // with skeleton and skin "fox", "fox.run" ...
//       "motion_graphs": {"fox": GRAPH},        // ecs/components/motion_graph.h
//       "prefabs": {"lamp": NODE},
//       "entities": [NODE, ...],
//       "events": [EVENT, ...],
//       "shows": [SHOW, ...]                    // techniques, each on and off: level_show.h
//     }
//
// A NODE is an entity and its descendants. Every entity has a Transform.
//
//     {
//       "name": "lamp 1",          // unique in its prefab or the level; no '.'
//       "prefab": "lamp",          // starts as a copy of it; the other keys override it
//       "transform": {"position": [0, 2, 0], "rotation": [90, 0, 0]},
//       "point_light": {"color": "#ffcc80", "intensity": 30},
//       "spin": null,              // removes the prefab's
//       "gltf": "fox.glb",         // its roots become children
//       "variant": "street",       // of its materials
//       "nodes": NODES,            // changes of them: level_nodes.h
//       "clip_player": {"clip": "Run"},     // a clip of that file
//       "repeat": REPEAT,          // copies of it and its descendants
//       "children": [NODE, ...]    // after those of the prefab
//     }
//
// Components are described in content/load/level/component_json.h. A field of entity type names an
// entity of the same prefab, or else of the level. A `sway` without center swings about its
// entity's position. A `deformed` or `joint_attachment` without character follows its own entity,
// or the nearest ancestor, that has a `skeleton` or `morph_weights`. A glTF file with joints or
// morph targets makes its entity a character (gltf_spawn.h). A repeated entity called "post"
// becomes "post[0]", "post[1]" ... REPEAT and per-copy variation are in level_repeat.h, EVENT is in
// level_events.h; `limn components --schema` prints it all as JSON Schema.
//
// Loading has three steps, so that a bad file leaves no partial state: parse_level parses and
// validates the text only; load_level_assets reads the referenced files and generates meshes and
// images; spawn_level puts the level into a world and cannot fail.

/// Limits on untrusted levels.
struct LevelLimits {
    JsonLimits json = {};
    EntityLimits entities = {};
    std::uint64_t max_vertices = std::uint64_t{1} << 25;  ///< of all generated meshes
    std::uint64_t max_pixels = std::uint64_t{1} << 27;    ///< of all images
    GltfLimits gltf = {};
};

/// A name that is resolved after all files are read.
struct DeferredName {
    std::string name;
    SourcePosition at;
};

/// A mesh to generate.
struct LevelMesh {
    std::string name;
    const MeshKind* kind = nullptr;
    AnyComponent parameters;
};

/// An image to load, or a pattern to generate as three images.
struct LevelImage {
    std::string name;
    SourcePosition at;
    const PatternKind* pattern = nullptr;  ///< null: a file
    AnyComponent parameters;
    std::string file;  ///< relative to the level
    bool srgb = true;
    bool compress = false;    ///< to blocks, with mip levels
    std::uint32_t index = 0;  ///< of the (first) image in Level::assets
};

/// A file of fitted reflectance (brdf_file.h).
struct LevelBrdf {
    std::string file;  ///< relative to the level
    SourcePosition at;
    std::uint32_t material = 0;  ///< in Level::assets
};

struct Level {
    std::string file;   ///< path as given, for messages
    std::string name;   ///< "gallery"
    std::string title;  ///< may be empty
    std::vector<AnyComponent> resources;
    Bindings bindings;  ///< keys of actions; those not listed keep their defaults
    std::vector<LevelMesh> meshes;
    std::vector<LevelImage> images;
    std::vector<LevelBrdf> brdfs;
    std::vector<GltfUse> gltfs;
    std::vector<NodeChange> node_changes;
    /// All initial entities; roots have no Parent. Assets are indices into `assets`.
    Prefab entities;
    /// Entities outside the action's own prefab are level_entity(index in `entities`).
    EventList events;
    SourceFiles included;  ///< names of included files, which positions refer to
    std::vector<SourcePosition> entity_positions;  ///< of each of `entities`
    std::vector<SourcePosition> event_positions;   ///< of each of `events`
    std::vector<LevelShow> shows;
    std::optional<LevelShow> show;  ///< the chosen one, already applied

    /// Names of skeletons, skins and clips; components hold indices into this list until
    /// load_level_assets has read the files that define them.
    std::vector<DeferredName> deferred_names;
    std::vector<MotionGraphData> motion_graphs;  ///< their clips likewise

    Assets assets;  ///< materials after parse_level, the rest after load_level_assets
    std::vector<GltfScene> scenes;  ///< one for each of `gltfs`, after load_level_assets
};

/// Reads and checks `text`. `file` is the prefix of messages and gives the level its name. An error
/// is one line, or up to ten for parts that do not depend on each other, and how many are left.
/// Components must be registered (ecs/components/all.h).
[[nodiscard]] Result<Level>
parse_level(std::string_view text, const std::string& file, const LevelLimits& limits = {});

/// Fills `assets` and `scenes`; files are resolved under `folder`. Generates assets that are not in
/// `made`.
[[nodiscard]] Status load_level_assets(
    Level& level, const std::string& folder, const LevelLimits& limits = {},
    MadeAssets* made = nullptr);

/// Both, for the file `path`, after applying the chosen show.
[[nodiscard]] Result<Level> load_level(
    const std::string& path, const LevelLimits& limits = {}, const ShowChoice& choice = {},
    MadeAssets* made = nullptr);

/// Puts the level into the world: appends assets, replaces resources, creates entities in one
/// batch, inserts the EventList. Returns the entities in the order of `level.entities`.
std::vector<Entity> spawn_level(World& world, Level level);

/// The state that update_level compares with, after load_level; spawning adds `entities`.
[[nodiscard]] LevelFields remember_fields(const Level& level, const std::string& path);
/// Replaces indices of level entities in a component by the spawned entities.
void localize_component(AnyComponent& component, const std::vector<Entity>& entities);
/// Replaces the events of a level that was spawned as `entities`, into a world without assets.
void replace_events(World& world, EventList events, const std::vector<Entity>& entities);

}  // namespace limn
