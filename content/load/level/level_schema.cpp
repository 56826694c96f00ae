#include "content/load/level/level_schema.h"

#include "content/load/level/color_names.h"
#include "content/load/level/level_hints.h"
#include "content/load/level/level_repeat.h"
#include "content/load/level/level_show.h"
#include "content/make/make_mesh.h"
#include "content/make/patterns/patterns.h"
#include "ecs/components/input.h"
#include "ecs/components/motion_graph.h"
#include "ecs/components/surface.h"
#include "ecs/field_access.h"
#include "ecs/reflect.h"

#include <fmt/format.h>

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

// Techniques: engine.type-registry

namespace limn {

namespace {

using Members = std::vector<JsonMember>;

constexpr const char* kColorName = "name of a color";  // name of a definition

JsonMember schema_member(std::string key, JsonValue value) {
    return {std::move(key), {}, std::move(value)};
}

JsonValue schema_text(std::string_view words) {
    return json_of(words);
}

JsonValue number(double x) {
    return json_of(x);
}

/// A limit of a field, with the fewest digits: 0.1 for the float nearest to it.
JsonValue limit(double x) {
    const float as_float = static_cast<float>(x);
    return as_float == x ? json_of(as_float) : json_of(x);
}

JsonValue count(std::size_t n) {
    return json_of(std::uint64_t{n});
}

/// {"type": name, ...}
JsonValue of_type(std::string_view type, Members more = {}) {
    JsonValue schema = json_object({schema_member("type", schema_text(type))});
    for (JsonMember& m : more) {
        schema.members.push_back(std::move(m));
    }
    return schema;
}

JsonValue reference(const std::string& definition) {
    return json_object({schema_member("$ref", schema_text("#/$defs/" + definition))});
}

JsonValue any_of(std::vector<JsonValue> schemas) {
    return json_object({schema_member("anyOf", json_array(std::move(schemas)))});
}

JsonValue array_of(JsonValue items) {
    return of_type("array", {schema_member("items", std::move(items))});
}

JsonValue array_of(JsonValue items, std::size_t min, std::size_t max) {
    JsonValue schema = array_of(std::move(items));
    schema.members.push_back(schema_member("minItems", count(min)));
    schema.members.push_back(schema_member("maxItems", count(max)));
    return schema;
}

JsonValue one_of_words(const std::vector<std::string_view>& words) {
    JsonValue values = json_array();
    for (const std::string_view word : words) {
        values.items.push_back(schema_text(word));
    }
    return json_object({schema_member("enum", std::move(values))});
}

JsonValue constant(std::string_view word) {
    return json_object({schema_member("const", schema_text(word))});
}

/// The schema with a description for editors.
JsonValue described(JsonValue schema, std::string_view words) {
    schema.members.push_back(schema_member("description", schema_text(words)));
    return schema;
}

JsonValue described(JsonValue schema, std::string_view words, JsonValue by_default) {
    schema.members.push_back(schema_member("default", std::move(by_default)));
    return described(std::move(schema), words);
}

/// An object with these properties and no others.
JsonValue closed_object(Members properties, std::vector<JsonValue> required = {}) {
    JsonValue schema = of_type(
        "object", {schema_member("properties", json_object(std::move(properties))),
                   schema_member("additionalProperties", json_of(false))});
    if (!required.empty()) {
        schema.members.push_back(schema_member("required", json_array(std::move(required))));
    }
    return schema;
}

/// An object whose keys are names.
JsonValue map_of(JsonValue values) {
    return of_type("object", {schema_member("additionalProperties", std::move(values))});
}

JsonValue schema_of_number(const FieldInfo& field) {
    const bool is_whole = field.type == FieldType::Int || field.type == FieldType::UInt
                          || field.type == FieldType::IVec2 || field.type == FieldType::IVec3;
    JsonValue schema = of_type(is_whole ? "integer" : "number");
    if (std::isfinite(field.meta.min)) {
        schema.members.push_back(schema_member("minimum", limit(field.meta.min)));
    } else if (field.type == FieldType::UInt) {
        schema.members.push_back(schema_member("minimum", number(0)));
    }
    if (std::isfinite(field.meta.max)) {
        schema.members.push_back(schema_member("maximum", limit(field.meta.max)));
    }
    const std::vector<std::string_view> units = written_units(field.meta.unit);
    if (!is_whole && !units.empty()) {
        const std::string pattern = fmt::format("^-?[0-9.]+ ?({})$", fmt::join(units, "|"));
        return any_of(
            {std::move(schema),
             of_type("string", {schema_member("pattern", schema_text(pattern))})});
    }
    return schema;
}

/// Seconds 0 .. max, optionally with a unit.
JsonValue schema_of_time(double max) {
    FieldInfo time;
    time.meta = {.unit = "s", .min = 0, .max = max};
    return schema_of_number(time);
}

/// `defaults` is a struct with these fields, or null if there are none.
JsonValue schema_of_fields(const std::vector<FieldInfo>& fields, const void* defaults);

JsonValue schema_of_element(const FieldInfo& field, const void* defaults) {
    switch (field.type) {
    case FieldType::Bool:
        return of_type("boolean");
    case FieldType::String:
        return of_type("string");
    case FieldType::Enum:
        return one_of_words(field.values);
    case FieldType::Entity:
    case FieldType::Asset:
        return json_object(
            {schema_member("type", json_array({schema_text("string"), schema_text("null")}))});
    case FieldType::Struct:
        return schema_of_fields(field.fields, defaults);
    case FieldType::Quat: {
        FieldInfo angle;
        angle.meta.unit = "deg";
        return array_of(schema_of_number(angle), 3, 4);
    }
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
        return any_of(
            {std::move(numbers), of_type("string", {schema_member("pattern", schema_text(form))}),
             reference(kColorName)});
    }
    return numbers;
}

JsonValue schema_of_field(const FieldInfo& field, const void* defaults) {
    const void* const value =
        defaults != nullptr ? static_cast<const std::byte*>(defaults) + field.offset : nullptr;
    const bool is_struct = field.type == FieldType::Struct;
    JsonValue schema = schema_of_element(field, field.shape == FieldShape::One ? value : nullptr);
    if (field.shape == FieldShape::Array) {
        schema = array_of(std::move(schema), field.count, field.count);
    } else if (field.shape == FieldShape::List) {
        schema = array_of(std::move(schema));
    }
    if (value != nullptr && !(is_struct && field.shape == FieldShape::One)) {
        schema.members.push_back(schema_member("default", write_field(field, value, {})));
    }
    std::string description = field.meta.doc;
    if (*field.meta.unit != '\0') {
        description += fmt::format(" [{}]", field.meta.unit);
    }
    if (!description.empty()) {
        return described(std::move(schema), description);
    }
    return schema;
}

Members properties_of(const std::vector<FieldInfo>& fields, const void* defaults) {
    Members properties;
    for (const FieldInfo& field : fields) {
        properties.push_back(schema_member(field.name, schema_of_field(field, defaults)));
    }
    return properties;
}

JsonValue schema_of_fields(const std::vector<FieldInfo>& fields, const void* defaults) {
    return closed_object(properties_of(fields, defaults));
}

template <typename T>
Members properties_of() {
    return properties_of(component_info<T>().fields, component_info<T>().defaults);
}

/// {"make": kind, parameters ..., `more`} for every kind of a list.
template <typename Kinds>
std::vector<JsonValue> schemas_of_kinds(const Kinds& kinds, const Members& more = {}) {
    std::vector<JsonValue> schemas;
    for (const auto& kind : kinds) {
        Members properties = {schema_member("make", constant(kind.name))};
        for (JsonMember& field :
             properties_of(kind.parameters->fields, kind.parameters->defaults)) {
            properties.push_back(std::move(field));
        }
        properties.insert(properties.end(), more.begin(), more.end());
        JsonValue schema = closed_object(std::move(properties), {schema_text("make")});
        schema.members.push_back(schema_member("description", schema_text(kind.doc)));
        schemas.push_back(std::move(schema));
    }
    return schemas;
}

JsonValue schema_of_images() {
    const JsonMember compress = schema_member(
        "compress",
        described(
            of_type("boolean"),
            "stored in blocks: BC5 for the tangent-space normals of a material, BC7 for all else",
            json_of(false)));
    std::vector<JsonValue> schemas = schemas_of_kinds(pattern_kinds(), {compress});
    schemas.push_back(closed_object(
        {schema_member(
             "file",
             described(of_type("string"), "a PNG, JPEG, EXR, HDR, DDS ... beside the level")),
         schema_member(
             "srgb", described(
                         of_type("boolean"), "true for colors; false for normals and masks",
                         json_of(true))),
         compress},
        {schema_text("file")}));
    return map_of(any_of(std::move(schemas)));
}

JsonValue schema_of_materials() {
    Members properties = {
        schema_member("like", described(of_type("string"), "an earlier material, to start from")),
        schema_member(
            "pattern",
            described(of_type("string"), "a generated image: base color, normals, roughness")),
        schema_member(
            "brdf",
            described(
                of_type("string"), "a file of fitted reflectance beside the level: lafortune")),
        schema_member(
            "tiling",
            described(array_of(of_type("number"), 2, 2), "repetitions of all maps along u and v"))};
    for (JsonMember& field : properties_of<Material>()) {
        properties.push_back(std::move(field));
    }
    return map_of(closed_object(std::move(properties)));
}

JsonValue schema_of_repeat() {
    Members properties = properties_of<RepeatGrid>();
    JsonValue variation = closed_object(
        {schema_member(
             "by", described(
                       one_of_words({"random", "x", "y", "z", "radius", "angle", "index"}),
                       "property of the copy that chooses the value", schema_text("random"))),
         schema_member(
             "from", described(json_object(), "value of the first copy, or smallest value")),
         schema_member("to", described(json_object(), "value of the last copy, or largest value")),
         schema_member(
             "pick", described(
                         of_type("array", {schema_member("minItems", count(1))}),
                         "one of these values for each copy, instead of from and to")),
         schema_member(
             "noise",
             described(
                 of_type(
                     "number",
                     {schema_member("minimum", number(0)), schema_member("maximum", number(1))}),
                 "width of a random offset of the parameter between from and to", number(0))),
         schema_member(
             "times", described(
                          of_type("number", {schema_member("exclusiveMinimum", number(0))}),
                          "repetitions of the whole range", number(1)))});
    properties.push_back(schema_member(
        "vary", described(
                    map_of(std::move(variation)),
                    "fields that vary from copy to copy, by component.field: \"sway.phase\"")));
    return described(
        closed_object(std::move(properties)), "copies of the node in a grid or a ring");
}

/// The components of an entity, each at most once; `more` are further properties.
JsonValue schema_of_components(Members more, bool may_be_null) {
    for (const ComponentInfo* const info : all_components()) {
        if (info->name == "name" || info->name == "parent" || is_internal(*info)) {
            continue;  // the keys "name" and "children" cover the first two
        }
        JsonValue schema = reference(info->name);
        more.push_back(schema_member(
            info->name,
            may_be_null ? any_of({std::move(schema), of_type("null")}) : std::move(schema)));
    }
    return closed_object(std::move(more));
}

JsonValue schema_of_node() {
    return schema_of_components(
        {schema_member(
             "name",
             described(
                 of_type("string", {schema_member("pattern", schema_text("^[^.]+$"))}),
                 "by which events, targets and --set refer to it; without dots, unique among "
                 "siblings")),
         schema_member(
             "prefab", described(
                           of_type("string"),
                           "a node of \"prefabs\" to start from; other fields override its own")),
         schema_member(
             "gltf", described(
                         of_type("string"),
                         "a .gltf or .glb file beside the level, whose roots become children")),
         schema_member(
             "variant",
             described(of_type("string"), "of the materials of \"gltf\"; default: its own")),
         schema_member(
             "nodes",
             described(
                 map_of(reference("components")), "changes of the nodes of \"gltf\", or of "
                                                  "children, by name; null removes a component")),
         schema_member(
             "repeat", described(
                           any_of({reference("repeat of a node"), of_type("null")}),
                           "copies of it in a grid or a ring")),
         schema_member(
             "children",
             described(array_of(reference("node")), "child nodes, in its local space"))},
        true);
}

JsonValue schema_of_resources() {
    Members properties;
    for (const ComponentInfo* const info : all_resources()) {
        if (is_internal(*info)) {
            continue;
        }
        properties.push_back(schema_member(info->name, reference(info->name)));
    }
    return closed_object(std::move(properties));
}

JsonValue schema_of_event() {
    const auto time = [](std::string_view words) { return described(schema_of_time(1e6), words); };
    return closed_object(
        {schema_member("at", time("since the start of the level [s]")),
         schema_member(
             "key", described(
                        one_of_words(key_names()),
                        "happens when this key is pressed, instead of at a time")),
         schema_member(
             "released", described(one_of_words(key_names()), "happens when this key is released")),
         schema_member(
             "text",
             described(of_type("string"), "what the key does, shown in the help of the window")),
         schema_member(
             "every", time("period of repetition [s]; without it, the event happens once")),
         schema_member(
             "times", described(
                          of_type("integer", {schema_member("minimum", number(1))}),
                          "number of repetitions of \"every\"; without it, unlimited")),
         schema_member(
             "set", described(
                        map_of(reference("components")),
                        "new values of fields, by entity, component and field; null removes a "
                        "component")),
         schema_member(
             "set_resources",
             described(schema_of_resources(), "new values of fields, by resource and field")),
         schema_member(
             "impulse", described(
                            map_of(map_of(of_type("object"))),
                            "amounts added to fields, by entity, component and field")),
         schema_member(
             "impulse_resources",
             described(
                 map_of(of_type("object")), "amounts added to fields, by resource and field")),
         schema_member(
             "spawn", described(
                          array_of(reference("node")),
                          "new nodes, from prefabs or with the level's meshes")),
         schema_member(
             "destroy",
             described(
                 array_of(of_type("string")), "entities to remove, with their children, by name"))},
        {});
}

JsonValue schema_of_show() {
    return closed_object(
        {schema_member("technique", described(of_type("string"), "its id, for --show")),
         schema_member("text", described(of_type("string"), "a sentence: what to look at")),
         schema_member("set", described(of_type("object"), "JSON merge patch of the level, on")),
         schema_member(
             "off", described(of_type("object"), "JSON merge patch of the level, without it")),
         schema_member("time", described(schema_of_time(3600), "when it shows best [s]")),
         schema_member(
             "camera", described(
                           any_of({of_type("string"), closed_object(properties_of<ShowCamera>())}),
                           "a camera by name, or a camera position")),
         schema_member(
             "equal",
             described(of_type("boolean"), "on and off must look the same", json_of(false)))},
        {schema_text("technique"), schema_text("text")});
}

JsonValue definitions() {
    Members all = {
        schema_member("node", schema_of_node()),
        schema_member("repeat of a node", schema_of_repeat()),
        schema_member("components", schema_of_components({}, true)),
        schema_member("event", schema_of_event()),
        schema_member(
            kColorName, described(one_of_words(color_names()), "a color of CSS, in sRGB"))};
    for (const std::vector<const ComponentInfo*>& infos : {all_components(), all_resources()}) {
        for (const ComponentInfo* const info : infos) {
            all.push_back(
                schema_member(info->name, schema_of_fields(info->fields, info->defaults)));
        }
    }
    return json_object(std::move(all));
}

}  // namespace

JsonValue level_schema() {
    JsonValue schema = closed_object(
        {schema_member(
             "$schema", described(of_type("string"), "for editors: the path of this schema")),
         schema_member(
             "title", described(of_type("string"), "shown in the window and by limn levels")),
         schema_member(
             "description", described(of_type("string"), "a few sentences about the level")),
         schema_member(
             "resources",
             described(
                 schema_of_resources(), "of which there is one each: sky, exposure, weather")),
         schema_member(
             "include",
             described(
                 array_of(of_type("string")), "files whose prefabs, images, materials and meshes "
                                              "can be used, such as fire.effect.json")),
         schema_member(
             "images", described(schema_of_images(), "files and generated patterns, by name")),
         schema_member("materials", described(schema_of_materials(), "by name, in order of use")),
         schema_member(
             "paths", described(
                          map_of(closed_object(properties_of<PathShape>())),
                          "curves for path_follower, racer and sweeps, by name")),
         schema_member(
             "meshes",
             described(
                 map_of(any_of(schemas_of_kinds(mesh_kinds()))), "generated shapes, by name")),
         schema_member(
             "motion_graphs", described(
                                  map_of(closed_object(properties_of<MotionGraphData>())),
                                  "states, clips and transitions of characters, by name")),
         schema_member(
             "prefabs",
             described(map_of(reference("node")), "nodes to instantiate many times, by name")),
         schema_member("entities", described(array_of(reference("node")), "initial entities")),
         schema_member(
             "events", described(array_of(reference("event")), "timed or triggered changes")),
         schema_member(
             "shows",
             described(array_of(schema_of_show()), "techniques that the level shows, on and off")),
         schema_member(
             "bindings",
             described(
                 map_of(array_of(one_of_words(key_names()))), "keys of actions, by action"))});
    schema.members.insert(
        schema.members.begin(),
        {schema_member("$schema", schema_text("https://json-schema.org/draft/2020-12/schema")),
         schema_member("title", schema_text("A level of Limn"))});
    schema.members.push_back(schema_member("$defs", definitions()));
    return schema;
}

}  // namespace limn
