#include "content/app/player/level_keys.h"

#include "content/load/files/json_document.h"
#include "content/load/level/level_schema.h"
#include "ecs/base/text.h"
#include "ecs/components/surface.h"
#include "ecs/field_access.h"
#include "ecs/reflect.h"

#include <cstddef>
#include <initializer_list>
#include <string_view>
#include <utility>

namespace limn {
namespace {

/// Describes what a schema accepts.
std::string type_of(const JsonValue& schema) {
    constexpr std::size_t kMaxWords = 12;
    if (const JsonValue* const words = schema.find("enum")) {
        std::vector<std::string_view> texts;
        for (const JsonValue& word : words->items) {
            texts.push_back(word.text);
        }
        return texts.size() > kMaxWords ? "name" : "one of " + join_text(texts, " ");
    }
    if (const JsonValue* const any = schema.find("anyOf")) {
        return type_of(any->items.front());
    }
    const std::string& type = schema["type"].text;
    return type == "array"     ? "list"
           : type == "string"  ? "text"
           : type == "boolean" ? "true or false"
           : type == "integer" ? "whole number"
           : type == "number"  ? "number"
                               : "object";
}

/// The properties of `schema` that have a description, recursively; components have none.
void add_keys(const JsonValue& schema, const std::string& prefix, LevelKeys& to) {
    for (const JsonValue& choice : schema["anyOf"].items) {
        add_keys(choice, prefix, to);
    }
    for (const auto& [key, at, property] : schema["properties"].members) {
        if (const JsonValue* const doc = property.find("description")) {
            to.keys.push_back({prefix + key, type_of(property), doc->text});
            add_keys(property, prefix + key + ".", to);
            add_keys(property["additionalProperties"], prefix + key + ".NAME.", to);
            add_keys(property["items"], prefix + key + "[].", to);
        }
    }
}

/// The last of the alternatives for an image, a file: the others are generators.
const JsonValue& schema_of_image_file(const JsonValue& schema) {
    return schema["properties"]["images"]["additionalProperties"]["anyOf"].items.back();
}

}  // namespace

std::vector<LevelKeys> list_level_keys() {
    const JsonValue schema = level_schema();
    const JsonValue& parts = schema["$defs"];
    LevelKeys level{"level", {}};
    for (const auto& [key, at, property] : schema["properties"].members) {
        level.keys.push_back({key, type_of(property), property["description"].text});
    }
    std::vector<LevelKeys> all = {std::move(level)};
    const auto add = [&](const char* name, const JsonValue& part) {
        all.push_back({name, {}});
        add_keys(part, "", all.back());
    };
    add("entity", parts["node"]);
    add("repeat", parts["repeat of a node"]);
    add("event", parts["event"]);
    add("show", schema["properties"]["shows"]["items"]);
    add("image", schema_of_image_file(schema));
    add("material", schema["properties"]["materials"]["additionalProperties"]);
    std::erase_if(all.back().keys, [](const LevelKey& key) {
        const std::string field = key.path.substr(0, key.path.find('.'));
        return find_field(component_info<Material>().fields, field) != nullptr;
    });
    return all;
}

}  // namespace limn
