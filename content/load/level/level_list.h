#pragma once

#include "ecs/base/result.h"

#include <string>
#include <string_view>
#include <vector>

namespace limn {

// Levels are files NAME.level.json in the folders of level_folders, found by name.

struct LevelEntry {
    std::string name;   ///< "gallery"
    std::string path;   ///< of the file
    std::string title;  ///< one line; the error when the file cannot be read
};

/// Search folders, in order: `levels` next to the program, that of the source tree in whose
/// build/PRESET the program is, also if it was moved, and that of the source tree that the program
/// was built from. Missing folders are omitted.
[[nodiscard]] std::vector<std::string> level_folders();

/// All levels, sorted by name; of equal names the one in the first folder.
[[nodiscard]] std::vector<LevelEntry> list_levels();

/// The file of the level `name`; the error suggests the most similar name.
[[nodiscard]] Result<std::string> find_level(std::string_view name);

}  // namespace limn
