#include "content/app/commands/list_commands.h"

#include "content/app/player/level_keys.h"
#include "content/game/game.h"
#include "content/load/level/level_hints.h"
#include "content/load/level/level_list.h"
#include "content/load/level/level_schema.h"
#include "content/make/make_mesh.h"
#include "content/make/patterns/patterns.h"
#include "ecs/any_component.h"
#include "ecs/base/text.h"
#include "ecs/components/motion_graph.h"
#include "ecs/components/path.h"
#include "ecs/components/surface.h"
#include "ecs/field_access.h"
#include "ecs/reflect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

namespace limn {
namespace {

constexpr std::string_view kRadians = "rad";

/// One line of `limn components`.
struct FieldLine {
    std::string path;
    std::string type;
    std::string value;
    std::string range;
    std::string doc;
};

double to_degrees(double radians) {
    return std::stod(fmt::format("{:.4g}", radians * 180.0 / std::numbers::pi));
}

/// "0 .. 10 m", or only the unit if there are no limits; angles in degrees.
std::string range_or_unit(FieldMeta meta) {
    if (meta.unit == kRadians) {
        meta.unit = "deg";
        meta.min = std::isfinite(meta.min) ? to_degrees(meta.min) : meta.min;
        meta.max = std::isfinite(meta.max) ? to_degrees(meta.max) : meta.max;
    }
    const std::string range = range_text(meta);
    return range.empty() ? meta.unit : range;
}

/// As in a level: angles in degrees, rotations as [yaw, pitch, roll].
std::string written_value(const FieldInfo& field, const void* element) {
    if (field.type == FieldType::Quat && *static_cast<const Quat*>(element) == Quat(1, 0, 0, 0)) {
        return "[0, 0, 0]";
    }
    if (field.meta.unit != kRadians) {
        return value_text(field, element);
    }
    std::vector<std::string> angles;
    for (int lane = 0; lane < number_count(field.type); ++lane) {
        const double angle = to_degrees(get_number(field, element, lane));
        angles.push_back(angle == 0 ? "0" : fmt::format("\"{}deg\"", angle));
    }
    return angles.size() == 1 ? angles[0] : fmt::format("[{}]", fmt::join(angles, ", "));
}

std::string written_type(const FieldInfo& field) {
    if (field.shape != FieldShape::One) {
        return type_text(field);
    }
    const int numbers = number_count(field.type);
    if (field.meta.unit == kRadians) {
        return numbers == 1 ? "angle, as \"45deg\"" : fmt::format("{} angles", numbers);
    }
    return field.type == FieldType::Quat ? "[yaw, pitch, roll] in degrees"
           : field.meta.color            ? "color"
                                         : type_text(field);
}

/// Adds the fields of `object`, those of structs in it with their path: "keys[].time". Lists of
/// structs get an element with its defaults.
void add_lines(
    const std::vector<FieldInfo>& fields, void* object, const std::string& prefix,
    std::vector<FieldLine>& lines) {
    for (const FieldInfo& field : fields) {
        void* const data = field_ptr(object, field);
        const bool is_struct = field.type == FieldType::Struct;
        const bool is_one = field.shape == FieldShape::One;
        const std::string path = prefix + field.name;
        if (!is_struct || !is_one) {
            lines.push_back(
                {.path = path,
                 .type = written_type(field),
                 .value = is_one ? written_value(field, data) : "[]",
                 .range = range_or_unit(field.meta),
                 .doc = field.meta.doc});
        }
        if (is_struct) {
            if (field.shape == FieldShape::List) {
                field.list.resize(data, 1);
            }
            add_lines(
                field.fields, element_ptr(field, data, 0), path + (is_one ? "." : "[]."), lines);
        }
    }
}

/// What can be listed by one name.
struct ListedType {
    std::string_view name;
    const ComponentInfo* info = nullptr;
    std::string_view doc = "";
};

struct ListedTypes {
    std::string_view heading;
    std::vector<ListedType> types;
    bool is_internal = false;
};

void print_type(const ListedType& listed) {
    const ComponentInfo& info = *listed.info;
    fmt::print(
        "{}{}{}{}\n", listed.name, info.is_tag ? "  (tag)" : "", listed.doc.empty() ? "" : "  ",
        listed.doc);
    std::vector<FieldLine> lines;
    if (info.defaults != nullptr) {
        AnyComponent defaults(info, info.defaults);
        add_lines(info.fields, defaults.data(), "", lines);
    }
    std::size_t path = 0;
    std::size_t type = 0;
    std::size_t value = 0;
    std::size_t range = 0;
    for (const FieldLine& line : lines) {
        path = std::max(path, line.path.size());
        type = std::max(type, line.type.size());
        value = std::max(value, line.value.size());
        range = std::max(range, line.range.size());
    }
    for (const FieldLine& line : lines) {
        fmt::print(
            "    {:<{}}  {:<{}}  = {:<{}}  {:<{}}  {}\n", line.path, path, line.type, type,
            line.value, value, line.range, range, line.doc);
    }
    fmt::print("\n");
}

void print_keys(const LevelKeys& listed) {
    fmt::print("{}\n", listed.name);
    std::size_t path = 0;
    std::size_t type = 0;
    for (const LevelKey& key : listed.keys) {
        path = std::max(path, key.path.size());
        type = std::max(type, key.type.size());
    }
    for (const LevelKey& key : listed.keys) {
        fmt::print("    {:<{}}  {:<{}}  {}\n", key.path, path, key.type, type, key.doc);
    }
    fmt::print("\n");
}

void print_types(const ListedTypes& listed) {
    fmt::print("==== {}\n\n", listed.heading);
    for (const ListedType& type : listed.types) {
        print_type(type);
    }
}

void print_all_keys(const std::vector<LevelKeys>& all) {
    fmt::print("==== Further keys of a level\n\n");
    for (const LevelKeys& listed : all) {
        print_keys(listed);
    }
}

/// Everything that a level can name, grouped by the section of the level.
std::vector<ListedTypes> list_types() {
    const auto chosen = [](const std::vector<const ComponentInfo*>& infos, bool internal) {
        std::vector<ListedType> types;
        for (const ComponentInfo* const info : infos) {
            if (is_internal(*info) == internal) {
                types.push_back({info->name, info});
            }
        }
        return types;
    };
    const auto kinds = [](const auto& all) {
        std::vector<ListedType> types;
        for (const auto& kind : all) {
            types.push_back({kind.name, kind.parameters, kind.doc});
        }
        return types;
    };
    return {
        {"Components: of an entity", chosen(all_components(), false)},
        {"Resources: one of a kind, under \"resources\"", chosen(all_resources(), false)},
        {"Under \"materials\", \"paths\" and \"motion_graphs\"",
         {{"material", &component_info<Material>()},
          {"path", &component_info<PathShape>()},
          {"motion_graph", &component_info<MotionGraphData>()}}},
        {"Under \"meshes\": {\"make\": NAME}", kinds(mesh_kinds())},
        {"Under \"images\": {\"make\": NAME}", kinds(pattern_kinds())},
        {"Internal components: written by systems", chosen(all_components(), true), true},
        {"Internal resources", chosen(all_resources(), true), true}};
}

/// One component, resource, material or maker, with its section.
Status print_named(const std::string& name) {
    bool is_known = false;
    std::vector<std::string_view> names;
    for (ListedTypes& listed : list_types()) {
        for (const ListedType& type : listed.types) {
            names.push_back(type.name);
        }
        std::erase_if(listed.types, [&](const ListedType& type) { return type.name != name; });
        if (!listed.types.empty()) {
            print_types(listed);
            is_known = true;
        }
    }
    const std::vector<LevelKeys> keys = list_level_keys();
    for (const LevelKeys& listed : keys) {
        names.push_back(listed.name);
    }
    const auto same = std::find_if(
        keys.begin(), keys.end(), [&](const LevelKeys& listed) { return listed.name == name; });
    if (same != keys.end()) {
        print_all_keys({*same});
        is_known = true;
    }
    return is_known ? Status(Done{})
                    : fail(
                        "found {}, expected a name that `limn components` lists{}", in_quotes(name),
                        did_you_mean(name, names));
}

}  // namespace

Status run_levels() {
    const std::vector<LevelEntry> levels = list_levels();
    if (levels.empty()) {
        return find_level("levels").error();
    }
    std::size_t width = 0;
    for (const LevelEntry& level : levels) {
        width = std::max(width, level.name.size());
    }
    for (const LevelEntry& level : levels) {
        fmt::print("{:<{}}  {}\n", level.name, width, level.title);
    }
    return Done{};
}

Status run_components(const std::string& name, bool schema, bool all) {
    register_game_components();
    if (schema) {
        fmt::print("{}\n", write_json(level_schema()));
        return Done{};
    }
    if (!name.empty()) {
        return print_named(name);
    }
    for (const ListedTypes& listed : list_types()) {
        if (all || !listed.is_internal) {
            print_types(listed);
        }
    }
    print_all_keys(list_level_keys());
    return Done{};
}

}  // namespace limn
