#include "content/load/level/level_list.h"

#include "content/load/files/json_document.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <filesystem>

namespace limn {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kEnding = ".level.json";
constexpr JsonLimits kTitleLimits = {.max_bytes = std::size_t{16} << 20};

std::string title_of(const std::string& path) {
    const Result<JsonValue> json = load_json(path, kTitleLimits);
    if (!json) {
        return json.error().message;
    }
    const JsonValue* const title = json->find("title");
    return title != nullptr && title->kind == JsonKind::String ? title->text : "";
}

/// Name and path of the levels, sorted by name.
std::vector<LevelEntry> find_levels() {
    std::vector<LevelEntry> levels;
    for (const std::string& folder : level_folders()) {
        std::error_code error;
        for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
             entry.increment(error)) {
            const std::string file = entry->path().filename().string();
            if (!file.ends_with(kEnding) || file.size() == kEnding.size()) {
                continue;
            }
            std::string name = file.substr(0, file.size() - kEnding.size());
            const bool is_new = std::none_of(
                levels.begin(), levels.end(), [&](const LevelEntry& l) { return l.name == name; });
            if (is_new) {
                levels.push_back({std::move(name), entry->path().string(), ""});
            }
        }
    }
    std::sort(levels.begin(), levels.end(), [](const LevelEntry& a, const LevelEntry& b) {
        return a.name < b.name;
    });
    return levels;
}

}  // namespace

std::vector<std::string> level_folders() {
    std::vector<std::string> folders;
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
    for (const fs::path& folder :
         {program / "levels", (program / "../../content/levels").lexically_normal(),
          fs::path(LIMN_LEVELS_DIR)}) {
        const bool is_new = std::find(folders.begin(), folders.end(), folder) == folders.end();
        if (is_new && fs::is_directory(folder, error)) {
            folders.push_back(folder.string());
        }
    }
    return folders;
}

std::vector<LevelEntry> list_levels() {
    std::vector<LevelEntry> levels = find_levels();
    for (LevelEntry& level : levels) {
        level.title = title_of(level.path);
    }
    return levels;
}

Result<std::string> find_level(std::string_view name) {
    const std::vector<LevelEntry> levels = find_levels();
    if (levels.empty()) {
        return fail(
            "{}: found no folder with levels, expected {} (as it was when the program was built)",
            name, LIMN_LEVELS_DIR);
    }
    std::vector<std::string_view> names;
    for (const LevelEntry& level : levels) {
        if (level.name == name) {
            return level.path;
        }
        names.emplace_back(level.name);
    }
    const std::string file = std::string(name) + ".level.json";
    std::error_code error;
    return fail(
        "{}: found no level of that name, expected one of `limn levels`{}", name,
        fs::exists(file, error) ? format_text(" (did you mean {}?)", file)
                                : did_you_mean(name, names));
}

}  // namespace limn
