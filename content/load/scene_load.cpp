#include "content/load/scene_load.h"

#include "content/load/gltf_load.h"
#include "content/load/gltf_spawn.h"
#include "content/load/level_list.h"
#include "content/load/level_load.h"
#include "ecs/base/text.h"
#include "ecs/components/all.h"
#include "ecs/components/animation.h"
#include "ecs/components/camera.h"
#include "ecs/components/camera_path.h"
#include "ecs/components/environment.h"
#include "ecs/components/light.h"
#include "ecs/components/name.h"
#include "ecs/components/post.h"
#include "ecs/components/rendering.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <unordered_map>

namespace limn {

namespace {

constexpr float kFramingAspect = 16.0f / 9.0f;

bool ends_with_any(std::string_view text, std::initializer_list<std::string_view> endings) {
    std::string lower(text);
    std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) {
        return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    });
    return std::any_of(endings.begin(), endings.end(), [&](std::string_view ending) {
        return lower.ends_with(ending);
    });
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

Entity add_framing_camera(World& world, const Bounds& bounds) {
    Camera camera{.fov_y = radians(35.0f)};  // like a portrait lens: little distortion
    const float size = is_empty(bounds) ? 1.0f : glm::length(half_extent(bounds));
    camera.near = std::clamp(0.005f * size, 1e-4f, 0.1f);
    return world.create(
        Name{"framing camera"}, frame_bounds(bounds, camera.fov_y, kFramingAspect), camera);
}

/// Three-point lighting relative to the camera: a warm key from the upper right, where the Studio
/// has its large soft box, a weak cool fill from the left, a rim light from behind that separates
/// the model from the background.
void add_light_rig(World& world, const Quat& camera) {
    struct RigLight {
        const char* name;
        Vec3 from;  ///< camera space: right, up, toward the camera
        Vec3 color;
        float illuminance;
    };
    constexpr RigLight kRig[] = {
        {"key light", {0.6f, 0.7f, 0.7f}, {1.0f, 0.94f, 0.86f}, 1.9f},
        {"fill light", {-0.9f, 0.1f, 0.6f}, {0.75f, 0.86f, 1.0f}, 0.25f},
        {"rim light", {-0.7f, 0.55f, -0.75f}, {0.9f, 0.95f, 1.0f}, 1.6f}};
    for (const RigLight& light : kRig) {
        Transform transform;
        transform.rotation = look_along(camera * -light.from);
        world.create(
            Name{light.name}, transform,
            DirectionalLight{.color = light.color, .illuminance = light.illuminance});
    }
}

bool has_lights(World& world) {
    return !world.query<const PointLight>().empty() || !world.query<const SpotLight>().empty()
           || !world.query<const DirectionalLight>().empty();
}

/// Bounds of meshes, skinned ones in the rest pose.
class RestBounds {
  public:
    RestBounds(const World& world, const Assets& assets) : world_(world), assets_(assets) {}

    const Bounds& of(Entity entity, const MeshInstance& instance) {
        const MeshData& mesh = assets_.meshes[instance.mesh.index];
        const Deformed* const deformed = world_.find<Deformed>(entity);
        const Skeleton* const character = deformed != nullptr && world_.alive(deformed->character)
                                              ? world_.find<Skeleton>(deformed->character)
                                              : nullptr;
        if (character == nullptr || deformed->skin.index >= assets_.skins.size()
            || character->skeleton.index >= assets_.skeletons.size()) {
            return mesh.bounds;
        }
        const SkinData& skin = assets_.skins[deformed->skin.index];
        const std::array key = {
            instance.mesh.index, deformed->skin.index, character->skeleton.index};
        const auto [found, is_new] = known_.try_emplace(key, mesh.bounds);
        if (is_new && fits(mesh, skin, assets_.skeletons[character->skeleton.index])) {
            found->second = posed_bounds(
                mesh, skin, find_rest_joints(assets_.skeletons[character->skeleton.index]));
        }
        return found->second;
    }

  private:
    /// Whether all joint indices are valid; a level may combine unrelated assets.
    static bool fits(const MeshData& mesh, const SkinData& skin, const SkeletonData& skeleton) {
        const auto below = [](const std::vector<std::uint16_t>& joints, std::size_t count) {
            return std::all_of(
                joints.begin(), joints.end(), [count](std::uint16_t j) { return j < count; });
        };
        return below(mesh.skin.joints, skin.joints.size())
               && below(skin.joints, skeleton.joints.size());
    }

    const World& world_;
    const Assets& assets_;
    std::map<std::array<std::uint32_t, 3>, Bounds> known_;
};

/// Bounds of everything drawn, from Transforms since WorldTransforms are not computed yet.
Bounds find_bounds(World& world) {
    const auto local = [&](Entity entity) {
        const Transform* const t = std::as_const(world).find<Transform>(entity);
        return t == nullptr ? Affine{} : affine_from(t->position, t->rotation, t->scale);
    };
    std::unordered_map<Entity, Affine> matrices;  // of those with a parent
    for (const HierarchyNode& node : hierarchy(world).nodes()) {
        const auto parent = matrices.find(node.parent);
        matrices[node.entity] =
            (parent == matrices.end() ? local(node.parent) : parent->second) * local(node.entity);
    }
    Bounds bounds;
    const Assets& assets = world.resource<Assets>();
    RestBounds rest(world, assets);
    world.query<const MeshInstance>().each([&](Entity entity, const MeshInstance& instance) {
        if (instance.mesh.index >= assets.meshes.size()) {
            return;
        }
        const auto matrix = matrices.find(entity);
        const Bounds box = transform_bounds(
            matrix == matrices.end() ? local(entity) : matrix->second, rest.of(entity, instance));
        if (!is_empty(box)) {
            grow(bounds, box);
        }
    });
    return bounds;
}

/// Adds the resources and the camera that every scene needs.
void complete_scene(World& world, const SceneOptions& options, LoadedScene& scene) {
    insert_missing<Assets>(world);
    insert_missing<Environment>(world);
    insert_missing<Rendering>(world);
    insert_missing<Exposure>(world);
    insert_missing<FrameTime>(world);
    insert_missing<RandomSeed>(world);
    insert_missing<EventList>(world);
    if (options.seed) {
        world.resource<RandomSeed>().seed = *options.seed;
    }
    scene.bounds = find_bounds(world);
    scene.camera = find_camera(world);
    if (scene.camera.is_null()) {
        scene.camera = add_framing_camera(world, scene.bounds);
    }
    world.query<const CameraPath>().each([&](const CameraPath& path) {
        scene.duration = std::max(scene.duration, camera_duration(path));
    });
}

Result<LoadedScene>
load_gltf_scene(World& world, const std::string& path, const SceneOptions& options) {
    GltfScene gltf = LIMN_TRY(load_gltf(path));
    LoadedScene scene;
    scene.name = gltf.name;
    scene.path = path;
    insert_missing<Assets>(world);
    (void)spawn_gltf(world, world.resource<Assets>(), std::move(gltf));
    // Dim enough that the light rig shows the shape; the neutral curve keeps the file's colors.
    world.insert_resource(Environment{.sky = SkyKind::Studio, .intensity = 0.6f});
    world.insert_resource(Exposure{.curve = ToneCurve::Neutral});
    complete_scene(world, options, scene);
    if (!has_lights(world)) {
        // The file's camera may be anywhere; the rig is placed for a camera that frames the model.
        add_light_rig(world, frame_bounds(scene.bounds, radians(35.0f), kFramingAspect).rotation);
    }
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
    (void)spawn_level(world, std::move(level));
    complete_scene(world, options, scene);
    if (scene.show) {
        scene.camera = LIMN_TRY(place_show_camera(world, *scene.show, scene.camera));
    }
    return scene;
}

}  // namespace

Result<LoadedScene>
load_scene(World& world, const std::string& scene, const SceneOptions& options) {
    register_all_components();
    if (ends_with_any(scene, {".gltf", ".glb"})) {
        if (!options.show.technique.empty()) {
            return fail("{}: found a glTF file, expected a level with --show", scene);
        }
        return load_gltf_scene(world, scene, options);
    }
    const bool is_path = ends_with_any(scene, {".json"}) || scene.find('/') != std::string::npos;
    if (is_path) {
        return load_level_scene(world, scene, options);
    }
    const std::string path = LIMN_TRY(find_level(scene));
    return load_level_scene(world, path, options);
}

}  // namespace limn
