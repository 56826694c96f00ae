#pragma once

#include "ecs/base/result.h"
#include "ecs/entity.h"
#include "systems/subtrees.h"

#include <string>

namespace limn {

class UndoStack;
class World;
struct Prefab;

// Cut, copy, paste and delete of entities with their descendants, as commands with undo
// (engine.cut-copy-paste): what the inspector's buttons and keys do.

/// What was cut or copied last.
struct SubtreeClipboard {
    Entity root;
    bool is_cut = false;  ///< the next paste moves it; otherwise each paste makes a copy
};

/// Each returns what it did, "lamp: cut", and records that as one edit. Fails, and changes nothing,
/// if an entity is destroyed.
class SubtreeEditor {
  public:
    /// Makes the entity a root, which stays where it is; the next paste moves it.
    [[nodiscard]] Result<std::string> cut(World& world, UndoStack& undo, Entity entity);
    /// Remembers the entity: each paste copies it as it is then.
    [[nodiscard]] Result<std::string> copy(const World& world, Entity entity);
    /// Below `parent`, or as a root if that is null. What was cut keeps what `kept` says; what was
    /// copied keeps its Transform.
    [[nodiscard]] Result<std::string>
    paste(World& world, UndoStack& undo, Entity parent, KeptPlace kept = KeptPlace::World);
    /// Copies the entity beside itself, below the same parent.
    [[nodiscard]] Result<std::string> duplicate(World& world, UndoStack& undo, Entity entity);
    /// An instance of a prefab (read_instance), as a root.
    [[nodiscard]] Result<std::string> place(World& world, UndoStack& undo, const Prefab& prefab);
    /// Takes all components of the entity and its descendants: they are gone until undo.
    [[nodiscard]] Result<std::string> remove(World& world, UndoStack& undo, Entity entity);

    /// What the last paste, place or duplicate made or moved.
    [[nodiscard]] Entity pasted() const { return pasted_; }
    void reset() { *this = {}; }

  private:
    SubtreeClipboard clipboard_;
    Entity pasted_;
};

}  // namespace limn
