#include "content/load/level_load.h"

#include "content/load/component_json.h"
#include "content/load/gltf_file.h"
#include "content/load/level_events.h"
#include "content/load/level_names.h"
#include "ecs/base/log.h"
#include "ecs/components/camera_path.h"
#include "ecs/components/transform.h"
#include "ecs/field_access.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <unordered_map>

namespace limn {

namespace {

const std::vector<std::string_view> kLevelKeys = {
    "title", "description", "resources", "images",   "materials",
    "paths", "meshes",      "prefabs",   "entities", "events"};
constexpr const char* kPatternMaps[] = {".base_color", ".normal", ".orm"};

using Names = std::unordered_map<std::string, std::uint32_t>;

std::vector<std::string_view> sorted_names(const Names& names) {
    std::vector<std::string_view> sorted;
    for (const auto& [name, index] : names) {
        sorted.emplace_back(name);
    }
    std::sort(sorted.begin(), sorted.end());
    return sorted;
}

/// Text to Level; the sections in such an order that names are known when they are used.
class LevelParser {
  public:
    LevelParser(const JsonValue& json, const std::string& file, const LevelLimits& limits)
        : json_(json), limits_(limits) {
        level_.file = file;
        const std::string name = std::filesystem::path(file).filename().string();
        level_.name = name.substr(0, name.find('.'));
    }

    Result<Level> parse();

  private:
    using ReadMember = Status (LevelParser::*)(const JsonMember&, const JsonPlace&);

    [[nodiscard]] JsonPlace place(std::string path) const { return {level_.file, std::move(path)}; }
    [[nodiscard]] Status read_keys();
    /// Calls `read` with every member of the object `section`, which may be missing.
    [[nodiscard]] Status read_section(const char* section, ReadMember read);
    [[nodiscard]] Status read_resource(const JsonMember& member, const JsonPlace& at);
    [[nodiscard]] Status read_image(const JsonMember& member, const JsonPlace& at);
    [[nodiscard]] Status read_material(const JsonMember& member, const JsonPlace& at);
    [[nodiscard]] Status
    read_pattern(const JsonValue& json, const JsonPlace& at, Material& material);
    [[nodiscard]] Status read_path(const JsonMember& member, const JsonPlace& at);
    [[nodiscard]] Status read_mesh(const JsonMember& member, const JsonPlace& at);
    [[nodiscard]] Status read_entities();
    [[nodiscard]] Status read_events(LevelEntities& entities);
    void place_cameras();
    [[nodiscard]] FindNames asset_names();
    [[nodiscard]] Names& names_of(std::string_view kind);

    const JsonValue& json_;
    LevelLimits limits_;
    Level level_;
    Names images_;
    Names materials_;
    Names paths_;
    Names meshes_;
    Names patterns_;  // by the name of the section; the index is that of the first image
};

Result<Level> LevelParser::parse() {
    Status status = read_keys();
    const std::pair<const char*, ReadMember> sections[] = {
        {"images", &LevelParser::read_image},
        {"materials", &LevelParser::read_material},
        {"paths", &LevelParser::read_path},
        {"meshes", &LevelParser::read_mesh},
        {"resources", &LevelParser::read_resource}};
    for (const auto& [section, read] : sections) {
        if (status) {
            status = read_section(section, read);
        }
    }
    if (status) {
        status = read_entities();
    }
    if (!status) {
        return status.error();
    }
    place_cameras();
    return std::move(level_);
}

Status LevelParser::read_keys() {
    if (json_.kind != JsonKind::Object) {
        return error_at(place(""), json_.at, describe(json_), "a level: an object");
    }
    for (const JsonMember& member : json_.members) {
        if (std::find(kLevelKeys.begin(), kLevelKeys.end(), member.key) == kLevelKeys.end()) {
            return error_at(
                place(""), member.at, "the key " + in_quotes(member.key),
                fmt::format("one of {}", fmt::join(kLevelKeys, " "))
                    + did_you_mean(member.key, kLevelKeys));
        }
    }
    for (const char* const key : {"title", "description"}) {
        const JsonValue* const text = json_.find(key);
        if (text != nullptr && text->kind != JsonKind::String) {
            return error_at(place(key), text->at, describe(*text), "a string");
        }
    }
    if (const JsonValue* const title = json_.find("title")) {
        level_.title = title->text;
    }
    return Done{};
}

Status LevelParser::read_section(const char* section, ReadMember read) {
    const JsonValue* const object = json_.find(section);
    if (object == nullptr) {
        return Done{};
    }
    if (object->kind != JsonKind::Object) {
        return error_at(place(section), object->at, describe(*object), "an object");
    }
    for (const JsonMember& member : object->members) {
        const Status status =
            (this->*read)(member, place(fmt::format("{}.{}", section, member.key)));
        if (!status) {
            return status;
        }
    }
    return Done{};
}

Status LevelParser::read_resource(const JsonMember& member, const JsonPlace& at) {
    const ComponentInfo* const info = find_resource(member.key);
    if (info == nullptr || info->ops.construct_default == nullptr) {
        return error_at(
            at, member.at, "the resource " + in_quotes(member.key),
            "one of `limn components`" + resource_suggestion(member.key));
    }
    Result<AnyComponent> resource = read_component(member.value, *info, at, asset_names());
    if (!resource) {
        return resource.error();
    }
    level_.resources.push_back(*std::move(resource));
    return Done{};
}

/// `json` without the keys that are not fields.
JsonValue without(const JsonValue& json, std::initializer_list<std::string_view> keys) {
    JsonValue rest = json;
    std::erase_if(rest.members, [&](const JsonMember& member) {
        return std::find(keys.begin(), keys.end(), member.key) != keys.end();
    });
    return rest;
}

Status LevelParser::read_image(const JsonMember& member, const JsonPlace& at) {
    const JsonValue& json = member.value;
    const JsonValue* const make = json.find("make");
    const JsonValue* const file = json.find("file");
    if ((make == nullptr) == (file == nullptr)) {
        return error_at(at, json.at, describe(json), "an object with either make or file");
    }
    LevelImage image;
    image.name = member.key;
    image.at = json.at;
    image.index = static_cast<std::uint32_t>(level_.assets.images.size());
    if (file != nullptr) {
        const JsonValue* const srgb = json.find("srgb");
        const bool good = file->kind == JsonKind::String
                          && (srgb == nullptr || srgb->kind == JsonKind::Bool)
                          && json.members.size() == (srgb == nullptr ? 1u : 2u);
        if (!good) {
            return error_at(
                at, json.at, "other keys or types",
                "{\"file\": \"path\", \"srgb\": true or false}");
        }
        image.file = file->text;
        image.srgb = srgb == nullptr || srgb->truth;
        images_[member.key] = image.index;
        level_.assets.images.emplace_back().name = member.key;
    } else {
        image.pattern = make->kind == JsonKind::String ? find_pattern_kind(make->text) : nullptr;
        if (image.pattern == nullptr) {
            return error_at(
                at, make->at, describe(*make),
                "a kind of pattern" + pattern_kind_suggestion(make->text));
        }
        Result<AnyComponent> parameters =
            read_component(without(json, {"make"}), *image.pattern->parameters, at, {});
        if (!parameters) {
            return parameters.error();
        }
        image.parameters = *std::move(parameters);
        patterns_[member.key] = image.index;
        for (const char* const map : kPatternMaps) {
            const std::string name = member.key + map;
            images_[name] = static_cast<std::uint32_t>(level_.assets.images.size());
            level_.assets.images.emplace_back().name = name;
        }
    }
    level_.images.push_back(std::move(image));
    return Done{};
}

/// The maps of a made image, and factors that leave them as they are.
Status LevelParser::read_pattern(const JsonValue& json, const JsonPlace& at, Material& material) {
    const auto pattern =
        json.kind == JsonKind::String ? patterns_.find(json.text) : patterns_.end();
    if (pattern == patterns_.end()) {
        return error_at(
            at, json.at, describe(json),
            "the name of one of \"images\" that is made"
                + did_you_mean(json.text, sorted_names(patterns_)));
    }
    const std::uint32_t first = pattern->second;
    material.base_color = Vec4(1);
    material.roughness = 1.0f;
    material.metalness = 1.0f;
    material.base_color_texture.image = {first};
    material.normal_texture.image = {first + 1};
    material.metal_rough_texture.image = {first + 2};
    material.occlusion_texture.image = {first + 2};
    return Done{};
}

Status LevelParser::read_material(const JsonMember& member, const JsonPlace& at) {
    const JsonValue& json = member.value;
    Material material;
    if (const JsonValue* const like = json.find("like")) {
        const auto other =
            like->kind == JsonKind::String ? materials_.find(like->text) : materials_.end();
        if (other == materials_.end()) {
            return error_at(
                at, like->at, describe(*like),
                "the name of a material before this one"
                    + did_you_mean(like->text, sorted_names(materials_)));
        }
        material = level_.assets.materials[other->second];
    }
    if (const JsonValue* const pattern = json.find("pattern")) {
        const Status status = read_pattern(*pattern, at, material);
        if (!status) {
            return status;
        }
    }
    material.name = member.key;
    const FindNames names = asset_names();
    Status status = read_struct(without(json, {"like", "pattern", "tiling"}), material, at, names);
    if (!status) {
        return status;
    }
    if (const JsonValue* const tiling = json.find("tiling")) {
        TextureSlot scaled;
        const FieldInfo* const scale = find_field(component_info<TextureSlot>().fields, "scale");
        status = read_field(*tiling, *scale, &scaled.scale, {at.file, at.path + ".tiling"}, names);
        for (TextureSlot* const slot :
             {&material.base_color_texture, &material.metal_rough_texture, &material.normal_texture,
              &material.occlusion_texture, &material.emission_texture}) {
            slot->scale = scaled.scale;
        }
    }
    materials_[member.key] = static_cast<std::uint32_t>(level_.assets.materials.size());
    level_.assets.materials.push_back(std::move(material));
    return status;
}

Status LevelParser::read_path(const JsonMember& member, const JsonPlace& at) {
    const Result<AnyComponent> shape =
        read_component(member.value, component_info<PathShape>(), at, {});
    if (!shape) {
        return shape.error();
    }
    Result<PathData> path = make_path(shape->as<PathShape>());
    if (!path) {
        return fail(
            "{}:{}:{}: {}: {}", at.file, member.value.at.line, member.value.at.column, at.path,
            path.error().message);
    }
    path->name = member.key;
    paths_[member.key] = static_cast<std::uint32_t>(level_.assets.paths.size());
    level_.assets.paths.push_back(*std::move(path));
    return Done{};
}

Status LevelParser::read_mesh(const JsonMember& member, const JsonPlace& at) {
    const JsonValue* const make = member.value.find("make");
    if (make == nullptr) {
        return error_at(at, member.value.at, describe(member.value), "an object with make");
    }
    LevelMesh mesh;
    mesh.name = member.key;
    mesh.kind = make->kind == JsonKind::String ? find_mesh_kind(make->text) : nullptr;
    if (mesh.kind == nullptr) {
        return error_at(
            at, make->at, describe(*make), "a kind of mesh" + mesh_kind_suggestion(make->text));
    }
    Result<AnyComponent> parameters =
        read_component(without(member.value, {"make"}), *mesh.kind->parameters, at, asset_names());
    if (!parameters) {
        return parameters.error();
    }
    mesh.parameters = *std::move(parameters);
    meshes_[member.key] = static_cast<std::uint32_t>(level_.meshes.size());
    level_.meshes.push_back(std::move(mesh));
    return Done{};
}

FindNames LevelParser::asset_names() {
    const auto names_of_kind = [this](std::string_view kind) -> const Names* {
        return kind == asset_kind<MeshId>       ? &meshes_
               : kind == asset_kind<MaterialId> ? &materials_
               : kind == asset_kind<ImageId>    ? &images_
               : kind == asset_kind<PathId>     ? &paths_
                                                : nullptr;
    };
    FindNames names;
    names.asset = [this, names_of_kind](
                      std::string_view kind,
                      std::string_view name) -> std::optional<std::uint32_t> {
        const Names* const all = names_of_kind(kind);
        if (all == nullptr) {  // files that are not read yet have them
            level_.late_names.emplace_back(name);
            return static_cast<std::uint32_t>(level_.late_names.size() - 1);
        }
        const auto found = all->find(std::string(name));
        return found == all->end() ? std::nullopt : std::optional(found->second);
    };
    names.all = [names_of_kind](std::string_view kind) {
        const Names* const all = names_of_kind(kind);
        return all == nullptr ? std::vector<std::string_view>() : sorted_names(*all);
    };
    return names;
}

Status LevelParser::read_entities() {
    const JsonValue* const prefabs = json_.find("prefabs");
    if (prefabs != nullptr && prefabs->kind != JsonKind::Object) {
        return error_at(place("prefabs"), prefabs->at, describe(*prefabs), "an object");
    }
    LevelEntities entities(level_.file, prefabs, asset_names(), limits_.entities);
    if (const JsonValue* const nodes = json_.find("entities")) {
        if (nodes->kind != JsonKind::Array) {
            return error_at(place("entities"), nodes->at, describe(*nodes), "an array");
        }
        for (std::size_t i = 0; i < nodes->items.size(); ++i) {
            const Status status = entities.add(nodes->items[i], fmt::format("entities[{}]", i));
            if (!status) {
                return status;
            }
        }
    }
    Status status = entities.resolve_names();
    if (status) {
        status = read_events(entities);
    }
    if (status) {
        status = entities.check_unused_prefabs();
    }
    level_.entities = std::move(entities.entities());
    level_.gltfs = std::move(entities.gltfs());
    return status;
}

Status LevelParser::read_events(LevelEntities& entities) {
    const JsonValue* const events = json_.find("events");
    if (events == nullptr) {
        return Done{};
    }
    if (events->kind != JsonKind::Array) {
        return error_at(place("events"), events->at, describe(*events), "an array");
    }
    FindNames names = asset_names();
    names.entity = [&](std::string_view name, SourcePosition) -> std::optional<Entity> {
        const std::int64_t index = entities.find(name);
        return index < 0 ? std::nullopt
                         : std::optional(prefab_entity(static_cast<std::uint32_t>(index)));
    };
    names.all = [&entities, assets = names.all](std::string_view kind) {
        return kind == "entity" ? entities.names() : assets(kind);
    };
    const ReadPrefab read_prefab = [&](const JsonValue& node, const JsonPlace& at) {
        return entities.read_prefab(node, at.path);
    };
    for (std::size_t i = 0; i < events->items.size(); ++i) {
        Result<ScriptEvent> event =
            read_event(events->items[i], place(fmt::format("events[{}]", i)), names, read_prefab);
        if (!event) {
            return event.error();
        }
        level_.events.events.push_back(*std::move(event));
    }
    return Done{};
}

template <typename T>
T* find_value(PrefabEntity& entity) {
    for (AnyComponent& component : entity.components) {
        if (&component.info() == &component_info<T>()) {
            return &component.as<T>();
        }
    }
    return nullptr;
}

/// Cameras with a path begin where it begins, so that the first picture is right.
void LevelParser::place_cameras() {
    std::vector<PrefabEntity>& entities = level_.entities.entities;
    for (PrefabEntity& entity : entities) {
        const auto* const path = find_value<CameraPath>(entity);
        auto* const transform = find_value<Transform>(entity);
        if (path == nullptr || transform == nullptr || path->keys.empty()) {
            continue;
        }
        Vec3 target = path->keys.front().look_at;
        if (path->target.index < entities.size()) {
            const auto* const followed = find_value<Transform>(entities[path->target.index]);
            target = followed != nullptr ? followed->position : target;
        }
        const CameraPose pose = camera_pose(*path, 0.0, target);
        transform->position = pose.position;
        transform->rotation = pose.rotation;
    }
}

// ---- assets -------------------------------------------------------------------------------------

std::string place_of(const Level& level, SourcePosition at, std::string_view path) {
    return fmt::format("{}:{}:{}: {}", level.file, at.line, at.column, path);
}

Status make_pattern(Level& level, const LevelImage& image, std::uint64_t& pixels_left) {
    const FieldInfo* const size = find_field(image.parameters.info().fields, "size");
    const auto side =
        size == nullptr ? 0.0 : get_number(*size, field_ptr(image.parameters.data(), *size));
    const auto pixels = static_cast<std::uint64_t>(3.0 * side * side);
    if (pixels > pixels_left) {
        return fail(
            "{}: found {} pixels, expected at most {} more in this level",
            place_of(level, image.at, "images." + image.name), pixels, pixels_left);
    }
    pixels_left -= pixels;
    PatternMaps maps = image.pattern->make(image.parameters.data());
    std::size_t index = image.index;
    for (ImageData* const map : {&maps.base_color, &maps.normal, &maps.orm}) {
        map->name = level.assets.images[index].name;
        level.assets.images[index++] = std::move(*map);
    }
    return Done{};
}

Status load_picture(
    Level& level, const LevelImage& image, const std::string& folder, const LevelLimits& limits,
    std::uint64_t& pixels_left) {
    const std::string place = place_of(level, image.at, "images." + image.name);
    const Result<std::vector<std::byte>> bytes =
        fetch_uri(image.file, folder, place, limits.gltf.max_bytes);
    if (!bytes) {
        return bytes.error();
    }
    ImageLimits image_limits = limits.gltf.image;
    image_limits.max_pixels =
        std::min(image_limits.max_pixels, static_cast<std::int64_t>(pixels_left));
    Result<ImageData> data =
        decode_image(*bytes, fmt::format("{}: {}", place, image.file), image.srgb, image_limits);
    if (!data) {
        return data.error();
    }
    pixels_left -=
        static_cast<std::uint64_t>(data->width) * static_cast<std::uint64_t>(data->height);
    if (const std::size_t bad = replace_non_finite(*data); bad > 0) {
        log_warn(
            "{}: {}: {} values are not finite; NaN became 0, infinity 65504", place, image.file,
            bad);
    }
    data->name = image.name;
    level.assets.images[image.index] = *std::move(data);
    return Done{};
}

/// Skeleton and skin have the name of the mesh, clips begin with it: "fox.walk".
void add_rig(Assets& assets, const std::string& name, MeshRig rig) {
    rig.skeleton.name = name;
    rig.skin.name = name;
    assets.skeletons.push_back(std::move(rig.skeleton));
    assets.skins.push_back(std::move(rig.skin));
    for (ClipData& clip : rig.clips) {
        clip.name = fmt::format("{}.{}", name, clip.name);
        assets.clips.push_back(std::move(clip));
    }
}

Status make_meshes(Level& level, const LevelLimits& limits) {
    std::uint64_t vertices = 0;
    for (const LevelMesh& mesh : level.meshes) {
        MeshData& data =
            level.assets.meshes.emplace_back(mesh.kind->make(mesh.parameters.data(), level.assets));
        data.name = mesh.name;
        if (mesh.kind->make_rig != nullptr) {
            add_rig(level.assets, mesh.name, mesh.kind->make_rig(mesh.parameters.data()));
        }
        vertices += data.positions.size();
        if (vertices > limits.max_vertices) {
            return fail(
                "{}: meshes.{}: found {} vertices so far, expected at most {} in all meshes",
                level.file, mesh.name, vertices, limits.max_vertices);
        }
    }
    return Done{};
}

Result<GltfScene> load_scene_file(
    const Level& level, const GltfUse& use, const std::string& folder, const LevelLimits& limits) {
    const Result<std::vector<std::byte>> bytes =
        fetch_uri(use.file, folder, place_of(level, use.at, "gltf"), limits.gltf.max_bytes);
    if (!bytes) {
        return bytes.error();
    }
    const std::filesystem::path path = std::filesystem::path(folder) / use.file;
    return parse_gltf(*bytes, path.string(), path.parent_path().string(), limits.gltf);
}

}  // namespace

Result<Level>
parse_level(std::string_view text, const std::string& file, const LevelLimits& limits) {
    const Result<JsonValue> json = parse_json(text, file, limits.json);
    if (!json) {
        return json.error();
    }
    return LevelParser(*json, file, limits).parse();
}

Status load_level_assets(Level& level, const std::string& folder, const LevelLimits& limits) {
    std::uint64_t pixels_left = limits.max_pixels;
    for (const LevelImage& image : level.images) {
        const Status status = image.pattern != nullptr
                                  ? make_pattern(level, image, pixels_left)
                                  : load_picture(level, image, folder, limits, pixels_left);
        if (!status) {
            return status;
        }
    }
    const Status status = make_meshes(level, limits);
    if (!status) {
        return status;
    }
    for (const GltfUse& use : level.gltfs) {
        Result<GltfScene> scene = load_scene_file(level, use, folder, limits);
        if (!scene) {
            return scene.error();
        }
        for (const std::string& warning : scene->warnings) {
            log_warn("{}", warning);
        }
        level.scenes.push_back(*std::move(scene));
    }
    return resolve_late_names(level);
}

Result<Level> load_level(const std::string& path, const LevelLimits& limits) {
    const Result<JsonValue> json = load_json(path, limits.json);
    if (!json) {
        return json.error();
    }
    Result<Level> level = LevelParser(*json, path, limits).parse();
    if (!level) {
        return level;
    }
    const std::string parent = std::filesystem::path(path).parent_path().string();
    const Status status = load_level_assets(*level, parent.empty() ? "." : parent, limits);
    if (!status) {
        return status.error();
    }
    return level;
}

}  // namespace limn
