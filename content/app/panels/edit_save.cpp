#include "content/app/panels/edit_save.h"

#include "content/app/panels/edit_json.h"
#include "content/load/files/json_document.h"
#include "content/load/level/level_include.h"
#include "content/load/level/level_load.h"
#include "content/load/level/level_patch.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

// Techniques: engine.editor-inspector
// Shown by `limn edit pond "delete sun" -o night.level.json`: engine.editor-inspector

namespace limn {
namespace {

constexpr std::string_view kEnding = ".level.json";
constexpr std::string_view kEdited = "-edited";

JsonValue& array_member(JsonValue& object, std::string_view key) {
    for (JsonMember& member : object.members) {
        if (member.key == key) {
            return member.value;
        }
    }
    object.members.push_back({std::string(key), {}, json_array()});
    return object.members.back().value;
}

/// Removes the member and returns its value; null if it is missing.
JsonValue take_member(JsonValue& object, std::string_view key) {
    JsonValue taken;
    std::erase_if(object.members, [&](JsonMember& member) {
        const bool found = member.key == key;
        if (found) {
            taken = std::move(member.value);
        }
        return found;
    });
    return taken;
}

void append(JsonValue& array, JsonValue items) {
    array.items.insert(
        array.items.end(), std::make_move_iterator(items.items.begin()),
        std::make_move_iterator(items.items.end()));
}

/// Applies an entity of LevelEdits to that of the file, or adds it.
Status add_entity(JsonValue& entities, JsonValue edited, const JsonLocation& location) {
    const std::string name = edited["name"].text;
    JsonValue* const node = name.empty() ? nullptr : find_entity_json(entities, name);
    if (node == nullptr) {
        entities.items.push_back(std::move(edited));
        return Done{};
    }
    JsonValue children = take_member(edited, "children");
    take_member(edited, "name");
    LIMN_TRY(patch_level(*node, edited, location));
    if (node->find("prefab") != nullptr) {  // whose components only a null removes
        for (const JsonMember& member : edited.members) {
            if (member.value.kind == JsonKind::Null && node->find(member.key) == nullptr) {
                node->members.push_back(member);
            }
        }
    }
    if (!children.items.empty()) {
        append(array_member(*node, "children"), std::move(children));
    }
    return Done{};
}

/// Removes the entity from these or their children, and returns it.
std::optional<JsonValue> take_entity(JsonValue& entities, std::string_view name) {
    for (auto node = entities.items.begin(); node != entities.items.end(); ++node) {
        if ((*node)["name"].text == name) {
            JsonValue taken = std::move(*node);
            entities.items.erase(node);
            return taken;
        }
        if (node->find("children") == nullptr) {
            continue;
        }
        JsonValue& children = array_member(*node, "children");
        if (std::optional<JsonValue> taken = take_entity(children, name)) {
            if (children.items.empty()) {
                take_member(*node, "children");
            }
            return taken;
        }
    }
    return std::nullopt;
}

/// False if the file has no such entities.
bool move_entity(JsonValue& entities, const LevelEdits::Move& move) {
    const bool has_both =
        !move.entity.empty() && find_entity_json(entities, move.entity) != nullptr
        && (!move.parent
            || (!move.parent->empty() && find_entity_json(entities, *move.parent) != nullptr));
    if (!has_both) {
        return false;
    }
    std::optional<JsonValue> taken = take_entity(entities, move.entity);
    JsonValue* const parent = move.parent ? find_entity_json(entities, *move.parent) : nullptr;
    JsonValue& list = parent != nullptr ? array_member(*parent, "children") : entities;
    list.items.push_back(*std::move(taken));
    return true;
}

/// A file of the folder to which the JSON refers; "" if there is none.
std::string file_reference(const JsonValue& json, const std::filesystem::path& folder) {
    std::error_code ignored;
    if (json.kind == JsonKind::String && !json.text.empty()
        && std::filesystem::is_regular_file(folder / json.text, ignored)) {
        return json.text;
    }
    std::string found;
    for (std::size_t i = 0; i < json.items.size() && found.empty(); ++i) {
        found = file_reference(json.items[i], folder);
    }
    for (std::size_t i = 0; i < json.members.size() && found.empty(); ++i) {
        found = file_reference(json.members[i].value, folder);
    }
    return found;
}

Status expect_same_folder(
    const JsonValue& level, const std::filesystem::path& path, const std::filesystem::path& out) {
    const auto folder_of = [](const std::filesystem::path& file) {
        std::error_code ignored;
        return std::filesystem::weakly_canonical(std::filesystem::absolute(file), ignored)
            .parent_path();
    };
    const std::string reference = file_reference(level, folder_of(path));
    if (folder_of(path) != folder_of(out) && !reference.empty()) {
        return fail(
            "{}: found another folder than the level's, which refers to {}, expected a file in {}",
            out.string(), in_quotes(reference), folder_of(path).string());
    }
    return Done{};
}

}  // namespace

Result<EditedLevel> edited_level(
    const std::string& path, const std::string& out, World& world, std::span<const Edit> edits) {
    if (!path.ends_with(kEnding)) {
        return fail("{}: found a model, expected a level: edits are saved as a level", path);
    }
    JsonValue level = LIMN_TRY(load_json(path));
    LIMN_TRY(expect_same_folder(level, path, out));
    const JsonLocation location{path, ""};
    LevelEdits all = level_edits(world, edits);
    EditedLevel saved;
    saved.left_out = std::move(all.left_out);

    JsonValue edited = take_member(all.patch, "entities");
    for (JsonValue& entity : edited.items) {
        LIMN_TRY(add_entity(array_member(level, "entities"), std::move(entity), location));
    }
    for (const LevelEdits::Move& move : all.moves) {
        if (!move_entity(array_member(level, "entities"), move)) {
            saved.left_out.push_back(
                "the move of " + describe_move(move) + ": the level's file does not list both");
        }
    }
    if (JsonValue events = take_member(all.patch, "events"); !events.items.empty()) {
        append(array_member(level, "events"), std::move(events));
    }
    JsonValue materials = take_member(all.patch, "materials");
    std::erase_if(materials.members, [&](const JsonMember& material) {
        const bool is_foreign = level["materials"].find(material.key) == nullptr;
        if (is_foreign) {
            saved.left_out.push_back(
                "edits of the material " + in_quotes(material.key)
                + ": the level's file does not define it");
        }
        return is_foreign;
    });
    if (!materials.members.empty()) {
        all.patch.members.push_back({"materials", {}, std::move(materials)});
    }
    LIMN_TRY(patch_level(level, all.patch, location));
    saved.text = write_json(level) + '\n';
    LIMN_TRY(include_files(level, path, {}));
    const Result<Level> parsed = parse_level(write_json(level), out);
    if (!parsed) {
        return fail("{}; nothing was saved", parsed.error().message);
    }
    return saved;
}

std::string new_edited_path(const std::string& path) {
    std::string stem = path.substr(0, path.rfind(kEnding));
    if (const std::size_t edited = stem.rfind(kEdited); edited != std::string::npos) {
        const std::string_view rest = std::string_view(stem).substr(edited + kEdited.size());
        if (rest.empty() || rest.find_first_not_of("-0123456789") == std::string_view::npos) {
            stem.resize(edited);
        }
    }
    std::string found = fmt::format("{}{}{}", stem, kEdited, kEnding);
    std::error_code ignored;
    for (int i = 2; std::filesystem::exists(found, ignored); ++i) {
        found = fmt::format("{}{}-{}{}", stem, kEdited, i, kEnding);
    }
    return found;
}

}  // namespace limn
