#include "content/load/level/level_place.h"

#include "content/load/files/error_list.h"
#include "content/load/files/json_document.h"
#include "content/load/level/level_entities.h"
#include "content/load/level/level_include.h"
#include "content/load/level/set_value.h"
#include "ecs/base/text.h"
#include "ecs/component_bytes.h"
#include "ecs/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

// Techniques: engine.editor-inspector
// Shown by `limn edit den "place fox" -o foxes.level.json`: engine.editor-inspector

namespace limn {
namespace {

struct LevelPrefabs {
    JsonValue level;
    SourceFiles files;  ///< which positions of included prefabs refer to

    [[nodiscard]] const std::vector<JsonMember>& all() const { return level["prefabs"].members; }
};

Result<LevelPrefabs> load_prefabs(const std::string& path) {
    LevelPrefabs prefabs;
    prefabs.level = LIMN_TRY(load_json(path));
    prefabs.files = LIMN_TRY(include_files(prefabs.level, path, {}));
    return prefabs;
}

/// The entities of the level, for their names.
void add_level(const LevelPrefabs& prefabs, LevelEntities& entities) {
    const std::vector<JsonValue>& nodes = prefabs.level["entities"].items;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        entities.add(nodes[i], fmt::format("entities[{}]", i));
    }
}

/// Whether the file has as many entities as it became: fewer or more with a show, or if it was
/// written since.
bool is_same_level(const LevelPrefabs& prefabs, const PlacedLevel& level, const NameResolver& any) {
    ErrorList errors{level.path};
    LevelEntities entities(level.path, prefabs.all(), any, {}, errors);
    add_level(prefabs, entities);
    return errors.empty() && entities.entities().entities.size() == level.entities.size();
}

/// Replaces indices of the level's entities by handles.
void set_level_entities(Prefab& prefab, const std::vector<Entity>& entities) {
    for (PrefabEntity& entity : prefab.entities) {
        for (AnyComponent& component : entity.components) {
            for_each_entity(component.info().fields, component.data(), [&](Entity& named) {
                if (named.generation == level_entity(0).generation
                    && named.index < entities.size()) {
                    named = entities[named.index];
                }
            });
        }
    }
}

}  // namespace

Result<std::vector<std::string>> prefab_names(const std::string& path) {
    const LevelPrefabs prefabs = LIMN_TRY(load_prefabs(path));
    std::vector<std::string> names;
    for (const JsonMember& prefab : prefabs.all()) {
        names.push_back(prefab.key);
    }
    std::ranges::sort(names);
    return names;
}

Result<Prefab> read_instance(
    const World& world, const PlacedLevel& level, const std::string& prefab, const Vec3& position) {
    const std::string& path = level.path;
    const LevelPrefabs prefabs = LIMN_TRY(load_prefabs(path));
    if (std::ranges::find(prefabs.all(), prefab, &JsonMember::key) == prefabs.all().end()) {
        std::vector<std::string_view> known;
        for (const JsonMember& one : prefabs.all()) {
            known.emplace_back(one.key);
        }
        return fail(
            "{}: found the prefab {}, expected one of the level{}", path, in_quotes(prefab),
            did_you_mean(prefab, known));
    }
    ErrorList errors{path};
    bool is_level = true;  // its assets do not matter
    NameResolver names = make_name_resolver(world);
    names.asset = [&is_level, found = names.asset](
                      std::string_view kind, std::string_view name,
                      SourcePosition at) -> std::optional<std::uint32_t> {
        return is_level ? std::optional(0u) : found(kind, name, at);
    };
    LevelEntities entities(path, prefabs.all(), names, {}, errors);
    if (is_same_level(prefabs, level, names)) {
        add_level(prefabs, entities);
    }
    is_level = false;
    JsonValue place = json_array();
    for (int i = 0; i < 3; ++i) {
        place.items.push_back(json_of(position[i]));
    }
    const JsonValue node = json_object(
        {{"name", {}, json_of(std::string_view(prefab))},
         {"prefab", {}, json_of(std::string_view(prefab))},
         {"transform", {}, json_object({{"position", {}, std::move(place)}})},
         {"repeat", {}, {}}});
    Prefab instance = LIMN_TRY(entities.read_prefab(node, "prefabs." + prefab));
    LIMN_TRY(errors.status());
    if (instance.entities.empty()) {
        return fail("{}: found no entity in the prefab {}, expected some", path, in_quotes(prefab));
    }
    set_level_entities(instance, level.entities);
    return instance;
}

}  // namespace limn
