#include "content/app/panels/edit_save.h"

#include "content/app/panels/edit_json.h"
#include "content/load/files/json_document.h"
#include "content/load/level/level_include.h"
#include "content/load/level/level_load.h"
#include "content/load/level/level_patch.h"
#include "content/load/level/level_rename.h"
#include "ecs/base/text.h"
#include "ecs/components/gltf_source.h"
#include "ecs/components/name.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
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

/// Indices of the entities of a file, in the order of the file, parents before their children; by
/// the entities that they became. Those that `repeat` makes are left out.
using FilePlaces = std::unordered_map<Entity, int>;

/// In the order of FilePlaces.
void list_file_nodes(const JsonValue& entities, std::vector<const JsonValue*>& nodes) {
    for (const JsonValue& entity : entities.items) {
        nodes.push_back(&entity);
        list_file_nodes(entity["children"], nodes);
    }
}

std::string parsed_name(const Level& level, std::size_t index) {
    for (const AnyComponent& component : level.entities.entities[index].components) {
        if (&component.info() == &component_info<Name>()) {
            return component.as<Name>().text;
        }
    }
    return "";
}

/// Whether the level is what became `spawned`: as many entities, of the same names.
bool is_same_level(
    const Level& level, const World& world, const BeforeEdits& before,
    std::span<const Entity> spawned) {
    bool same = level.entities.entities.size() == spawned.size();
    for (std::size_t i = 0; same && i < spawned.size(); ++i) {
        const std::string name = before.name(spawned[i]);
        const bool is_destroyed = name.empty() && !exists(world, spawned[i]);
        same = is_destroyed || name == parsed_name(level, i);
    }
    return same;
}

/// Empty if the world was loaded from another text than `level`, with what it includes.
Result<FilePlaces> find_places(
    const JsonValue& level, const std::string& path, const World& world, const BeforeEdits& before,
    std::span<const Entity> spawned) {
    const std::string text = write_json(level);
    const Level parsed = LIMN_TRY(parse_level(text, path));
    FilePlaces places;
    if (!is_same_level(parsed, world, before, spawned)) {
        return places;
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::size_t>> at;
    for (std::size_t i = 0; i < spawned.size(); ++i) {
        at[{parsed.entity_positions[i].line, parsed.entity_positions[i].column}].push_back(i);
    }
    const JsonValue json = LIMN_TRY(parse_json(text, path));
    std::vector<const JsonValue*> nodes;
    list_file_nodes(json["entities"], nodes);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const JsonValue& node = *nodes[i];
        const std::vector<std::size_t>& all = at[{node.at.line, node.at.column}];
        // One that `repeat` made is called "post[0]".
        if (all.size() == 1 && node.find("repeat") == nullptr
            && parsed_name(parsed, all.front()) == node["name"].text) {
            places[spawned[all.front()]] = static_cast<int>(i);
        }
    }
    return places;
}

/// Why a file cannot have the new names of some entities.
class RenameCheck {
  public:
    /// `level` with what it includes.
    RenameCheck(
        const JsonValue& level, const World& world, const BeforeEdits& before,
        const FilePlaces& places, std::span<const Entity> renamed, std::span<const Entity> deleted)
        : level_(level), world_(world), before_(before), places_(places) {
        list_file_nodes(level["entities"], nodes_);
        for (const Entity entity : renamed) {
            mark(entity, Fate::Renamed);
        }
        for (const Entity entity : deleted) {
            mark(entity, Fate::Deleted);
        }
    }

    /// "" if it can.
    [[nodiscard]] std::string refusal(Entity entity) const {
        if (!places_.contains(entity)) {
            return "the level's file does not list it";
        }
        const std::string old = before_.name(entity);
        if (!old.empty() && is_prefab_name(level_, old)) {
            return "prefabs have entities of that name, too";
        }
        const auto is_old = [&](const JsonValue* node) { return (*node)["name"].text == old; };
        if (!old.empty() && std::ranges::count_if(nodes_, is_old) > 1) {
            return "other entities have that name, too";
        }
        const auto* const now = world_.find<Name>(entity);
        return now != nullptr ? refusal_of(now->text) : "";
    }

  private:
    enum class Fate : std::uint8_t { Renamed, Deleted };

    void mark(Entity entity, Fate fate) {
        if (const auto place = places_.find(entity); place != places_.end()) {
            fates_[place->second] = fate;
        }
    }

    [[nodiscard]] std::string refusal_of(const std::string& name) const {
        if (is_prefab_name(level_, name)) {
            return "prefabs have entities called " + in_quotes(name);
        }
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            if ((*nodes_[i])["name"].text != name) {
                continue;
            }
            const auto fate = fates_.find(static_cast<int>(i));
            if (fate == fates_.end()) {
                return "another entity is called " + in_quotes(name);
            }
            if (fate->second == Fate::Deleted && is_referred_to(level_, name)) {
                return "the file refers to the deleted " + in_quotes(name);
            }
        }
        return "";
    }

    const JsonValue& level_;
    const World& world_;
    const BeforeEdits& before_;
    const FilePlaces& places_;
    std::vector<const JsonValue*> nodes_;
    std::unordered_map<int, Fate> fates_;  // by place
};

/// An entity of the level's file, without its children.
struct FileEntity {
    JsonValue json;
    int parent = -1;  ///< index; -1: none
    std::string name;
    bool is_gone = false;
    std::uint64_t order = 0;  ///< among siblings: what was made or moved is after what stayed
};

/// The entities of a level as a list, in which they can be moved.
class FileEntities {
  public:
    FileEntities(
        JsonValue entities, World& world, const BeforeEdits& before, const TreeEdits& trees,
        const FilePlaces& places, EditedLevel& saved)
        : world_(world), before_(before), places_(places), saved_(saved) {
        flatten(std::move(entities), -1);
        listed_ = list_.size();
        for (const Entity entity : trees.made) {
            add_made(entity);
        }
        for (const Entity entity : trees.moved) {
            move(entity);
        }
        for (const Entity entity : trees.moved) {
            check_move(entity);
        }
        const std::unordered_set<Entity> deleted(trees.deleted.begin(), trees.deleted.end());
        for (const Entity entity : trees.deleted) {
            if (const int at = find(entity); at >= 0) {
                list_[index(at)].is_gone = true;
            } else if (!deleted.contains(before_.parent(entity))) {
                leave_out("the deletion of " + quoted(before_.name(entity)));
            }
        }
    }

    Status change(LevelEdits::Change change, const JsonLocation& location) {
        const int at = find(change.entity);
        if (at < 0) {
            leave_out("edits of " + quoted(before_.name(change.entity)));
            return Done{};
        }
        JsonValue& json = list_[index(at)].json;
        if (unmoved_.contains(change.entity)) {  // relative to the parent that it does not get
            take_member(change.components, "transform");
        }
        LIMN_TRY(patch_level(json, change.components, location));
        for (const JsonMember& member : change.components.members) {
            const bool is_inherited = json.find("prefab") != nullptr;
            if (is_inherited && member.value.kind == JsonKind::Null
                && json.find(member.key) == nullptr) {
                json.members.push_back(member);  // only a null removes a prefab's component
            }
        }
        return Done{};
    }

    /// The entities of the new file. What was deleted and is referred to in `level` remains, and is
    /// added to `destroyed`.
    JsonValue build(const JsonValue& level, JsonValue& destroyed) {
        for (FileEntity& entity : list_) {
            const auto is_other = [&](const FileEntity& other) {
                return &other != &entity && !other.is_gone && other.name == entity.name;
            };
            const bool is_root =
                entity.is_gone && (entity.parent < 0 || !list_[index(entity.parent)].is_gone);
            const auto refers = [&](const FileEntity& other) {
                return !other.is_gone && refers_to(other.json, entity);
            };
            if (is_root && (refers_to(level, entity) || std::ranges::any_of(list_, refers))
                && std::ranges::none_of(list_, is_other)) {
                destroyed.items.push_back(json_of(std::string_view(entity.name)));
                keep(entity);
            }
        }
        std::vector<std::vector<int>> children(list_.size() + 1);
        for (std::size_t i = 0; i < list_.size(); ++i) {
            if (!list_[i].is_gone) {
                children[index(list_[i].parent + 1)].push_back(static_cast<int>(i));
            }
        }
        for (std::vector<int>& siblings : children) {
            std::ranges::stable_sort(
                siblings, {}, [&](int child) { return list_[index(child)].order; });
        }
        return build_children(children, -1);
    }

  private:
    static std::size_t index(int at) { return static_cast<std::size_t>(at); }
    static std::string quoted(const std::string& name) {
        return name.empty() ? "an entity without a name" : in_quotes(name);
    }
    void leave_out(const std::string& what) {
        saved_.left_out.push_back(what + ": the level's file does not list it");
    }

    void flatten(JsonValue entities, int parent) {
        for (JsonValue& json : entities.items) {
            JsonValue children = take_member(json, "children");
            std::string name = json["name"].text;
            list_.push_back({.json = std::move(json), .parent = parent, .name = std::move(name)});
            parents_.push_back(parent);
            flatten(std::move(children), static_cast<int>(list_.size()) - 1);
        }
    }

    /// The entity as it was before the edits; -1 if it is not listed. In a world that was loaded
    /// with a show, by its name and its parents.
    [[nodiscard]] int find(Entity entity) const {
        if (const auto made = made_.find(entity); made != made_.end()) {
            return made->second;
        }
        if (const auto place = places_.find(entity); place != places_.end()) {
            return place->second;
        }
        const std::string name = before_.name(entity);
        const Entity parent = before_.parent(entity);
        const int above = parent.is_null() ? -1 : find(parent);
        for (std::size_t i = 0; i < listed_ && !name.empty(); ++i) {
            if (list_[i].name == name && (parent.is_null() || above >= 0) && parents_[i] == above) {
                return static_cast<int>(i);
            }
        }
        return -1;
    }

    void add_made(Entity entity) {
        const Entity parent = parent_of(world_, entity);
        const int above = parent.is_null() ? -1 : find(parent);
        if (world_.has<FromGltf>(entity)) {
            return;  // comes with the file of an entity above it
        }
        JsonValue json = entity_without_children(world_, entity, before_);
        const std::string name = json["name"].text;
        if (!parent.is_null() && above < 0) {
            leave_out(quoted(name) + ", whose parent is " + quoted(before_.name(parent)));
            return;
        }
        made_[entity] = static_cast<int>(list_.size());
        list_.push_back({std::move(json), above, name, false, order_of(entity)});
        parents_.push_back(above);
    }

    void move(Entity entity) {
        const int at = find(entity);
        const Entity parent = parent_of(world_, entity);
        const int above = parent.is_null() ? -1 : find(parent);
        if (at < 0 || (!parent.is_null() && above < 0)) {
            leave_out("the move of " + quoted(before_.name(entity)));
            unmoved_.insert(entity);
            return;
        }
        list_[index(at)].parent = above;
        list_[index(at)].order = order_of(entity);
    }
    /// Of what was made or moved.
    [[nodiscard]] std::uint64_t order_of(Entity entity) const {
        const auto* const parent = world_.find<Parent>(entity);
        return parent != nullptr ? std::uint64_t{1} + parent->order : 1;
    }

    /// An entity that would be below itself, since the move of one between them could not be saved,
    /// stays where it was.
    void check_move(Entity entity) {
        const int at = find(entity);
        if (at < 0) {
            return;
        }
        std::size_t steps = 0;
        int above = list_[index(at)].parent;
        while (above >= 0 && above != at && ++steps < list_.size()) {
            above = list_[index(above)].parent;
        }
        if (above == at) {
            list_[index(at)].parent = parents_[index(at)];
            list_[index(at)].order = 0;
            leave_out("the move of " + quoted(before_.name(entity)));
            unmoved_.insert(entity);
        }
    }

    /// Whether a name in the level, other than those of entities, is this one.
    static bool refers_to(const JsonValue& json, const FileEntity& entity) {
        if (entity.name.empty()) {
            return false;
        }
        if (json.kind == JsonKind::String) {
            return json.text == entity.name;
        }
        return std::ranges::any_of(
                   json.items, [&](const JsonValue& item) { return refers_to(item, entity); })
               || std::ranges::any_of(json.members, [&](const JsonMember& member) {
                      return member.key == entity.name
                             || (member.key != "name" && refers_to(member.value, entity));
                  });
    }

    /// Not gone, with all below it.
    void keep(FileEntity& entity) {
        entity.is_gone = false;
        const int at = static_cast<int>(&entity - list_.data());
        for (FileEntity& below : list_) {
            if (below.parent == at && below.is_gone) {
                keep(below);
            }
        }
    }

    JsonValue build_children(const std::vector<std::vector<int>>& children, int parent) {
        JsonValue all = json_array();
        for (const int child : children[index(parent + 1)]) {
            JsonValue json = std::move(list_[index(child)].json);
            JsonValue below = build_children(children, child);
            if (!below.items.empty()) {
                json.members.push_back({"children", {}, std::move(below)});
            }
            all.items.push_back(std::move(json));
        }
        return all;
    }

    World& world_;
    const BeforeEdits& before_;
    const FilePlaces& places_;
    EditedLevel& saved_;
    std::vector<FileEntity> list_;
    std::vector<int> parents_;  // of each, before moves
    std::size_t listed_ = 0;    // those of the file come first
    std::unordered_map<Entity, int> made_;
    std::unordered_set<Entity> unmoved_;  // whose move could not be saved
};

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

/// Saves all edits of a level, except for the names of some entities.
class LevelWriter {
  public:
    LevelWriter(
        JsonValue level, FilePlaces places, const std::string& path, const std::string& out,
        World& world, std::span<const Edit> edits)
        : level_(std::move(level)), places_(std::move(places)), path_(path), out_(out),
          world_(world), edits_(edits) {}

    /// Fails if the file would be no level.
    [[nodiscard]] Result<EditedLevel> write(std::span<const Entity> renamed) {
        JsonValue level = level_;
        EditedLevel saved;
        BeforeEdits before(world_, edits_);
        name(level, renamed, before);
        const JsonLocation location{path_, ""};
        LevelEdits all = level_edits(world_, edits_, before);
        saved.left_out = std::move(all.left_out);

        JsonValue listed = json_array();
        std::swap(listed.items, array_member(level, "entities").items);
        FileEntities entities(
            std::move(listed), world_, before, tree_edits(world_, edits_, before), places_, saved);
        for (LevelEdits::Change& change : all.entities) {
            LIMN_TRY(entities.change(std::move(change), location));
        }
        LIMN_TRY(patch(level, std::move(all.patch), location, saved));

        JsonValue destroyed = json_array();
        array_member(level, "entities").items = entities.build(level, destroyed).items;
        JsonValue event = json_object({{"at", {}, json_of(0.0)}});
        if (!all.copies.members.empty()) {
            event.members.push_back({"set", {}, std::move(all.copies)});
        }
        if (!destroyed.items.empty()) {
            event.members.push_back({"destroy", {}, std::move(destroyed)});
        }
        if (event.members.size() > 1) {
            array_member(level, "events").items.push_back(std::move(event));
        }
        saved.text = write_json(level) + '\n';
        LIMN_TRY(include_files(level, path_, {}));
        const Result<Level> parsed = parse_level(write_json(level), out_);
        if (!parsed) {
            return fail("the edited level would be no level: {}", parsed.error().message);
        }
        return saved;
    }

  private:
    /// Renames entities of the file, and those that have no name yet.
    void name(JsonValue& level, std::span<const Entity> renamed, BeforeEdits& before) const {
        EntityNames names;
        std::unordered_map<int, std::string> first;
        for (const Entity entity : renamed) {
            const auto* const now = world_.find<Name>(entity);
            const std::string text = now != nullptr ? now->text : "";
            if (const std::string old = before.name(entity); !old.empty()) {
                names[old] = text;
            } else {
                first[places_.at(entity)] = text;
            }
            before.take_new_name(entity);
        }
        rename_entities(level, names);
        int index = 0;
        add_names(array_member(level, "entities"), first, index);
    }

    static void
    add_names(JsonValue& entities, const std::unordered_map<int, std::string>& names, int& index) {
        for (JsonValue& entity : entities.items) {
            if (const auto found = names.find(index++); found != names.end()) {
                JsonMember named{"name", {}, json_of(std::string_view(found->second))};
                entity.members.insert(entity.members.begin(), std::move(named));
            }
            if (entity.find("children") != nullptr) {
                add_names(array_member(entity, "children"), names, index);
            }
        }
    }

    Status patch(
        JsonValue& level, JsonValue changes, const JsonLocation& location,
        EditedLevel& saved) const {
        JsonValue materials = take_member(changes, "materials");
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
            changes.members.push_back({"materials", {}, std::move(materials)});
        }
        return patch_level(level, changes, location);
    }

    JsonValue level_;
    FilePlaces places_;
    const std::string& path_;
    const std::string& out_;
    World& world_;
    std::span<const Edit> edits_;
};

}  // namespace

Result<EditedLevel> edited_level(
    const std::string& path, const std::string& out, World& world, std::span<const Edit> edits,
    std::span<const Entity> spawned) {
    if (!path.ends_with(kEnding)) {
        return fail("{}: found a model, expected a level: edits are saved as a level", path);
    }
    if (!out.ends_with(kEnding)) {
        return fail("{}: found another ending, expected {}", out, kEnding);
    }
    std::error_code ignored;
    if (std::filesystem::equivalent(path, out, ignored)) {
        return fail("{}: found the level itself, expected a new file", out);
    }
    JsonValue level = LIMN_TRY(load_json(path));
    LIMN_TRY(expect_same_folder(level, path, out));
    JsonValue whole = level;
    LIMN_TRY(include_files(whole, path, {}));
    const BeforeEdits before(world, edits);
    FilePlaces places = LIMN_TRY(find_places(whole, path, world, before, spawned));
    std::vector<Entity> renamed = renamed_entities(world, edits, before);
    std::vector<std::string> left_out;
    const auto leave_out = [&](Entity entity, const std::string& why) {
        const std::string old = before.name(entity);
        left_out.push_back(
            "the new name of " + (old.empty() ? "an entity without a name" : in_quotes(old)) + ": "
            + why);
    };
    const std::vector<Entity> deleted = tree_edits(world, edits, before).deleted;
    const RenameCheck check(whole, world, before, places, renamed, deleted);
    std::erase_if(renamed, [&](Entity entity) {
        const std::string why = check.refusal(entity);
        if (!why.empty()) {
            leave_out(entity, why);
        }
        return !why.empty();
    });
    LevelWriter writer(std::move(level), std::move(places), path, out, world, edits);
    Result<EditedLevel> saved = writer.write(renamed);
    if (!saved && !renamed.empty()) {  // those names that the level can have
        std::vector<Entity> valid;
        for (const Entity entity : renamed) {
            valid.push_back(entity);
            if (const Result<EditedLevel> tried = writer.write(valid); !tried) {
                leave_out(entity, tried.error().message);
                valid.pop_back();
            }
        }
        saved = writer.write(valid);
    }
    if (saved) {
        saved->left_out.insert(saved->left_out.begin(), left_out.begin(), left_out.end());
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
