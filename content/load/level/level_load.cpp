#include "content/load/level/level_load.h"

#include "content/load/files/brdf_file.h"
#include "content/load/files/error_list.h"
#include "content/load/files/file_uri.h"
#include "content/load/files/texture_load.h"
#include "content/load/level/component_json.h"
#include "content/load/level/level_events.h"
#include "content/load/level/level_hints.h"
#include "content/load/level/level_names.h"
#include "content/load/level/motion_graph_json.h"
#include "content/make/models/fragments.h"
#include "ecs/base/log.h"
#include "ecs/base/text.h"
#include "ecs/components/camera_path.h"
#include "ecs/components/image_blocks.h"
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
struct PatternMap {
    const char* suffix;  ///< of its name
    ImageData PatternMaps::*image;
};
constexpr PatternMap kPatternMaps[] = {
    {".base_color", &PatternMaps::base_color},
    {".normal", &PatternMaps::normal},
    {".orm", &PatternMaps::orm},
    {".motion", &PatternMaps::motion},
};
constexpr PatternMap kReliefMaps[] = {
    kPatternMaps[0],
    kPatternMaps[1],
    kPatternMaps[2],
    {".relief", &PatternMaps::relief},
};
constexpr PatternMap kPuffMaps[] = {
    kPatternMaps[0],
    kPatternMaps[1],
    kPatternMaps[2],
    {".positive_light", &PatternMaps::positive_light},
    {".negative_light", &PatternMaps::negative_light},
};

std::span<const PatternMap> pattern_maps(const PatternKind& kind) {
    switch (kind.maps) {
    case PatternKindMaps::Motion:
        return kPatternMaps;
    case PatternKindMaps::Light:
        return kPuffMaps;
    case PatternKindMaps::Relief:
        return kReliefMaps;
    case PatternKindMaps::Surface:
        break;
    }
    return std::span(kPatternMaps).first(3);
}

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

std::string location_of(const Level& level, SourcePosition at, std::string_view path) {
    return location_text(level.file, at) + ": " + std::string(path);
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

// ---- assets -------------------------------------------------------------------------------------

Status
make_pattern(Level& level, const LevelImage& image, MadeAssets& made, std::uint64_t& pixels_left) {
    const FieldInfo* const size = find_field(image.parameters.info().fields, "size");
    const auto side =
        size == nullptr ? 0.0 : get_number(*size, field_ptr(image.parameters.data(), *size));
    const std::span<const PatternMap> wanted = pattern_maps(*image.pattern);
    const auto pixels =
        static_cast<std::uint64_t>(static_cast<double>(wanted.size()) * side * side);
    if (pixels > pixels_left) {
        return fail(
            "{}: found {} pixels, expected at most {} more in this level",
            location_of(level, image.at, "images." + image.name), pixels, pixels_left);
    }
    pixels_left -= pixels;
    PatternMaps maps = made.pattern(*image.pattern, image.parameters);
    std::size_t index = image.index;
    for (const PatternMap& map : wanted) {
        (maps.*map.image).name = level.assets.images[index].name;
        level.assets.images[index++] = std::move(maps.*map.image);
    }
    return Done{};
}

Status load_image_file(
    Level& level, const LevelImage& image, const std::string& folder, const LevelLimits& limits,
    std::uint64_t& pixels_left) {
    const std::string location = location_of(level, image.at, "images." + image.name);
    const std::vector<std::byte> bytes =
        LIMN_TRY(fetch_uri(image.file, folder, location, limits.gltf.max_bytes));
    ImageLimits image_limits = limits.gltf.image;
    image_limits.max_pixels =
        std::min(image_limits.max_pixels, static_cast<std::int64_t>(pixels_left));
    ImageData data = LIMN_TRY(decode_texture(
        bytes, fmt::format("{}: {}", location, image.file), image.srgb, image_limits));
    pixels_left -= static_cast<std::uint64_t>(data.width) * static_cast<std::uint64_t>(data.height);
    if (const std::size_t bad = replace_non_finite(data); bad > 0) {
        log_warn(
            "{}: {}: {} values are not finite; NaN became 0, infinity 65504", location, image.file,
            bad);
    }
    data.name = image.name;
    level.assets.images[image.index] = std::move(data);
    return Done{};
}

/// How often materials of the level use an image.
struct ImageUse {
    int all = 0;
    int normals = 0;   ///< of tangent space, whose z >= 0 follows from x and y
    int wrinkles = 0;  ///< read by systems, too
};

ImageUse use_of(std::vector<Material>& materials, ImageId image) {
    ImageUse use;
    for (Material& m : materials) {
        for_each_asset(
            component_info<Material>().fields, &m,
            [&](std::string_view kind, const std::uint32_t& index) {
                use.all += kind == asset_kind<ImageId> && index == image.index ? 1 : 0;
            });
        for (const TextureSlot* slot :
             {&m.normal_texture, &m.detail_texture, &m.clearcoat_normal_texture}) {
            const bool in_mesh_space =
                slot == &m.normal_texture && m.detail == SurfaceDetail::ObjectNormal;
            use.normals += slot->image == image && !in_mesh_space ? 1 : 0;
        }
        use.wrinkles += m.wrinkle_texture.image == image ? 1 : 0;
    }
    return use;
}

/// The images that `image` has become, in blocks.
void compress_images(Level& level, const LevelImage& image, MadeAssets& made) {
    const std::size_t count = image.pattern != nullptr ? pattern_maps(*image.pattern).size() : 1;
    for (std::size_t i = image.index; i < image.index + count; ++i) {
        ImageData& data = level.assets.images[i];
        const ImageUse use = use_of(level.assets.materials, {static_cast<std::uint32_t>(i)});
        if (data.format != PixelFormat::Rgba8 || use.wrinkles > 0) {
            log_warn(
                "{}: {} is not compressed: found {}, expected 8 bits that only materials read",
                location_of(level, image.at, "images." + image.name), data.name,
                use.wrinkles > 0 ? "the wrinkles of a material" : format_name(data.format));
            continue;
        }
        const bool normals = use.normals > 0 && use.normals == use.all;
        data = made.blocks(
            data, {.format = normals ? PixelFormat::Bc5 : PixelFormat::Bc7,
                   .kind = normals     ? TexelKind::Normal
                           : data.srgb ? TexelKind::Color
                                       : TexelKind::Data});
    }
}

/// Base color and lobes of a material.
Status load_brdf_file(
    Level& level, const LevelBrdf& brdf, const std::string& folder, const LevelLimits& limits) {
    const std::vector<std::byte> bytes = LIMN_TRY(
        fetch_uri(brdf.file, folder, location_of(level, brdf.at, "brdf"), limits.gltf.max_bytes));
    const std::string path = (std::filesystem::path(folder) / brdf.file).string();
    const BrdfFit fit =
        LIMN_TRY(parse_brdf({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path));
    Material& material = level.assets.materials[brdf.material];
    material.base_color = Vec4(fit.diffuse, material.base_color.w);
    material.lobes = fit.lobes;
    return Done{};
}

/// Skeleton and skin get the name of the mesh, clips begin with it: "fox.walk".
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

Status make_meshes(Level& level, const LevelLimits& limits, MadeAssets& made) {
    std::uint64_t vertices = 0;
    for (const LevelMesh& mesh : level.meshes) {
        MadeMesh made_mesh = made.mesh(*mesh.kind, mesh.parameters, level.assets);
        MeshData& data = level.assets.meshes.emplace_back(std::move(made_mesh.data));
        data.name = mesh.name;
        if (made_mesh.rig) {
            add_rig(level.assets, mesh.name, *std::move(made_mesh.rig));
        }
        vertices += data.positions.size();
        if (vertices > limits.max_vertices) {
            return fail(
                "{}: meshes.{}: found {} vertices so far, expected at most {} in all meshes",
                level.file, mesh.name, vertices, limits.max_vertices);
        }
    }
    for (std::uint32_t i = 0; i < level.meshes.size(); ++i) {
        add_piece_meshes(level.assets, {i});  // after those whose ids are their indices in the file
    }
    return Done{};
}

Result<GltfScene> load_scene_file(
    const Level& level, const GltfUse& use, const std::string& folder, const LevelLimits& limits) {
    const std::vector<std::byte> bytes = LIMN_TRY(
        fetch_uri(use.file, folder, location_of(level, use.at, "gltf"), limits.gltf.max_bytes));
    const std::filesystem::path path = std::filesystem::path(folder) / use.file;
    return parse_gltf(bytes, path.string(), path.parent_path().string(), limits.gltf, use.variant);
}

}  // namespace

Result<Level>
parse_level(std::string_view text, const std::string& file, const LevelLimits& limits) {
    const JsonValue json = LIMN_TRY(parse_json(text, file, limits.json));
    return LevelParser(json, file, limits).parse("");
}

Status load_level_assets(
    Level& level, const std::string& folder, const LevelLimits& limits, MadeAssets* made) {
    MadeAssets own;
    MadeAssets& makes = made != nullptr ? *made : own;
    makes.begin_level();
    std::uint64_t pixels_left = limits.max_pixels;
    ErrorList errors(level.file);
    for (const LevelImage& image : level.images) {
        const Status loaded = image.pattern != nullptr
                                  ? make_pattern(level, image, makes, pixels_left)
                                  : load_image_file(level, image, folder, limits, pixels_left);
        errors.keep(loaded);
        if (loaded && image.compress) {
            compress_images(level, image, makes);
        }
    }
    for (const LevelBrdf& brdf : level.brdfs) {
        errors.keep(load_brdf_file(level, brdf, folder, limits));
    }
    for (const GltfUse& use : level.gltfs) {
        Result<GltfScene> scene = load_scene_file(level, use, folder, limits);
        if (!scene) {
            errors.keep(scene.error());
            continue;
        }
        for (const std::string& warning : scene->warnings) {
            log_warn("{}", warning);
        }
        level.scenes.push_back(*std::move(scene));
    }
    LIMN_TRY(errors.status());
    LIMN_TRY(make_meshes(level, limits, makes));
    LIMN_TRY(find_changed_nodes(level));
    return resolve_deferred_names(level);
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
