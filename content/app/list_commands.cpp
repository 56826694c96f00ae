#include "content/app/list_commands.h"

#include "content/game/game.h"
#include "content/load/level_hints.h"
#include "content/load/level_list.h"
#include "content/load/level_schema.h"
#include "content/load/level_show.h"
#include "ecs/field_access.h"
#include "ecs/reflect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace limn {
namespace {

/// One line of `limn components`.
struct FieldLine {
    std::string path;
    std::string type;
    std::string value;
    std::string range;
    std::string doc;
};

/// "0 .. 10 m", or the unit alone where there are no limits.
std::string range_or_unit(const FieldMeta& meta) {
    const std::string range = range_text(meta);
    return range.empty() ? meta.unit : range;
}

/// Adds the fields of `object`, those of structs in it with their path.
void add_lines(
    const std::vector<FieldInfo>& fields, const void* object, const std::string& prefix,
    std::vector<FieldLine>& lines) {
    for (const FieldInfo& field : fields) {
        const void* value = static_cast<const std::byte*>(object) + field.offset;
        if (field.type == FieldType::Struct && field.shape == FieldShape::One) {
            add_lines(field.fields, value, prefix + field.name + ".", lines);
            continue;
        }
        lines.push_back(
            {.path = prefix + field.name,
             .type = type_text(field),
             .value = field.shape == FieldShape::List ? "[]" : value_text(field, value),
             .range = range_or_unit(field.meta),
             .doc = field.meta.doc});
    }
}

void print_component(const ComponentInfo& info) {
    fmt::print("{}{}\n", info.name, info.is_tag ? "  (tag)" : "");
    std::vector<FieldLine> lines;
    if (info.defaults != nullptr) {
        add_lines(info.fields, info.defaults, "", lines);
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

/// What a show changes, and the commands that render it on and off.
void print_show(const FoundShow& found) {
    const LevelShow& show = found.show;
    fmt::print("{}  {}, at {} s\n{}\n", show.technique, found.level.name, show.time, show.text);
    if (show.set.kind == JsonKind::Object) {
        fmt::print("\nset {}\n", write_json(show.set));
    }
    fmt::print(
        "\noff {}\n", show.off.kind == JsonKind::Object ? write_json(show.off)
                                                        : std::string("without what is set"));
    fmt::print(
        "\nlimn play --show {0}\nlimn render --show {0} -o on.png\n"
        "limn render --show {0} --off -o off.png\n",
        show.technique);
}

void print_components(
    const char* heading, const std::vector<const ComponentInfo*>& components, bool internal) {
    fmt::print("{}\n\n", heading);
    for (const ComponentInfo* const info : components) {
        if (is_internal(*info) == internal) {
            print_component(*info);
        }
    }
}

}  // namespace

Status run_levels() {
    const std::vector<LevelEntry> levels = list_levels();
    std::size_t width = 0;
    for (const LevelEntry& level : levels) {
        width = std::max(width, level.name.size());
    }
    for (const LevelEntry& level : levels) {
        fmt::print("{:<{}}  {}\n", level.name, width, level.title);
    }
    return Done{};
}

Status run_shows(const std::string& id) {
    if (!id.empty()) {
        print_show(LIMN_TRY(find_show(id)));
        return Done{};
    }
    const std::vector<FoundShow> shows = LIMN_TRY(list_shows());
    std::size_t technique = 0;
    std::size_t level = 0;
    for (const FoundShow& found : shows) {
        technique = std::max(technique, found.show.technique.size());
        level = std::max(level, found.level.name.size());
    }
    for (const FoundShow& found : shows) {
        fmt::print(
            "{:<{}}  {:<{}}  {}\n", found.show.technique, technique, found.level.name, level,
            found.show.text);
    }
    return Done{};
}

Status run_components(bool schema, bool all) {
    register_game_components();
    if (schema) {
        fmt::print("{}\n", write_json(level_schema()));
        return Done{};
    }
    const std::vector<const ComponentInfo*> components = all_components();
    const std::vector<const ComponentInfo*> resources = all_resources();
    print_components("==== Components: of an entity", components, false);
    print_components("==== Resources: one of a kind, under \"resources\"", resources, false);
    if (all) {
        print_components("==== Internal components: systems write them", components, true);
        print_components("==== Internal resources", resources, true);
    }
    return Done{};
}

}  // namespace limn
