#include "content/load/level/level_rename.h"

#include "ecs/field_access.h"
#include "ecs/reflect.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

// Techniques: engine.editor-inspector

namespace limn {
namespace {

JsonValue* member_in(JsonValue& object, std::string_view key) {
    const auto found = std::ranges::find(object.members, key, &JsonMember::key);
    return found != object.members.end() ? &found->value : nullptr;
}

/// Of the member `key`; none if it is missing.
std::span<JsonValue> elements_of(JsonValue& object, std::string_view key) {
    JsonValue* const member = member_in(object, key);
    return member != nullptr ? std::span(member->items) : std::span<JsonValue>();
}
std::span<JsonMember> entries_of(JsonValue& object, std::string_view key) {
    JsonValue* const member = member_in(object, key);
    return member != nullptr ? std::span(member->members) : std::span<JsonMember>();
}

bool has_name(const JsonValue& node, const std::string& name) {
    const auto is_named = [&](const JsonValue& child) { return has_name(child, name); };
    return node["name"].text == name || std::ranges::any_of(node["children"].items, is_named);
}

struct Renamer {
    const EntityNames& names;
    std::size_t& references;  ///< counts those that were renamed

    /// Whether the name has changed.
    bool rename(std::string& text) const {
        // "post[2]" is a copy of "post"
        const std::size_t end = text.ends_with(']') ? text.rfind('[') : text.size();
        if (const auto found = names.find(text); found != names.end()) {
            text = found->second;
            return true;
        }
        if (const auto repeated = names.find(text.substr(0, end)); repeated != names.end()) {
            text = repeated->second + text.substr(std::min(end, text.size()));
            return true;
        }
        return false;
    }

    void refer(std::string& text) const { references += rename(text) ? 1u : 0u; }

    void rename_field(JsonValue& value, const FieldInfo& field) const {
        for (JsonValue& item : value.items) {
            rename_field(item, field);
        }
        if (field.type == FieldType::Entity && value.kind == JsonKind::String) {
            refer(value.text);
        }
        rename_fields(value, field.fields);
    }

    void rename_fields(JsonValue& object, const std::vector<FieldInfo>& fields) const {
        for (JsonMember& member : object.members) {
            if (const FieldInfo* const field = find_field(fields, member.key)) {
                rename_field(member.value, *field);
            }
        }
    }

    void rename_components(JsonValue& components) const {
        for (JsonMember& member : components.members) {
            if (const ComponentInfo* const info = find_component(member.key)) {
                rename_fields(member.value, info->fields);
            }
        }
    }

    void rename_resources(std::span<JsonMember> resources) const {
        for (JsonMember& member : resources) {
            if (const ComponentInfo* const info = find_resource(member.key)) {
                rename_fields(member.value, info->fields);
            }
        }
    }

    /// An entity and its children; those of a prefab keep their names.
    void rename_node(JsonValue& node, bool is_own) const {
        JsonValue* const name = member_in(node, "name");
        if (is_own && name != nullptr) {
            rename(name->text);
        }
        rename_components(node);
        for (JsonMember& changed : entries_of(node, "nodes")) {
            rename_components(changed.value);
        }
        rename_nodes(elements_of(node, "children"), is_own);
    }

    void rename_nodes(std::span<JsonValue> nodes, bool is_own) const {
        for (JsonValue& node : nodes) {
            rename_node(node, is_own);
        }
    }

    /// {"lamp": {"point_light": ...}}
    void rename_targets(std::span<JsonMember> targets) const {
        for (JsonMember& target : targets) {
            refer(target.key);
            rename_components(target.value);
        }
    }

    void rename_events(std::span<JsonValue> events) const {
        for (JsonValue& event : events) {
            rename_targets(entries_of(event, "set"));
            rename_targets(entries_of(event, "impulse"));
            rename_resources(entries_of(event, "set_resources"));
            rename_resources(entries_of(event, "impulse_resources"));
            rename_nodes(elements_of(event, "spawn"), false);
            for (JsonValue& destroyed : elements_of(event, "destroy")) {
                refer(destroyed.text);
            }
        }
    }

    /// A patch of entities by name, and of their children; "+" adds some.
    void rename_changes(std::span<JsonMember> entities) const {
        for (JsonMember& entity : entities) {
            if (entity.key == "+") {
                rename_nodes(entity.value.items, true);
                continue;
            }
            refer(entity.key);
            rename_components(entity.value);
            rename_changes(entries_of(entity.value, "children"));
        }
    }

    /// What a show changes in the level.
    void rename_patch(JsonValue& show, std::string_view key) const {
        if (JsonValue* const patch = member_in(show, key)) {
            rename_changes(entries_of(*patch, "entities"));
            rename_resources(entries_of(*patch, "resources"));
            rename_events(elements_of(*patch, "events"));
        }
    }

    void rename_level(JsonValue& level) const {
        rename_nodes(elements_of(level, "entities"), true);
        rename_resources(entries_of(level, "resources"));
        for (JsonMember& prefab : entries_of(level, "prefabs")) {
            rename_node(prefab.value, false);
        }
        rename_events(elements_of(level, "events"));
        for (JsonValue& show : elements_of(level, "shows")) {
            rename_patch(show, "set");
            rename_patch(show, "off");
            JsonValue* const camera = member_in(show, "camera");
            if (camera != nullptr && camera->kind == JsonKind::String) {
                refer(camera->text);
            }
        }
    }
};

}  // namespace

bool is_prefab_name(const JsonValue& level, const std::string& name) {
    const auto is_named = [&](const JsonValue& node) { return has_name(node, name); };
    return std::ranges::any_of(level["prefabs"].members, is_named, &JsonMember::value)
           || std::ranges::any_of(level["events"].items, [&](const JsonValue& event) {
                  return std::ranges::any_of(event["spawn"].items, is_named);
              });
}

bool is_referred_to(const JsonValue& level, const std::string& name) {
    JsonValue copy = level;
    const EntityNames same = {{name, name}};
    std::size_t references = 0;
    Renamer{same, references}.rename_level(copy);
    return references > 0;
}

void rename_entities(JsonValue& level, const EntityNames& names) {
    std::size_t references = 0;
    Renamer{names, references}.rename_level(level);
}

}  // namespace limn
