#pragma once

#include "content/app/panels/subtree_edits.h"
#include "content/app/panels/undo.h"
#include "ecs/base/result.h"

#include <string>
#include <string_view>

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
///     duplicate lamp                       a copy beside it
///     delete lamp                          with its children
///     undo, redo                           the last edit
///
/// Blank lines and those that begin with # do nothing.
class EditScript {
  public:
    /// Runs one line. Returns what it did, "lamp: point_light.intensity", or fails and changes
    /// nothing.
    [[nodiscard]] Result<std::string> run(World& world, std::string_view line);
    [[nodiscard]] const UndoStack& undo_stack() const { return undo_; }

  private:
    UndoStack undo_;
    SubtreeEditor subtrees_;
};

}  // namespace limn
