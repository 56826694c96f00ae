#pragma once

#include "content/app/panels/undo.h"
#include "ecs/base/result.h"
#include "ecs/entity.h"

#include <span>
#include <string>
#include <vector>

namespace limn {

class World;

// Edits saved as a level (engine.editor-inspector): `limn edit -o`, and Ctrl S of `limn play`.

/// A level's file with edits, ready to be written.
struct EditedLevel {
    std::string text;                   ///< without the comments of the file
    std::vector<std::string> left_out;  ///< "edits of children of copies: ...", for warnings
};

/// The level of the file `path`, with the edits of the world that was loaded from it, as the text
/// of the file `out`. `spawned`: its entities in the level's order (LevelFields), by which they
/// are found in the file. Fails if the file cannot be read, if what it would be is no level, or if
/// it refers to files and `out` is in another folder.
[[nodiscard]] Result<EditedLevel> edited_level(
    const std::string& path, const std::string& out, World& world, std::span<const Edit> edits,
    std::span<const Entity> spawned);

/// A file that does not exist yet: "museum-edited.level.json" beside "museum.level.json", or else
/// "museum-edited-2.level.json" ...
[[nodiscard]] std::string new_edited_path(const std::string& path);

}  // namespace limn
