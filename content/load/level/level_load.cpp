#include "content/load/level/level_load.h"

#include "content/load/files/error_list.h"
#include "content/load/files/file_uri.h"
#include "content/load/level/component_json.h"
#include "content/load/level/level_assets.h"
#include "content/load/level/level_events.h"
#include "content/load/level/level_hints.h"
#include "content/load/level/level_names.h"
#include "content/load/level/motion_graph_json.h"
#include "ecs/base/log.h"
#include "ecs/base/text.h"
#include "ecs/components/camera_path.h"
#include "ecs/components/ink.h"
#include "ecs/components/transform.h"
#include "ecs/field_access.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <unordered_map>

// Techniques: engine.object-text

namespace limn {

namespace {

struct LevelKey {
    std::string_view name;
    JsonKind kind;
};
constexpr LevelKey kLevelKeys[] = {
    {"title", JsonKind::String},     {"description", JsonKind::String},
    {"include", JsonKind::Array},  // read by load_level
    {"resources", JsonKind::Object}, {"images", JsonKind::Object},
    {"materials", JsonKind::Object}, {"paths", JsonKind::Object},
    {"meshes", JsonKind::Object},    {"motion_graphs", JsonKind::Object},
    {"prefabs", JsonKind::Object},   {"entities", JsonKind::Array},
    {"events", JsonKind::Array},     {"bindings", JsonKind::Object},
    {"shows", JsonKind::Array},      {"$schema", JsonKind::String},  // for editors
};
using Names = std::unordered_map<std::string, std::uint32_t>;

std::vector<std::string_view> sorted_names(const Names& names) {
    std::vector<std::string_view> sorted;
    for (const auto& [name, index] : names) {
        sorted.emplace_back(name);
    }
    std::sort(sorted.begin(), sorted.end());
    return sorted;
}

/// `json` without `keys`.
JsonValue without(const JsonValue& json, std::initializer_list<std::string_view> keys) {
    JsonValue rest = json;
    std::erase_if(rest.members, [&](const JsonMember& member) {
        return std::find(keys.begin(), keys.end(), member.key) != keys.end();
    });
    return rest;
}

/// JSON to Level; sections are read in an order in which names are defined before their use.
class LevelParser {
  public:
    LevelParser(const JsonValue& json, const std::string& file, const LevelLimits& limits)
        : json_(json), limits_(limits), errors_(file) {
        level_.file = file;
        const std::string name = std::filesystem::path(file).filename().string();
        level_.name = name.substr(0, name.find('.'));
    }

    /// If it has errors, also reports those of the files that it references under `folder`.
    Result<Level> parse(const std::string& folder) {
        LIMN_TRY(expect(json_, JsonKind::Object, location(""), "a level (an object)"));
        check_keys();
        level_.title = json_["title"].text;
        read_section("images", &LevelParser::read_image);
        read_section("materials", &LevelParser::read_material);
        read_section("paths", &LevelParser::read_path);
        read_section("meshes", &LevelParser::read_mesh);
        read_section("motion_graphs", &LevelParser::read_graph);
        read_section("resources", &LevelParser::read_resource);
        read_section("bindings", &LevelParser::read_binding);
        read_entities();
        level_.shows = read_shows(json_, level_.file, errors_);
        if (!errors_.empty() && !folder.empty()) {
            check_files(folder);
        }
        LIMN_TRY(errors_.status());
        place_cameras();
        return std::move(level_);
    }

  private:
    [[nodiscard]] JsonLocation location(std::string path) const {
        return {level_.file, std::move(path)};
    }

    void check_keys() {
        std::vector<std::string_view> names;
        for (const LevelKey& key : kLevelKeys) {
            names.push_back(key.name);
        }
        for (const JsonMember& member : json_.members) {
            if (std::find(names.begin(), names.end(), member.key) == names.end()) {
                errors_.keep(error_at(
                    location(""), member.at, "the key " + in_quotes(member.key),
                    fmt::format("one of {}", fmt::join(names, " "))
                        + where_it_belongs(member.key, did_you_mean(member.key, names))));
            }
        }
        for (const auto& [name, kind] : kLevelKeys) {
            if (const JsonValue* const value = json_.find(name)) {
                errors_.keep(expect(
                    *value, kind, location(std::string(name)),
                    kind == JsonKind::String   ? "a string"
                    : kind == JsonKind::Object ? "an object"
                                               : "an array"));
            }
        }
        has_bad_keys_ = !errors_.empty();
    }

    void read_section(
        const char* section, Status (LevelParser::*read)(const JsonMember&, const JsonLocation&)) {
        for (const JsonMember& member : json_[section].members) {
            if (!errors_.has_room()) {
                break;
            }
            errors_.keep(
                (this->*read)(member, location(fmt::format("{}.{}", section, member.key))));
        }
    }

    /// Whether `name` is in the section, or may be in one that could not be read, but its
    /// definition had an error; then it reports no further one.
    [[nodiscard]] bool has_failed(const char* section, std::string_view name) const {
        const std::string made(name.substr(0, name.rfind('.')));  // "stone" of "stone.normal"
        const JsonValue& names = json_[section];
        return has_bad_keys_
               || (!errors_.empty()
                   && (names.find(name) != nullptr
                       || (names.find(made) != nullptr && !patterns_.contains(made))));
    }

    /// For a level whose loading ends here.
    void check_files(const std::string& folder) {
        const auto check = [&](const std::string& file, SourcePosition at, std::string_view path) {
            const Result<std::vector<std::byte>> bytes =
                fetch_uri(file, folder, location_of(level_, at, path), limits_.gltf.max_bytes);
            errors_.keep(bytes ? Status(Done{}) : bytes.error());
        };
        for (const LevelImage& image : level_.images) {
            if (!image.file.empty()) {
                check(image.file, image.at, "images." + image.name);
            }
        }
        for (const GltfUse& use : level_.gltfs) {
            check(use.file, use.at, "gltf");
        }
    }

    Status read_resource(const JsonMember& member, const JsonLocation& at) {
        const ComponentInfo* const info = find_resource(member.key);
        if (info == nullptr || info->ops.construct_default == nullptr) {
            return error_at(
                at, member.at, "the resource " + in_quotes(member.key),
                "one of `limn components`"
                    + where_it_belongs(member.key, resource_suggestion(member.key)));
        }
        if (is_internal(*info)) {
            log_warn(
                "{}: {}: systems keep this resource and overwrite what is written here",
                location_text(level_.file, member.at), at.path);
        }
        level_.resources.push_back(
            LIMN_TRY(read_component(member.value, *info, at, asset_names())));
        return Done{};
    }

    Status read_binding(const JsonMember& member, const JsonLocation& at) {
        const std::vector<std::string_view> actions = action_names();
        if (std::find(actions.begin(), actions.end(), member.key) == actions.end()) {
            return error_at(
                at, member.at, "the action " + in_quotes(member.key),
                "the name of one" + did_you_mean(member.key, actions));
        }
        LIMN_TRY(expect(member.value, JsonKind::Array, at, "an array of keys"));
        Bindings::Binding binding{member.key, {}};
        const std::vector<std::string_view>& known = key_names();
        for (const JsonValue& key : member.value.items) {
            if (std::find(known.begin(), known.end(), key.text) == known.end()) {
                return error_at(
                    at, key.at, describe(key),
                    "a key such as \"A\", \"7\", \"Left\" or \"Shift\" that the program does not "
                    "use");
            }
            binding.keys.push_back(key.text);
        }
        level_.bindings.bindings.push_back(std::move(binding));
        return Done{};
    }

    Status read_image(const JsonMember& member, const JsonLocation& at) {
        const JsonValue& json = member.value;
        const JsonValue* const make = json.find("make");
        const JsonValue* const file = json.find("file");
        if ((make == nullptr) == (file == nullptr)) {
            return unexpected(json, at, "an object with either \"make\" or \"file\"");
        }
        const JsonValue* const compress = json.find("compress");
        if (compress != nullptr && compress->kind != JsonKind::Bool) {
            return unexpected(*compress, at, "true or false");
        }
        LevelImage image;
        image.name = member.key;
        image.at = json.at;
        image.compress = compress != nullptr && compress->truth;
        image.index = static_cast<std::uint32_t>(level_.assets.images.size());
        if (file != nullptr) {
            const JsonValue* const srgb = json.find("srgb");
            const bool good =
                file->kind == JsonKind::String && (srgb == nullptr || srgb->kind == JsonKind::Bool)
                && json.members.size()
                       == 1u + (srgb != nullptr ? 1u : 0u) + (compress != nullptr ? 1u : 0u);
            if (!good) {
                return error_at(
                    at, json.at, "other keys or types",
                    "{\"file\": \"path\", \"srgb\": true or false, \"compress\": true or false}");
            }
            image.file = file->text;
            image.srgb = srgb == nullptr || srgb->truth;
            images_[member.key] = image.index;
            level_.assets.images.emplace_back().name = member.key;
        } else {
            image.pattern =
                make->kind == JsonKind::String ? find_kind(pattern_kinds(), make->text) : nullptr;
            if (image.pattern == nullptr) {
                return unexpected(
                    *make, at,
                    kind_names(pattern_kinds()) + kind_suggestion(pattern_kinds(), make->text));
            }
            image.parameters = LIMN_TRY(read_component(
                without(json, {"make", "compress"}), *image.pattern->parameters, at, {}));
            patterns_[member.key] = image.index;
            for (const PatternMap& map : pattern_maps(*image.pattern)) {
                const std::string name = member.key + map.suffix;
                images_[name] = static_cast<std::uint32_t>(level_.assets.images.size());
                level_.assets.images.emplace_back().name = name;
            }
        }
        level_.images.push_back(std::move(image));
        return Done{};
    }

    Status read_material(const JsonMember& member, const JsonLocation& at) {
        const JsonValue& json = member.value;
        Material material;
        if (const JsonValue* const like = json.find("like")) {
            const auto other =
                like->kind == JsonKind::String ? materials_.find(like->text) : materials_.end();
            if (other == materials_.end() && has_failed("materials", like->text)) {
                return Done{};
            }
            if (other == materials_.end()) {
                return unexpected(
                    *like, at,
                    "the name of an earlier material"
                        + did_you_mean(like->text, sorted_names(materials_)));
            }
            material = level_.assets.materials[other->second];
            read_brdf_of_like(other->second);
        }
        if (const JsonValue* const pattern = json.find("pattern")) {
            LIMN_TRY(read_pattern(*pattern, at, material));
        }
        if (const JsonValue* const brdf = json.find("brdf")) {
            if (brdf->kind != JsonKind::String) {
                return unexpected(*brdf, at, "the path of a file of fitted reflectance");
            }
            level_.brdfs.push_back(
                {brdf->text, brdf->at, static_cast<std::uint32_t>(level_.assets.materials.size())});
            material.shading = ShadingModel::Lafortune;
        }
        material.name = member.key;
        const NameResolver names = asset_names();
        LIMN_TRY(
            read_struct(without(json, {"like", "pattern", "brdf", "tiling"}), material, at, names));
        if (const JsonValue* const tiling = json.find("tiling")) {
            TextureSlot scaled;
            const FieldInfo* const scale =
                find_field(component_info<TextureSlot>().fields, "scale");
            LIMN_TRY(read_field(*tiling, *scale, &scaled.scale, location_in(at, "tiling"), names));
            for (TextureSlot* const slot :
                 {&material.base_color_texture, &material.metal_rough_texture,
                  &material.normal_texture, &material.occlusion_texture, &material.emission_texture,
                  &material.wrinkle_texture, &material.relief_texture,
                  &material.anisotropy_texture}) {
                slot->scale = scaled.scale;
            }
        }
        if (material.lobes.size() > kMaxLafortuneLobes) {
            return error_at(
                at, json.find("lobes")->at, fmt::format("{} lobes", material.lobes.size()),
                fmt::format("at most {}", kMaxLafortuneLobes));
        }
        if (material.ramp.size() > kMaxToonBands) {
            return error_at(
                at, json.find("ramp")->at, fmt::format("{} colors", material.ramp.size()),
                fmt::format("at most {}", kMaxToonBands));
        }
        materials_[member.key] = static_cast<std::uint32_t>(level_.assets.materials.size());
        level_.assets.materials.push_back(std::move(material));
        return Done{};
    }

    /// The next material starts as a copy of one whose file has not been read yet.
    void read_brdf_of_like(std::uint32_t other) {
        const auto found =
            std::find_if(level_.brdfs.begin(), level_.brdfs.end(), [other](const LevelBrdf& brdf) {
                return brdf.material == other;
            });
        if (found != level_.brdfs.end()) {
            LevelBrdf copy = *found;
            copy.material = static_cast<std::uint32_t>(level_.assets.materials.size());
            level_.brdfs.push_back(std::move(copy));
        }
    }

    /// A hint for a pattern that does not exist: another one, or a file.
    [[nodiscard]] std::string pattern_hint(const std::string& name) const {
        constexpr const char* kUse = R"("base_color_texture": {"image": )";
        if (images_.contains(name)) {
            return fmt::format(" (for a single image write {}{}}})", kUse, in_quotes(name));
        }
        const std::string stem = std::filesystem::path(name).stem().string();
        return stem == name ? did_you_mean(name, sorted_names(patterns_))
                            : fmt::format(
                                R"( (for a file write {}{}}}, and {}: {{"file": {}}} in "images"))",
                                kUse, in_quotes(stem), in_quotes(stem), in_quotes(name));
    }

    /// Sets the maps of a pattern, and neutral factors for them.
    Status read_pattern(const JsonValue& json, const JsonLocation& at, Material& material) {
        const auto pattern =
            json.kind == JsonKind::String ? patterns_.find(json.text) : patterns_.end();
        if (pattern == patterns_.end() && has_failed("images", json.text)) {
            return Done{};
        }
        if (pattern == patterns_.end()) {
            return unexpected(
                json, at, "the name of a generated image in \"images\"" + pattern_hint(json.text));
        }
        const std::uint32_t first = pattern->second;
        material.base_color = Vec4(1);
        material.roughness = 1.0f;
        material.metalness = 1.0f;
        material.base_color_texture.image = {first};
        material.normal_texture.image = {first + 1};
        material.metal_rough_texture.image = {first + 2};
        material.occlusion_texture.image = {first + 2};
        if (images_.contains(json.text + ".relief")) {
            material.relief_texture.image = {first + 3};
        }
        return Done{};
    }

    Status read_path(const JsonMember& member, const JsonLocation& at) {
        const AnyComponent shape =
            LIMN_TRY(read_component(member.value, component_info<PathShape>(), at, {}));
        Result<PathData> path = make_path(shape.as<PathShape>());
        if (!path) {
            return fail(
                "{}: {}: {}", location_text(at.file, member.value.at), at.path,
                path.error().message);
        }
        path->name = member.key;
        paths_[member.key] = static_cast<std::uint32_t>(level_.assets.paths.size());
        level_.assets.paths.push_back(*std::move(path));
        return Done{};
    }

    Status read_graph(const JsonMember& member, const JsonLocation& at) {
        MotionGraphData graph = LIMN_TRY(read_motion_graph(member.value, at, asset_names()));
        graph.name = member.key;
        motion_graphs_[member.key] = static_cast<std::uint32_t>(level_.motion_graphs.size());
        level_.motion_graphs.push_back(std::move(graph));
        return Done{};
    }

    Status read_mesh(const JsonMember& member, const JsonLocation& at) {
        const JsonValue* const make = member.value.find("make");
        if (make == nullptr) {
            return unexpected(
                member.value, at, "an object with the key \"make\": " + kind_names(mesh_kinds()));
        }
        LevelMesh mesh;
        mesh.name = member.key;
        mesh.kind = make->kind == JsonKind::String ? find_kind(mesh_kinds(), make->text) : nullptr;
        if (mesh.kind == nullptr) {
            return unexpected(
                *make, at, kind_names(mesh_kinds()) + kind_suggestion(mesh_kinds(), make->text));
        }
        mesh.parameters = LIMN_TRY(read_component(
            without(member.value, {"make"}), *mesh.kind->parameters, at, asset_names()));
        meshes_[member.key] = static_cast<std::uint32_t>(level_.meshes.size());
        level_.meshes.push_back(std::move(mesh));
        return Done{};
    }

    void read_entities() {
        LevelEntities entities(
            level_.file, json_["prefabs"].members, asset_names(), limits_.entities, errors_);
        if (has_bad_keys_) {
            entities.expect_gaps();
        }
        const std::vector<JsonValue>& nodes = json_["entities"].items;
        for (std::size_t i = 0; i < nodes.size() && errors_.has_room(); ++i) {
            entities.add(nodes[i], fmt::format("entities[{}]", i));
            if (entities.is_full()) {
                return;  // missing definitions would cause errors where they are used
            }
        }
        entities.resolve_names();
        read_events(entities);
        entities.check_unused_prefabs();
        level_.entities = std::move(entities.entities());
        level_.entity_positions = std::move(entities.positions());
        level_.gltfs = std::move(entities.gltfs());
        level_.node_changes = std::move(entities.node_changes());
    }

    void read_events(LevelEntities& entities) {
        NameResolver names = asset_names();
        names.entity = [&](std::string_view name, SourcePosition) -> std::optional<Entity> {
            const std::int64_t index = entities.find(name);
            if (index >= 0) {
                return prefab_entity(static_cast<std::uint32_t>(index));
            }
            return entities.has_failed(name) ? std::optional(Entity{}) : std::nullopt;
        };
        names.all = [&entities, assets = names.all](std::string_view kind) {
            return kind == "entity" ? entities.names() : assets(kind);
        };
        const ReadPrefab read_prefab = [&](const JsonValue& node, const JsonLocation& at) {
            return entities.read_prefab(node, at.path);
        };
        const std::vector<JsonValue>& events = json_["events"].items;
        for (std::size_t i = 0; i < events.size() && errors_.has_room(); ++i) {
            Result<ScriptEvent> event =
                read_event(events[i], location(fmt::format("events[{}]", i)), names, read_prefab);
            if (!event) {
                errors_.keep(event.error());
                continue;
            }
            level_.events.events.push_back(*std::move(event));
            level_.event_positions.push_back(events[i].at);
            bind_key(level_.events.events.back(), events[i]["text"].text);
        }
    }

    /// Registers the key of an event for input.
    void bind_key(const ScriptEvent& event, const std::string& text) {
        if (event.key.empty()) {
            return;
        }
        const std::string action = key_action(event.key);
        std::vector<Bindings::Binding>& bindings = level_.bindings.bindings;
        const auto bound =
            std::find_if(bindings.begin(), bindings.end(), [&](const Bindings::Binding& binding) {
                return binding.action == action;
            });
        if (bound == bindings.end()) {
            bindings.push_back({action, {event.key}, text});
        } else if (bound->text.empty()) {
            bound->text = text;
        }
    }

    /// Moves cameras with a path to its start, so that the first frame is right.
    void place_cameras() {
        std::vector<PrefabEntity>& entities = level_.entities.entities;
        for (PrefabEntity& entity : entities) {
            const auto* const path = find_in<CameraPath>(entity.components);
            auto* const transform = find_in<Transform>(entity.components);
            if (path == nullptr || transform == nullptr || path->keys.empty()) {
                continue;
            }
            Vec3 target = path->keys.front().look_at;
            if (path->target.index < entities.size()) {
                const auto* const followed =
                    find_in<Transform>(entities[path->target.index].components);
                target = followed != nullptr ? followed->position : target;
            }
            const CameraPose pose = camera_pose(*path, 0.0, target);
            transform->position = pose.position;
            transform->rotation = pose.rotation;
        }
    }

    static const char* section_of(std::string_view kind) {
        return kind == asset_kind<MeshId>       ? "meshes"
               : kind == asset_kind<MaterialId> ? "materials"
               : kind == asset_kind<ImageId>    ? "images"
               : kind == asset_kind<PathId>     ? "paths"
                                                : "motion_graphs";
    }

    NameResolver asset_names() {
        const auto names_of_kind = [this](std::string_view kind) -> const Names* {
            return kind == asset_kind<MeshId>          ? &meshes_
                   : kind == asset_kind<MaterialId>    ? &materials_
                   : kind == asset_kind<ImageId>       ? &images_
                   : kind == asset_kind<PathId>        ? &paths_
                   : kind == asset_kind<MotionGraphId> ? &motion_graphs_
                                                       : nullptr;
        };
        NameResolver names;
        names.asset = [this, names_of_kind](
                          std::string_view kind, std::string_view name,
                          SourcePosition at) -> std::optional<std::uint32_t> {
            const Names* const all = names_of_kind(kind);
            if (all == nullptr) {  // defined by files that are not read yet
                level_.deferred_names.push_back({std::string(name), at});
                return static_cast<std::uint32_t>(level_.deferred_names.size() - 1);
            }
            const auto found = all->find(std::string(name));
            if (found != all->end()) {
                return found->second;
            }
            return has_failed(section_of(kind), name) ? std::optional(0u) : std::nullopt;
        };
        names.all = [this, names_of_kind](std::string_view kind) {
            const Names* const all = names_of_kind(kind);
            if (all == nullptr) {
                return std::vector<std::string_view>();
            }
            std::vector<std::string_view> known = sorted_names(*all);
            for (const JsonMember& member : json_[section_of(kind)].members) {
                if (!all->contains(member.key) && !patterns_.contains(member.key)) {
                    known.emplace_back(member.key);  // it exists, despite its error
                }
            }
            return known;
        };
        return names;
    }

    const JsonValue& json_;
    LevelLimits limits_;
    ErrorList errors_;
    bool has_bad_keys_ = false;  // of the level: whole sections are missing
    Level level_;
    Names images_;
    Names materials_;
    Names paths_;
    Names meshes_;
    Names motion_graphs_;
    Names patterns_;  // by name; the index of the first of the three images
};

}  // namespace

Result<Level>
parse_level(std::string_view text, const std::string& file, const LevelLimits& limits) {
    const JsonValue json = LIMN_TRY(parse_json(text, file, limits.json));
    return LevelParser(json, file, limits).parse("");
}

Result<Level> load_level(
    const std::string& path, const LevelLimits& limits, const ShowChoice& choice,
    MadeAssets* made) {
    JsonValue json = LIMN_TRY(load_json(path, limits.json));
    SourceFiles included = LIMN_TRY(include_files(json, path, limits.json));
    std::optional<LevelShow> show = LIMN_TRY(choose_show(choice, path, json));
    const std::string parent = std::filesystem::path(path).parent_path().string();
    const std::string folder = parent.empty() ? "." : parent;
    Level level = LIMN_TRY(LevelParser(json, path, limits).parse(folder));
    level.show = std::move(show);
    level.included = std::move(included);
    LIMN_TRY(load_level_assets(level, folder, limits, made));
    return level;
}

}  // namespace limn
