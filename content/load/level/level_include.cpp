#include "content/load/level/level_include.h"

#include "content/load/level/component_json.h"
#include "content/load/level/level_list.h"
#include "ecs/base/text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <utility>

namespace limn {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSections[] = {"images", "materials",     "paths",
                                          "meshes", "motion_graphs", "prefabs"};
constexpr std::string_view kTexts[] = {"title", "description", "$schema"};  // not used
constexpr std::size_t kMaxFiles = 64;

std::vector<fs::path> search_folders(const std::string& level_path) {
    std::vector<fs::path> folders = {fs::path(level_path).parent_path()};
    for (const std::string& levels : level_folders()) {
        folders.push_back(fs::path(levels).parent_path() / "effects");
    }
    return folders;
}

Result<std::string> find_file(const JsonValue& name, const JsonLocation& location) {
    LIMN_TRY(expect(name, JsonKind::String, location, "the name of a file"));
    std::vector<std::string> known;
    const std::vector<fs::path> folders = search_folders(std::string(location.file));
    for (const fs::path& folder : folders) {
        std::error_code error;
        const fs::path path = folder / name.text;
        if (fs::is_regular_file(path, error)) {
            return path.string();
        }
        for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
             entry.increment(error)) {
            std::string file = entry->path().filename().string();
            if (file.ends_with(".effect.json")) {
                known.push_back(std::move(file));
            }
        }
    }
    std::sort(known.begin(), known.end());
    const std::vector<std::string_view> names(known.begin(), known.end());
    return error_at(
        location, name.at, "no file " + in_quotes(name.text),
        "a file beside the level"
            + (known.empty() ? "" : fmt::format(" or one of {}", fmt::join(known, " ")))
            + did_you_mean(name.text, names));
}

void set_source(JsonValue& json, const std::string* file) {
    json.at.file = file;
    for (JsonValue& item : json.items) {
        set_source(item, file);
    }
    for (JsonMember& member : json.members) {
        member.at.file = file;
        set_source(member.value, file);
    }
}

/// The section of `level`, added if missing.
JsonValue& section_of(JsonValue& level, std::string_view name) {
    for (JsonMember& member : level.members) {
        if (member.key == name) {
            return member.value;
        }
    }
    JsonValue empty;
    empty.kind = JsonKind::Object;
    level.members.push_back({std::string(name), {}, std::move(empty)});
    return level.members.back().value;
}

/// Inserts `members` before those of `section`; existing keys take precedence.
void add_before(JsonValue& section, std::vector<JsonMember> members) {
    std::erase_if(
        members, [&](const JsonMember& member) { return section.find(member.key) != nullptr; });
    section.members.insert(
        section.members.begin(), std::make_move_iterator(members.begin()),
        std::make_move_iterator(members.end()));
}

}  // namespace

Result<SourceFiles>
include_files(JsonValue& level, const std::string& path, const JsonLimits& limits) {
    SourceFiles files;
    const JsonValue* const names = level.find("include");
    if (names == nullptr || level.kind != JsonKind::Object) {
        return files;
    }
    const JsonLocation location = {path, "include"};
    LIMN_TRY(expect(*names, JsonKind::Array, location, "an array of names of files"));
    if (names->items.size() > kMaxFiles) {
        return error_at(
            location, names->at, fmt::format("{} files", names->items.size()),
            fmt::format("at most {}", kMaxFiles));
    }
    const std::vector<JsonValue> items = names->items;
    for (auto name = items.rbegin(); name != items.rend(); ++name) {
        const std::string file = LIMN_TRY(find_file(*name, location));
        JsonValue library = LIMN_TRY(load_json(file, limits));
        files.push_back(std::make_shared<const std::string>(file));
        set_source(library, files.back().get());
        LIMN_TRY(expect(library, JsonKind::Object, {file, ""}, "an object"));
        for (JsonMember& member : library.members) {
            if (std::find(std::begin(kTexts), std::end(kTexts), member.key) != std::end(kTexts)) {
                continue;
            }
            if (std::find(std::begin(kSections), std::end(kSections), member.key)
                == std::end(kSections)) {
                return error_at(
                    {file, ""}, member.at, "the key " + in_quotes(member.key),
                    fmt::format("one of {} in an included file", fmt::join(kSections, " ")));
            }
            LIMN_TRY(expect(member.value, JsonKind::Object, {file, member.key}, "an object"));
            JsonValue& section = section_of(level, member.key);
            if (section.kind == JsonKind::Object) {  // else the level's section is invalid, which
                                                     // is reported later
                add_before(section, std::move(member.value.members));
            }
        }
    }
    return files;
}

}  // namespace limn
