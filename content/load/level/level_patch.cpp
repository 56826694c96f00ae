#include "content/load/level/level_patch.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace limn {
namespace {

JsonMember* find_member(JsonValue& json, std::string_view key) {
    const auto found =
        std::find_if(json.members.begin(), json.members.end(), [key](const JsonMember& member) {
            return member.key == key;
        });
    return found != json.members.end() ? &*found : nullptr;
}

Status patch_json(JsonValue& target, const JsonValue& patch, const JsonLocation& location);

/// The first of the nodes and their descendants with that name. Collects visited names.
JsonValue*
find_node(JsonValue& nodes, std::string_view name, std::vector<std::string_view>& names) {
    for (JsonValue& node : nodes.items) {
        const JsonValue& own = node["name"];
        names.push_back(own.text);
        if (own.kind == JsonKind::String && own.text == name) {
            return &node;
        }
        JsonMember* const children = find_member(node, "children");
        JsonValue* const found =
            children != nullptr ? find_node(children->value, name, names) : nullptr;
        if (found != nullptr) {
            return found;
        }
    }
    return nullptr;
}

/// Changes nodes by name; the key "+" adds nodes.
Status patch_nodes(JsonValue& nodes, const JsonValue& patch, const JsonLocation& location) {
    LIMN_TRY(expect(patch, JsonKind::Object, location, "the names of entities (an object)"));
    for (const JsonMember& member : patch.members) {
        if (member.key == "+") {
            const std::vector<JsonValue>& added = member.value.items;
            LIMN_TRY(expect(
                member.value, JsonKind::Array, location_in(location, "+"), "entities (an array)"));
            nodes.items.insert(nodes.items.end(), added.begin(), added.end());
            continue;
        }
        std::vector<std::string_view> names;
        JsonValue* const node = find_node(nodes, member.key, names);
        if (node == nullptr) {
            return error_at(
                location, member.at, "the entity " + in_quotes(member.key),
                "the name of one in this level" + did_you_mean(member.key, names));
        }
        if (member.value.kind == JsonKind::Null) {
            const auto is_named = [&](const JsonValue& other) {
                return other["name"].text == member.key;
            };
            if (std::erase_if(nodes.items, is_named) == 0) {
                return error_at(
                    location, member.at, "null for the child " + in_quotes(member.key),
                    "an entity without a parent, or a patch");
            }
            continue;
        }
        LIMN_TRY(patch_json(*node, member.value, location_in(location, member.key)));
    }
    return Done{};
}

Status patch_json(JsonValue& target, const JsonValue& patch, const JsonLocation& location) {
    if (target.kind != JsonKind::Object) {
        target = json_object();
        target.at = patch.at;
    }
    for (const JsonMember& member : patch.members) {
        JsonMember* own = find_member(target, member.key);
        if (member.value.kind == JsonKind::Null && own != nullptr) {
            std::erase_if(
                target.members, [&](const JsonMember& other) { return other.key == member.key; });
            continue;
        }
        const bool is_list = member.key == "entities" || member.key == "children";
        if (own == nullptr) {
            // A null for a missing member stays: it removes a prefab's component.
            const JsonKind kind =
                member.value.kind == JsonKind::Object ? JsonKind::Object : member.value.kind;
            target.members.push_back({member.key, member.at, {}});
            own = &target.members.back();
            own->value.kind = is_list ? JsonKind::Array : kind;
            own->value.at = member.value.at;
        }
        const JsonLocation inner = location_in(location, member.key);
        if (is_list) {
            LIMN_TRY(patch_nodes(own->value, member.value, inner));
        } else if (member.value.kind == JsonKind::Object) {
            LIMN_TRY(patch_json(own->value, member.value, inner));
        } else {
            own->value = member.value;
        }
    }
    return Done{};
}

}  // namespace

JsonValue* find_entity_json(JsonValue& nodes, std::string_view name) {
    std::vector<std::string_view> names;
    return find_node(nodes, name, names);
}

Status patch_level(JsonValue& level, const JsonValue& patch, const JsonLocation& location) {
    return patch_json(level, patch, location);
}

}  // namespace limn
