#pragma once

#include "ecs/base/result.h"

#include <string>
#include <string_view>
#include <vector>

namespace limn {

// Levels are files NAME.level.json in the folders of level_folders; a name is enough to ask for
// one.

struct LevelEntry {
    std::string name;   ///< "gallery"
    std::string path;   ///< of the file
    std::string title;  ///< one line for people; what is wrong with the file when it cannot be read
};

/// Where levels are looked for, in this order: `levels` beside the program, the folder of the
/// source tree that the program was built from. Folders that are not there are left out.
[[nodiscard]] std::vector<std::string> level_folders();

/// Every level, in the order of the names; of two with one name the first folder's.
[[nodiscard]] std::vector<LevelEntry> list_levels();

/// The file of the level `name`; the error names the nearest one.
[[nodiscard]] Result<std::string> find_level(std::string_view name);

}  // namespace limn
