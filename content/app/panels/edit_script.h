#pragma once

#include "content/app/panels/subtree_edits.h"
#include "content/app/panels/undo.h"
#include "content/load/level/level_place.h"
#include "ecs/base/result.h"

#include <string>
#include <string_view>
#include <utility>

namespace limn {

class World;

/// The inspector's edits as text, without a window (engine.editor-inspector): `limn edit`. Names
/// are those of entities; one that several have is an error, except for set.
///
///     set lamp.point_light.intensity = 20  as --set (set_value.h), for all entities of the name
///     add lamp.spin                        a component, with defaults
///     remove lamp.spin
///     cut lamp                             makes it a root, which the next paste moves
///     copy lamp
///     paste post                           below it; without a name as a root
///     place lantern                        an instance of a prefab of the level, at the origin
///     duplicate lamp                       a copy beside it
///     delete lamp                          with its children
///     undo, redo                           the last edit
///
/// Blank lines and those that begin with # do nothing.
class EditScript {
  public:
    EditScript() = default;
    /// With the level, whose prefabs can be placed.
    explicit EditScript(PlacedLevel level) : level_(std::move(level)) {}

    /// Runs one line. Returns what it did, "lamp: point_light.intensity", or fails and changes
    /// nothing.
    [[nodiscard]] Result<std::string> run(World& world, std::string_view line);
    [[nodiscard]] const UndoStack& undo_stack() const { return undo_; }

  private:
    PlacedLevel level_;
    UndoStack undo_;
    SubtreeEditor subtrees_;
};

}  // namespace limn
