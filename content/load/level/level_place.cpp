#include "content/load/level/level_place.h"

#include "content/load/files/error_list.h"
#include "content/load/files/json_document.h"
#include "content/load/level/level_entities.h"
#include "content/load/level/level_include.h"
#include "content/load/level/set_value.h"
#include "ecs/base/text.h"
#include "ecs/world.h"

#include <algorithm>
#include <string_view>

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
    const World& world, const std::string& path, const std::string& prefab,
    const std::string& name) {
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
    LevelEntities entities(path, prefabs.all(), make_name_resolver(world), {}, errors);
    const JsonValue node = json_object(
        {{"name", {}, json_of(std::string_view(name))},
         {"prefab", {}, json_of(std::string_view(prefab))}});
    Prefab instance = LIMN_TRY(entities.read_prefab(node, "prefabs." + prefab));
    LIMN_TRY(errors.status());
    if (instance.entities.empty()) {
        return fail("{}: found no entity in the prefab {}, expected some", path, in_quotes(prefab));
    }
    return instance;
}

}  // namespace limn
