#include "content/app/panels/edit_json.h"

#include "content/load/files/json_document.h"
#include "content/load/level/level_hints.h"
#include "content/load/level/set_value.h"
#include "ecs/components/gltf_source.h"
#include "ecs/components/name.h"
#include "ecs/components/surface.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

// Techniques: engine.object-text

namespace limn {
namespace {

/// The member `key` of an object, added as an empty object if missing.
JsonValue& member(JsonValue& object, const std::string& key) {
    const auto found =
        std::find_if(object.members.begin(), object.members.end(), [&](const JsonMember& m) {
            return m.key == key;
        });
    return found != object.members.end()
               ? found->value
               : object.members.emplace_back(JsonMember{key, {}, json_object()}).value;
}

void set_member(JsonValue& object, const std::string& key, JsonValue value) {
    member(object, key) = std::move(value);
}

const Name* name_of(const World& world, Entity entity) {
    const Name* const name = world.alive(entity) ? world.find<Name>(entity) : nullptr;
    return name != nullptr && !name->text.empty() ? name : nullptr;
}

/// `object` without the members that are equal in `base`.
JsonValue without_equal(JsonValue object, const JsonValue& base) {
    std::erase_if(object.members, [&](const JsonMember& m) {
        const JsonValue* const other = base.find(m.key);
        return other != nullptr && write_json(*other) == write_json(m.value);
    });
    return object;
}

/// The entity with this name in an array, added if missing.
JsonValue& named(JsonValue& entities, std::string_view name) {
    for (JsonValue& entity : entities.items) {
        if (entity["name"].text == name) {
            return entity;
        }
    }
    JsonValue& added = entities.items.emplace_back(json_object());
    set_member(added, "name", json_of(name));
    return added;
}

/// The entity of a level that references the file of a node, or the root of a file opened directly.
Entity source_of(const World& world, Entity node) {
    while (!node.is_null() && !world.has<GltfSource>(node)) {
        node = parent_of(world, node);
    }
    return node;
}

/// Whether there are assets or entities among the fields: those of a glTF file have no names in a
/// level.
bool names_others(const std::vector<FieldInfo>& fields) {
    return std::any_of(fields.begin(), fields.end(), [](const FieldInfo& field) {
        return field.type == FieldType::Asset || field.type == FieldType::Entity
               || names_others(field.fields);
    });
}

void set_source(JsonValue& object, const GltfSource& source) {
    set_member(object, "gltf", json_of(std::string_view(source.file)));
    if (!source.variant.empty()) {
        set_member(object, "variant", json_of(std::string_view(source.variant)));
    }
}

/// {"name": ..., "gltf": ..., "nodes": {NODE: components}}: how a level changes a node of a file.
std::string node_as_json(const World& world, Entity node, JsonValue components) {
    const Entity source = source_of(world, node);
    JsonValue object = json_object();
    if (source.is_null()) {
        return write_json(components);
    }
    const Name* const owner = name_of(world, source);
    if (owner != nullptr && !world.has<FromGltf>(source)) {
        set_member(object, "name", json_of(std::string_view(owner->text)));
    }
    set_source(object, world.get<const GltfSource>(source));
    const Name* const name = name_of(world, node);
    if (name == nullptr) {
        return write_json(object) + "  // unnamed node: a level cannot refer to it";
    }
    set_member(member(object, "nodes"), name->text, std::move(components));
    return write_json(object);
}

/// Whether `repeat` created the entity.
bool is_copy(const Name& name) {
    const std::size_t open = name.text.rfind('[');
    return open != std::string::npos && open > 0 && name.text.ends_with(']');
}

/// "post" of its copy "post[2]".
std::string_view repeated_name(const Name& copy) {
    return std::string_view(copy.text).substr(0, copy.text.rfind('['));
}

/// The entity itself or the nearest ancestor that `repeat` created; null if there is none.
Entity nearest_copy(const World& world, Entity entity) {
    for (; !entity.is_null(); entity = parent_of(world, entity)) {
        const Name* const name = name_of(world, entity);
        if (name != nullptr && is_copy(*name)) {
            break;
        }
    }
    return entity;
}

/// The entity in whose "nodes" a level changes this one: the one that references a node's file, or
/// the outermost ancestor below one that references a file.
Entity owner_of(const World& world, Entity entity) {
    for (Entity parent = parent_of(world, entity); !parent.is_null();
         parent = parent_of(world, entity)) {
        if (world.has<FromGltf>(entity) && !world.has<FromGltf>(parent)) {
            return parent;
        }
        if (!world.has<FromGltf>(entity) && world.has<GltfSource>(parent)) {
            return entity;
        }
        entity = parent;
    }
    return entity;
}

/// An entity and its children, as in a level.
class CopiedTree {
  public:
    CopiedTree(const World& world, const Hierarchy& tree, Entity root)
        : world_(world), tree_(tree), provider_(make_name_provider(world)) {
        add_names(root);
        provider_.entity = [this, others = provider_.entity](Entity entity) {
            const auto own = names_.find(entity);
            return own != names_.end() ? own->second : others(entity);
        };
    }
    /// With names as they are saved.
    CopiedTree(const World& world, const Hierarchy& tree, Entity root, const BeforeEdits& before)
        : CopiedTree(world, tree, root) {
        provider_.entity = [&before](Entity entity) { return before.name(entity); };
    }
    CopiedTree(const CopiedTree&) = delete;
    CopiedTree& operator=(const CopiedTree&) = delete;

    /// For a node of a glTF file, only its components.
    [[nodiscard]] JsonValue object_of(Entity entity) const {
        JsonValue object = json_object();
        const bool is_node = world_.has<FromGltf>(entity);
        if (const auto name = names_.find(entity); name != names_.end()) {
            set_member(object, "name", json_of(std::string_view(name->second)));
        }
        if (const auto* const source = world_.find<GltfSource>(entity);
            source != nullptr && !is_node) {
            set_source(object, *source);
        }
        for (const ComponentId id : world_.components_of(entity)) {
            const ComponentInfo& info = component_info(id);
            if (!info.is_registered || !info.saved || is_internal(info)
                || info.id
                       == component_id<
                           Name> || info.id == component_id<Parent> || (is_node && names_others(info.fields))) {
                continue;
            }
            const AnyComponent value = AnyComponent::read(world_, entity, info);
            JsonValue json = write_component(info, value.data(), provider_);
            if (info.defaults != nullptr && !is_node) {  // a file's values may differ
                json = without_equal(std::move(json), write_component(info, info.defaults, {}));
            }
            set_member(object, info.name, std::move(json));
        }
        JsonValue children = json_array();
        for (const Entity child : children_of(entity)) {
            children.items.push_back(object_of(child));
        }
        if (!children.items.empty()) {
            set_member(object, "children", std::move(children));
        }
        return object;
    }

  private:
    /// Children that a level has to list, in order; those from a glTF file are in that file.
    [[nodiscard]] std::vector<Entity> children_of(Entity entity) const {
        std::vector<Entity> children;
        for (const Entity child : tree_.children_of(entity)) {
            if (!world_.has<FromGltf>(entity) && !world_.has<FromGltf>(child)) {
                children.push_back(child);
            }
        }
        return children;
    }

    /// Instances of a prefab have children of the same name, which must be unique in a level:
    /// "glow" and "glow 2".
    void add_names(Entity entity) {
        const Name* const name = name_of(world_, entity);
        if (name != nullptr && !world_.has<FromGltf>(entity)) {
            std::string own = name->text;
            for (int i = 2; !used_.insert(own).second; ++i) {
                own = fmt::format("{} {}", name->text, i);
            }
            names_[entity] = std::move(own);
        }
        for (const Entity child : children_of(entity)) {
            add_names(child);
        }
    }

    const World& world_;
    const Hierarchy& tree_;
    NameProvider provider_;
    std::unordered_map<Entity, std::string> names_;
    std::unordered_set<std::string> used_;
};

const ComponentInfo& edited_info(const Edit& edit) {
    return edit.before.is_empty() ? edit.after.info() : edit.before.info();
}

/// The value before its first edit.
const Edit& first_edit_of(std::span<const Edit> edits, const Edit& edit) {
    const auto same = [&](const Edit& other) {
        return !other.tree && other.part == edit.part && other.entity == edit.entity
               && other.material == edit.material && &edited_info(other) == &edited_info(edit);
    };
    return *std::find_if(edits.begin(), edits.end(), same);
}

/// The changes of `entity`, added if there are none yet.
JsonValue& changes_of(LevelEdits& edits, Entity entity) {
    const auto found = std::ranges::find(edits.entities, entity, &LevelEdits::Change::entity);
    return found != edits.entities.end()
               ? found->components
               : edits.entities.emplace_back(LevelEdits::Change{entity, json_object()}).components;
}

/// Where a level changes the components of an entity called `name`; null if it cannot refer to it.
JsonValue* patched(
    const World& world, LevelEdits& edits, Entity entity, const Name& name,
    const BeforeEdits& before) {
    if (!nearest_copy(world, parent_of(world, entity)).is_null()) {
        return nullptr;
    }
    if (before.parent(entity) != parent_of(world, entity)) {  // moved: nothing else changes it
        return is_copy(name) ? nullptr : &changes_of(edits, entity);
    }
    const Entity owner = owner_of(world, entity);
    if (owner == entity) {
        return is_copy(name) ? &member(edits.copies, name.text) : &changes_of(edits, entity);
    }
    if (name.text.empty() || before.name(owner).empty() || world.has<FromGltf>(owner)) {
        return &changes_of(edits, entity);
    }
    return is_copy(name) ? nullptr : &member(member(changes_of(edits, owner), "nodes"), name.text);
}

std::string move_text(const World& world, Entity entity, const BeforeEdits& before) {
    const auto named = [&](Entity one) {
        const std::string name = before.name(one);
        return name.empty() ? "an entity without a name" : in_quotes(name);
    };
    const Entity parent = parent_of(world, entity);
    return named(entity) + ' '
           + (parent.is_null() ? "out of its parent's children"
                               : "to the children of " + named(parent));
}

/// Adds what was made to "entities". A patch can have children only in a root of the level:
/// elsewhere they have to be moved in the file, as what was moved. Returns comments for that.
std::string
add_made(World& world, const TreeEdits& trees, const BeforeEdits& before, JsonValue& entities) {
    const std::unordered_set<Entity> made(trees.made.begin(), trees.made.end());
    std::vector<Entity> moved = trees.moved;
    for (const Entity root : trees.made) {
        const Entity parent = parent_of(world, root);
        if (made.contains(parent)) {
            continue;  // written with it
        }
        const Name* const above = name_of(world, parent);
        const bool is_root = above != nullptr && parent_of(world, parent).is_null()
                             && !is_copy(*above) && !world.has<FromGltf>(parent);
        JsonValue object = CopiedTree(world, hierarchy(world), root).object_of(root);
        if (is_root) {
            JsonValue& children = member(named(entities, before.name(parent)), "children");
            children.kind = JsonKind::Array;
            children.items.push_back(std::move(object));
            continue;
        }
        entities.items.push_back(std::move(object));
        if (!parent.is_null()) {
            moved.push_back(root);
        }
    }
    std::string comments;
    for (const Entity entity : moved) {
        if (!made.contains(parent_of(world, entity)) || made.contains(entity)) {
            comments += "  // move " + move_text(world, entity, before);
        }
    }
    return comments;
}

/// The names of the roots of what was deleted.
JsonValue destroyed_names(
    const TreeEdits& trees, const BeforeEdits& before, std::vector<std::string>& left_out) {
    const std::unordered_set<Entity> deleted(trees.deleted.begin(), trees.deleted.end());
    JsonValue names = json_array();
    for (const Entity entity : trees.deleted) {
        if (deleted.contains(before.parent(entity))) {
            continue;
        }
        const std::string name = before.name(entity);
        if (!name.empty()) {
            names.items.push_back(json_of(std::string_view(name)));
        } else {
            left_out.emplace_back(
                "the deletion of an entity that has no name: delete it in the file");
        }
    }
    return names;
}

}  // namespace

std::string component_as_json(const World& world, const ComponentInfo& info, const void* value) {
    return '"' + info.name
           + "\": " + write_json(write_component(info, value, make_name_provider(world)));
}

std::string entity_as_json(World& world, Entity entity) {
    JsonValue object = CopiedTree(world, hierarchy(world), entity).object_of(entity);
    return world.has<FromGltf>(entity) ? node_as_json(world, entity, std::move(object))
                                       : write_json(object);
}

std::string edit_note(const World& world, Entity entity) {
    const Entity copy = nearest_copy(world, entity);
    const Name* const name = name_of(world, copy);
    if (name == nullptr) {
        return name_of(world, entity) == nullptr
                   ? "has no name: its edits cannot be copied, and are saved only if the level's "
                     "file lists it"
                   : "";
    }
    const std::string_view repeated = repeated_name(*name);
    std::size_t copies = 0;
    world.query<const Name>().each([&](Entity one, const Name& other) {
        copies += is_copy(other) && repeated_name(other) == repeated
                          && parent_of(world, one) == parent_of(world, copy)
                      ? 1
                      : 0;
    });
    const bool is_kept = copy == entity && nearest_copy(world, parent_of(world, copy)).is_null()
                         && owner_of(world, copy) == copy;
    return fmt::format(
        "{} of {} copies of {} by repeat: {}", copy == entity ? "one" : "part of one", copies,
        repeated,
        is_kept ? "its edits are copied as an event; to edit all copies, edit the level's file"
                : "its edits cannot be copied; edit the prefab or the repeat in the level's file");
}

BeforeEdits::BeforeEdits(const World& world, std::span<const Edit> edits) : world_(world) {
    const auto add_parent = [&](Entity entity, const AnyComponent& value) {
        parents_.try_emplace(entity, value.is_empty() ? Entity{} : value.as<Parent>().entity);
    };
    std::unordered_set<Entity> made;
    for (const Edit& edit : edits) {
        if (edit.tree && edit.tree->made) {
            made.insert(edit.tree->entities.begin(), edit.tree->entities.end());
        }
        if (edit.tree && !edit.tree->made) {
            const EditedTree& tree = *edit.tree;
            for (std::size_t i = 0; i < tree.entities.size(); ++i) {
                for (const AnyComponent& value : tree.components.entities[i].components) {
                    if (&value.info() == &component_info<Name>()) {
                        names_.try_emplace(tree.entities[i], value.as<Name>().text);
                    }
                    if (&value.info() == &component_info<Parent>()) {
                        parents_.try_emplace(
                            tree.entities[i], tree.entities[value.as<Parent>().entity.index]);
                    }
                }
            }
        }
        if (edit.tree || edit.part != LevelPart::Component) {
            continue;
        }
        if (&edited_info(edit) == &component_info<Parent>()) {
            add_parent(edit.entity, edit.before);
        }
        if (&edited_info(edit) == &component_info<Name>() && !made.contains(edit.entity)) {
            names_.try_emplace(
                edit.entity, edit.before.is_empty() ? std::string() : edit.before.as<Name>().text);
        }
    }
}

std::string BeforeEdits::name(Entity entity) const {
    const auto found = names_.find(entity);
    const Name* const now = name_of(world_, entity);
    return found != names_.end() ? found->second : now != nullptr ? now->text : std::string();
}

Entity BeforeEdits::parent(Entity entity) const {
    const auto found = parents_.find(entity);
    return found != parents_.end() ? found->second : parent_of(world_, entity);
}

std::vector<Entity>
renamed_entities(const World& world, std::span<const Edit> edits, const BeforeEdits& before) {
    std::unordered_set<Entity> made;
    std::vector<Entity> renamed;
    for (const Edit& edit : edits) {
        if (edit.tree && edit.tree->made) {
            made.insert(edit.tree->entities.begin(), edit.tree->entities.end());
        }
        const bool is_name = !edit.tree && edit.part == LevelPart::Component
                             && &edited_info(edit) == &component_info<Name>();
        if (!is_name || !exists(world, edit.entity) || made.contains(edit.entity)
            || std::ranges::find(renamed, edit.entity) != renamed.end()) {
            continue;
        }
        const Name* const now = name_of(world, edit.entity);
        if ((now != nullptr ? now->text : std::string()) != before.name(edit.entity)) {
            renamed.push_back(edit.entity);
        }
    }
    return renamed;
}

TreeEdits tree_edits(const World& world, std::span<const Edit> edits, const BeforeEdits& before) {
    TreeEdits trees;
    std::unordered_set<Entity> made;
    std::unordered_set<Entity> seen;
    for (const Edit& edit : edits) {
        if (!edit.tree) {
            continue;
        }
        for (const Entity entity : edit.tree->entities) {
            if (edit.tree->made) {
                made.insert(entity);
            }
            if (!seen.insert(entity).second) {
                continue;
            }
            if (!exists(world, entity) && !edit.tree->made) {
                trees.deleted.push_back(entity);
            }
        }
    }
    for (const Edit& edit : edits) {
        const bool moves = edit.part == LevelPart::Component && !edit.tree
                           && &edited_info(edit) == &component_info<Parent>();
        if (moves && exists(world, edit.entity) && !made.contains(edit.entity)
            && before.parent(edit.entity) != parent_of(world, edit.entity)
            && std::ranges::find(trees.moved, edit.entity) == trees.moved.end()) {
            trees.moved.push_back(edit.entity);
        }
    }
    // Made ones may have been moved below others that were made later.
    const std::function<void(Entity)> add = [&](Entity entity) {
        if (!exists(world, entity) || made.erase(entity) == 0) {
            return;
        }
        add(parent_of(world, entity));
        trees.made.push_back(entity);
    };
    for (const Edit& edit : edits) {
        if (edit.tree && edit.tree->made) {
            for (const Entity entity : edit.tree->entities) {
                add(entity);
            }
        }
    }
    return trees;
}

LevelEdits level_edits(const World& world, std::span<const Edit> edits, const BeforeEdits& before) {
    LevelEdits all;
    all.patch = json_object();
    all.copies = json_object();
    NameProvider names = make_name_provider(world);
    names.entity = [&](Entity entity) { return before.name(entity); };
    std::unordered_set<Entity> made;
    for (const Edit& edit : edits) {
        if (edit.tree && edit.tree->made) {
            made.insert(edit.tree->entities.begin(), edit.tree->entities.end());
        }
    }
    const auto leave_out = [&](std::string what) {
        if (std::ranges::find(all.left_out, what) == all.left_out.end()) {
            all.left_out.push_back(std::move(what));
        }
    };
    for (const Edit& edit : edits) {
        const bool is_component = edit.part == LevelPart::Component;
        if (edit.tree
            || (is_component && (made.contains(edit.entity) || !exists(world, edit.entity)))) {
            continue;
        }
        const ComponentInfo& info = edited_info(edit);
        if (is_component && (info.id == component_id<Parent> || info.id == component_id<Name>)) {
            continue;  // TreeEdits, and renamed_entities()
        }
        const AnyComponent& first = first_edit_of(edits, edit).before;
        const JsonValue old =
            first.is_empty() ? json_object() : write_component(info, first.data(), names);
        const auto edited = [&](const void* now) {
            return without_equal(write_component(info, now, names), old);
        };
        switch (edit.part) {
        case LevelPart::Component: {
            const Name name{before.name(edit.entity)};
            JsonValue value;
            if (world.has(edit.entity, info.id)) {
                value = edited(AnyComponent::read(world, edit.entity, info).data());
            } else if (first.is_empty()) {
                break;  // added and removed again
            }
            if (JsonValue* const target = patched(world, all, edit.entity, name, before)) {
                set_member(*target, info.name, std::move(value));
            } else {
                leave_out("edits of children of copies: a level cannot refer to those");
            }
            break;
        }
        case LevelPart::Resource:
            if (const void* const now = world.find_resource(info.id)) {
                set_member(member(all.patch, "resources"), info.name, edited(now));
            }
            break;
        case LevelPart::Material: {
            const auto* const assets = world.find_resource<Assets>();
            if (assets != nullptr && edit.material < assets->materials.size()) {
                const Material& now = assets->materials[edit.material];
                set_member(member(all.patch, "materials"), now.name, edited(&now));
            }
            break;
        }
        case LevelPart::MotionGraph:
            break;  // only in files
        }
    }
    return all;
}

JsonValue entity_without_children(World& world, Entity entity, const BeforeEdits& before) {
    JsonValue object = CopiedTree(world, hierarchy(world), entity, before).object_of(entity);
    std::erase_if(object.members, [](const JsonMember& m) { return m.key == "children"; });
    return object;
}

std::string edits_as_json(World& world, std::span<const Edit> edits) {
    const BeforeEdits before(world, edits);
    LevelEdits all = level_edits(world, edits, before);
    const TreeEdits trees = tree_edits(world, edits, before);
    JsonValue entities = json_array();
    for (LevelEdits::Change& change : all.entities) {
        const std::string name = before.name(change.entity);
        if (name.empty()) {
            all.left_out.emplace_back("edits of entities without a name: name them in the file");
            continue;
        }
        JsonValue& entity = named(entities, name);
        for (JsonMember& m : change.components.members) {
            set_member(entity, m.key, std::move(m.value));
        }
    }
    for (const Entity entity : renamed_entities(world, edits, before)) {
        all.left_out.push_back(
            "the new name of " + in_quotes(before.name(entity)) + ": rename it in the file");
    }
    const std::string comments = add_made(world, trees, before, entities);
    JsonValue destroyed = destroyed_names(trees, before, all.left_out);
    if (!entities.items.empty()) {
        set_member(all.patch, "entities", std::move(entities));
    }
    if (!all.copies.members.empty() || !destroyed.items.empty()) {
        JsonValue event = json_object();
        set_member(event, "at", json_of(0.0));
        if (!all.copies.members.empty()) {
            set_member(event, "set", std::move(all.copies));
        }
        if (!destroyed.items.empty()) {
            set_member(event, "destroy", std::move(destroyed));
        }
        set_member(all.patch, "events", json_array({std::move(event)}));
    }
    std::string text = write_json(all.patch) + comments;
    for (const std::string& what : all.left_out) {
        text += "  // without " + what;
    }
    return text;
}

}  // namespace limn
