#include "content/load/level_schema.h"

#include "content/load/level_repeat.h"
#include "content/load/level_show.h"
#include "content/make/make_mesh.h"
#include "content/make/patterns.h"
#include "ecs/components/input.h"
#include "ecs/components/surface.h"
#include "ecs/field_access.h"
#include "ecs/reflect.h"

#include <fmt/format.h>

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace limn {

namespace {

using Members = std::vector<JsonMember>;

JsonMember member(std::string key, JsonValue value) {
    return {std::move(key), {}, std::move(value)};
}

JsonValue text(std::string_view words) {
    return json_of(words);
}

JsonValue number(double x) {
    return json_of(x);
}

JsonValue count(std::size_t n) {
    return json_of(std::uint64_t{n});
}

/// {"type": name, ...}
JsonValue of_type(std::string_view type, Members more = {}) {
    JsonValue schema = json_object({member("type", text(type))});
    for (JsonMember& m : more) {
        schema.members.push_back(std::move(m));
    }
    return schema;
}

JsonValue reference(const std::string& definition) {
    return json_object({member("$ref", text("#/$defs/" + definition))});
}

JsonValue any_of(std::vector<JsonValue> schemas) {
    return json_object({member("anyOf", json_array(std::move(schemas)))});
}

JsonValue array_of(JsonValue items) {
    return of_type("array", {member("items", std::move(items))});
}

JsonValue array_of(JsonValue items, std::size_t min, std::size_t max) {
    JsonValue schema = array_of(std::move(items));
    schema.members.push_back(member("minItems", count(min)));
    schema.members.push_back(member("maxItems", count(max)));
    return schema;
}

JsonValue one_of_words(const std::vector<std::string_view>& words) {
    JsonValue values = json_array();
    for (const std::string_view word : words) {
        values.items.push_back(text(word));
    }
    return json_object({member("enum", std::move(values))});
}

JsonValue constant(std::string_view word) {
    return json_object({member("const", text(word))});
}

/// An object with these properties and no others.
JsonValue closed_object(Members properties, std::vector<JsonValue> required = {}) {
    JsonValue schema = of_type(
        "object", {member("properties", json_object(std::move(properties))),
                   member("additionalProperties", json_of(false))});
    if (!required.empty()) {
        schema.members.push_back(member("required", json_array(std::move(required))));
    }
    return schema;
}

/// An object whose keys are names.
JsonValue map_of(JsonValue values) {
    return of_type("object", {member("additionalProperties", std::move(values))});
}

JsonValue schema_of_number(const FieldInfo& field) {
    const bool is_whole = field.type == FieldType::Int || field.type == FieldType::UInt
                          || field.type == FieldType::IVec2 || field.type == FieldType::IVec3;
    JsonValue schema = of_type(is_whole ? "integer" : "number");
    if (std::isfinite(field.meta.min)) {
        schema.members.push_back(member("minimum", number(field.meta.min)));
    } else if (field.type == FieldType::UInt) {
        schema.members.push_back(member("minimum", number(0)));
    }
    if (std::isfinite(field.meta.max)) {
        schema.members.push_back(member("maximum", number(field.meta.max)));
    }
    const std::vector<std::string_view> units = written_units(field.meta.unit);
    if (!is_whole && !units.empty()) {
        const std::string pattern = fmt::format("^-?[0-9.]+ ?({})$", fmt::join(units, "|"));
        return any_of({std::move(schema), of_type("string", {member("pattern", text(pattern))})});
    }
    return schema;
}

JsonValue schema_of_fields(const std::vector<FieldInfo>& fields);

JsonValue schema_of_element(const FieldInfo& field) {
    switch (field.type) {
    case FieldType::Bool:
        return of_type("boolean");
    case FieldType::String:
        return of_type("string");
    case FieldType::Enum:
        return one_of_words(field.values);
    case FieldType::Entity:
    case FieldType::Asset:
        return json_object({member("type", json_array({text("string"), text("null")}))});
    case FieldType::Struct:
        return schema_of_fields(field.fields);
    case FieldType::Quat:
        return array_of(of_type("number"), 3, 4);
    default:
        break;
    }
    const auto lanes = static_cast<std::size_t>(number_count(field.type));
    if (lanes == 1) {
        return schema_of_number(field);
    }
    const std::size_t min = field.meta.color && lanes == 4 ? 3 : lanes;
    JsonValue numbers = array_of(schema_of_number(field), min, lanes);
    if (field.meta.color) {
        const char* const form =
            lanes == 4 ? "^#([0-9a-fA-F]{6}|[0-9a-fA-F]{8})$" : "^#[0-9a-fA-F]{6}$";
        return any_of({std::move(numbers), of_type("string", {member("pattern", text(form))})});
    }
    return numbers;
}

JsonValue schema_of_field(const FieldInfo& field) {
    JsonValue schema = schema_of_element(field);
    if (field.shape == FieldShape::Array) {
        schema = array_of(std::move(schema), field.count, field.count);
    } else if (field.shape == FieldShape::List) {
        schema = array_of(std::move(schema));
    }
    std::string description = field.meta.doc;
    if (*field.meta.unit != '\0') {
        description += fmt::format(" [{}]", field.meta.unit);
    }
    if (!description.empty()) {
        schema.members.push_back(member("description", text(description)));
    }
    return schema;
}

Members properties_of(const std::vector<FieldInfo>& fields) {
    Members properties;
    for (const FieldInfo& field : fields) {
        properties.push_back(member(field.name, schema_of_field(field)));
    }
    return properties;
}

JsonValue schema_of_fields(const std::vector<FieldInfo>& fields) {
    return closed_object(properties_of(fields));
}

/// {"make": kind, parameters ...} for every kind of a list.
template <typename Kinds>
std::vector<JsonValue> schemas_of_kinds(const Kinds& kinds) {
    std::vector<JsonValue> schemas;
    for (const auto& kind : kinds) {
        Members properties = {member("make", constant(kind.name))};
        for (JsonMember& field : properties_of(kind.parameters->fields)) {
            properties.push_back(std::move(field));
        }
        JsonValue schema = closed_object(std::move(properties), {text("make")});
        schema.members.push_back(member("description", text(kind.doc)));
        schemas.push_back(std::move(schema));
    }
    return schemas;
}

JsonValue schema_of_images() {
    std::vector<JsonValue> schemas = schemas_of_kinds(pattern_kinds());
    schemas.push_back(closed_object(
        {member("file", of_type("string")), member("srgb", of_type("boolean"))}, {text("file")}));
    return map_of(any_of(std::move(schemas)));
}

JsonValue schema_of_materials() {
    Members properties = {
        member("like", of_type("string")), member("pattern", of_type("string")),
        member("tiling", array_of(of_type("number"), 2, 2))};
    for (JsonMember& field : properties_of(component_info<Material>().fields)) {
        properties.push_back(std::move(field));
    }
    return map_of(closed_object(std::move(properties)));
}

JsonValue schema_of_repeat() {
    Members properties = properties_of(component_info<RepeatGrid>().fields);
    JsonValue variation = closed_object(
        {member("by", one_of_words({"random", "x", "y", "z", "radius", "angle", "index"})),
         member("from", json_object()), member("to", json_object()),
         member("pick", of_type("array", {member("minItems", count(1))})),
         member(
             "noise",
             of_type("number", {member("minimum", number(0)), member("maximum", number(1))})),
         member("times", of_type("number", {member("exclusiveMinimum", number(0))}))});
    properties.push_back(member("vary", map_of(std::move(variation))));
    return closed_object(std::move(properties));
}

/// The components of an entity, each at most once; `more` are further properties.
JsonValue schema_of_components(Members more, bool may_be_null) {
    for (const ComponentInfo* const info : all_components()) {
        if (info->name == "name" || info->name == "parent") {
            continue;  // covered by the keys "name" and "children"
        }
        JsonValue schema = reference(info->name);
        more.push_back(member(
            info->name,
            may_be_null ? any_of({std::move(schema), of_type("null")}) : std::move(schema)));
    }
    return closed_object(std::move(more));
}

JsonValue schema_of_node() {
    return schema_of_components(
        {member("name", of_type("string", {member("pattern", text("^[^.]+$"))})),
         member("prefab", of_type("string")), member("gltf", of_type("string")),
         member("repeat", any_of({reference("repeat of a node"), of_type("null")})),
         member("children", array_of(reference("node")))},
        true);
}

JsonValue schema_of_resources() {
    Members properties;
    for (const ComponentInfo* const info : all_resources()) {
        properties.push_back(member(info->name, reference(info->name)));
    }
    return closed_object(std::move(properties));
}

JsonValue schema_of_event() {
    const auto time = [] {
        return of_type("number", {member("minimum", number(0)), member("maximum", number(1e6))});
    };
    return closed_object(
        {member("at", time()), member("every", time()),
         member("times", of_type("integer", {member("minimum", number(1))})),
         member("set", map_of(schema_of_components({}, false))),
         member("set_resources", schema_of_resources()),
         member("impulse", map_of(map_of(of_type("object")))),
         member("spawn", array_of(reference("node"))),
         member("destroy", array_of(of_type("string")))},
        {text("at")});
}

JsonValue schema_of_show() {
    const auto patch = [] {
        return of_type("object", {member("description", text("JSON merge patch of the level"))});
    };
    return closed_object(
        {member("technique", of_type("string")), member("text", of_type("string")),
         member("set", patch()), member("off", patch()),
         member(
             "time",
             of_type("number", {member("minimum", number(0)), member("maximum", number(3600))})),
         member(
             "camera",
             any_of({of_type("string"), schema_of_fields(component_info<ShowCamera>().fields)})),
         member("equal", of_type("boolean"))},
        {text("technique"), text("text")});
}

JsonValue definitions() {
    Members all = {
        member("node", schema_of_node()), member("repeat of a node", schema_of_repeat()),
        member("event", schema_of_event())};
    for (const std::vector<const ComponentInfo*>& infos : {all_components(), all_resources()}) {
        for (const ComponentInfo* const info : infos) {
            all.push_back(member(info->name, schema_of_fields(info->fields)));
        }
    }
    return json_object(std::move(all));
}

}  // namespace

JsonValue level_schema() {
    JsonValue schema = closed_object(
        {member("$schema", of_type("string")), member("title", of_type("string")),
         member("description", of_type("string")), member("resources", schema_of_resources()),
         member("images", schema_of_images()), member("materials", schema_of_materials()),
         member("paths", map_of(schema_of_fields(component_info<PathShape>().fields))),
         member("meshes", map_of(any_of(schemas_of_kinds(mesh_kinds())))),
         member("prefabs", map_of(reference("node"))),
         member("entities", array_of(reference("node"))),
         member("events", array_of(reference("event"))),
         member("shows", array_of(schema_of_show())),
         member("bindings", map_of(array_of(one_of_words(key_names()))))});
    schema.members.insert(
        schema.members.begin(),
        {member("$schema", text("https://json-schema.org/draft/2020-12/schema")),
         member("title", text("A level of Limn"))});
    schema.members.push_back(member("$defs", definitions()));
    return schema;
}

}  // namespace limn
