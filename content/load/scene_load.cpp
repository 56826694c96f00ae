#include "content/load/scene_load.h"

#include "content/load/faces/face_wrinkles.h"
#include "content/load/gltf/gltf_load.h"
#include "content/load/gltf/gltf_spawn.h"
#include "content/load/level/level_list.h"
#include "content/load/level/level_load.h"
#include "content/load/level/scene_warnings.h"
#include "content/load/motion/motion_scene.h"
#include "content/load/obj/obj_scene.h"
#include "content/load/scene_bounds.h"
#include "content/make/models/fur_coordinates.h"
#include "ecs/base/log.h"
#include "ecs/base/text.h"
#include "ecs/components/all.h"
#include "ecs/components/animation.h"
#include "ecs/components/camera.h"
#include "ecs/components/camera_path.h"
#include "ecs/components/environment.h"
#include "ecs/components/framing.h"
#include "ecs/components/gltf_source.h"
#include "ecs/components/name.h"
#include "ecs/components/post.h"
#include "ecs/components/rendering.h"
#include "ecs/components/sound_player.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace limn {

namespace {

bool ends_with_any(std::string_view text, std::initializer_list<std::string_view> endings) {
    std::string lower(text);
    std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) {
        return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    });
    return std::any_of(endings.begin(), endings.end(), [&](std::string_view ending) {
        return lower.ends_with(ending);
    });
}

/// The first few scenes in a folder: ", as DIR/a.glb DIR/b.obj"; empty if there are none.
std::string scenes_in(const std::string& folder) {
    std::vector<std::string> found;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        const std::string path = entry.path().string();
        if (ends_with_any(path, {".gltf", ".glb", ".obj", ".bvh", ".level.json"})) {
            found.push_back(path);
        }
    }
    std::sort(found.begin(), found.end());
    found.resize(std::min(found.size(), std::size_t{3}));
    return found.empty() ? std::string() : fmt::format(", as {}", fmt::join(found, " "));
}

template <typename T>
void insert_missing(World& world) {
    if (world.find_resource<T>() == nullptr) {
        world.insert_resource(T{});
    }
}

/// The first active camera, else the first one, else null.
Entity find_camera(World& world) {
    Entity camera;
    bool is_active = false;
    world.query<const Camera>().each([&](Entity entity, const Camera& candidate) {
        if (camera.is_null() || (candidate.active && !is_active)) {
            camera = entity;
            is_active = candidate.active;
        }
    });
    return camera;
}

/// The camera of a level that has none.
Entity add_camera(World& world, const Bounds& bounds) {
    Camera camera{.fov_y = radians(35.0f)};
    const float size = is_empty(bounds) ? 1.0f : glm::length(half_extent(bounds));
    camera.near = std::clamp(0.005f * size, 1e-4f, 0.1f);
    const Framing framing = frame_bounds(bounds, camera.fov_y, 16.0f / 9.0f);
    return world.create(
        Name{"framing camera"}, framing.camera, camera, FramingState{framing.aspect});
}

/// Adds the resources that every scene needs.
void complete_scene(World& world, const SceneOptions& options, LoadedScene& scene) {
    insert_missing<Assets>(world);
    insert_missing<Environment>(world);
    insert_missing<Rendering>(world);
    insert_missing<Exposure>(world);
    insert_missing<FrameTime>(world);
    insert_missing<RandomSeed>(world);
    insert_missing<EventList>(world);
    add_fur_coordinates(world);
    if (options.seed) {
        world.resource<RandomSeed>().seed = *options.seed;
    }
    scene.bounds = join_boxes(find_boxes(world, SceneMatrices(world)));
    world.query<const CameraPath>().each([&](const CameraPath& path) {
        scene.duration = std::max(scene.duration, camera_duration(path));
    });
}

/// Moves a model that is far from the origin to it: floats at 80 km have steps of 8 mm.
void move_to_origin(World& world, const std::vector<Entity>& roots) {
    constexpr float kFar = 100;  // of its radius
    const std::vector<Bounds> boxes = find_boxes(world, SceneMatrices(world));
    const std::vector<bool> scenery = find_scenery(boxes);
    Bounds subject;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (!scenery[i]) {
            grow(subject, boxes[i]);
        }
    }
    if (is_empty(subject)) {
        return;
    }
    const Vec3 subject_center = center(subject);
    if (glm::length(subject_center) > kFar * glm::length(half_extent(subject))) {
        for (const Entity root : roots) {
            world.get<Transform>(root).position -= subject_center;
        }
    }
}

/// The sound beside a model, NAME.wav, as `limn speak` writes it; it repeats with the clip.
void add_sound(World& world, const std::string& path) {
    const std::filesystem::path wave = std::filesystem::path(path).replace_extension(".wav");
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(wave, ignored)) {
        return;
    }
    SoundPlayer sound;
    sound.file = wave.filename().string();
    const auto& clips = world.resource<Assets>().clips;
    world.query<const ClipPlayer>().each([&](const ClipPlayer& player) {
        if (player.loop && player.clip.index < clips.size()) {
            const float duration = clips[player.clip.index].duration;
            sound.every = std::max(sound.every, static_cast<double>(duration));
        }
    });
    world.create(Name{"sound"}, std::move(sound));
}

Result<LoadedScene>
load_model_scene(World& world, const std::string& path, const SceneOptions& options) {
    Backdrop backdrop = LIMN_TRY(load_backdrop(options.model.backdrop));
    const bool is_gltf = ends_with_any(path, {".gltf", ".glb"});
    const LoadOptions& load = options.model.load;
    const std::string& variant = options.model.variant;
    if (!is_gltf && !variant.empty()) {
        return fail(
            "{}: found {} file, expected glTF with --variant", path,
            ends_with_any(path, {".bvh"}) ? "a BVH" : "an OBJ");
    }
    GltfScene model = LIMN_TRY(
        is_gltf                         ? load_gltf(path, {}, load, variant)
        : ends_with_any(path, {".bvh"}) ? load_bvh_scene(path, {}, load)
                                        : load_obj_scene(path, {}, load));
    LoadedScene scene;
    scene.name = model.name;
    scene.path = path;
    scene.variants = model.variants;
    insert_missing<Assets>(world);
    const std::string file = std::filesystem::path(path).filename().string();
    const std::vector<Entity> roots =
        spawn_gltf(world, world.resource<Assets>(), std::move(model)).roots;
    for (const Entity root : roots) {
        if (is_gltf) {  // levels can use no other
            world.add(root, GltfSource{file, variant});
        }
    }
    if (world.query<const MeshInstance>().empty()) {
        log_warn("{}: found no mesh to draw, expected one", path);
    }
    move_to_origin(world, roots);
    if (options.model.wrinkles) {
        add_face_wrinkles(world);
    }
    add_sound(world, path);
    complete_scene(world, options, scene);
    scene.model = add_model_view(world, std::move(backdrop), options.model.turntable);
    scene.camera = scene.model->camera;
    return scene;
}

Result<LoadedScene>
load_level_scene(World& world, const std::string& path, const SceneOptions& options) {
    Level level = LIMN_TRY(load_level(path, {}, options.show, options.made));
    LoadedScene scene;
    scene.name = level.name;
    scene.title = level.title;
    scene.path = path;
    scene.shows = std::move(level.shows);
    scene.show = std::move(level.show);
    scene.fields = remember_fields(level, path);
    const SourceFiles included = std::move(level.included);  // named by the positions
    const std::vector<SourcePosition> entity_positions = std::move(level.entity_positions);
    const std::vector<SourcePosition> event_positions = std::move(level.event_positions);
    const std::vector<Entity> entities = spawn_level(world, std::move(level));
    scene.fields.entities = entities;
    complete_scene(world, options, scene);
    for (const SceneWarning& warning : find_scene_warnings(world)) {
        const auto entity = std::find(entities.begin(), entities.end(), warning.entity);
        const SourcePosition at =
            warning.event >= 0 ? event_positions[static_cast<std::size_t>(warning.event)]
            : entity != entities.end()
                ? entity_positions[static_cast<std::size_t>(entity - entities.begin())]
                : SourcePosition{};
        log_warn("{}: {}", location_text(path, at), warning.text);
    }
    scene.camera = find_camera(world);
    if (scene.camera.is_null()) {
        scene.camera = add_camera(world, scene.bounds);
    }
    if (scene.show) {
        scene.camera = LIMN_TRY(place_show_camera(world, *scene.show, scene.camera));
    }
    return scene;
}

}  // namespace

Result<LoadedScene>
load_scene(World& world, const std::string& scene, const SceneOptions& options) {
    register_all_components();
    for (const char* const other : {".fbx", ".stl", ".ply", ".dae", ".blend", ".usd", ".usdz"}) {
        if (ends_with_any(scene, {other})) {
            return fail(
                "{}: format not supported, expected a level, .gltf, .glb, .obj or .bvh (Blender "
                "and most "
                "other tools export glTF)",
                scene);
        }
    }
    for (const char* const motion : {".trc", ".htr"}) {
        if (ends_with_any(scene, {motion})) {
            return fail(
                "{}: found recorded motion, expected a level or a model; `limn {}` makes one of it",
                scene, ends_with_any(scene, {".trc"}) ? "import markers" : "bake motion");
        }
    }
    if (ends_with_any(scene, {".gltf", ".glb", ".obj", ".bvh"})) {
        if (!options.show.technique.empty()) {
            return fail("{}: found a model, expected a level with --show", scene);
        }
        return load_model_scene(world, scene, options);
    }
    if (options.model.backdrop != ModelViewOptions{}.backdrop || options.model.turntable > 0
        || !options.model.variant.empty() || options.model.load.strict) {
        return fail(
            "{}: found a level, expected a model with --backdrop, --turntable, --variant and "
            "--strict",
            scene);
    }
    const bool is_path = ends_with_any(scene, {".json"}) || scene.find('/') != std::string::npos;
    const Result<std::string> path = is_path ? scene : find_level(scene);
    std::error_code error;
    if ((is_path || !path) && std::filesystem::is_directory(scene, error)) {
        return fail("{}: found a folder, expected a file{}", scene, scenes_in(scene));
    }
    return load_level_scene(world, LIMN_TRY(path), options);
}

}  // namespace limn
