#pragma once

#include "content/load/level/level_update.h"
#include "ecs/any_component.h"
#include "ecs/entity.h"
#include "ecs/prefab.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace limn {

class World;

// Undo and redo of the inspector's edits. An edit holds one component of one entity (or a resource,
// or a material of Assets) before and after; these are small, so whole values are kept. Dragging a
// slider is one edit, however many frames it takes. An edit may also make or delete entities with
// all their components: those deleted stay as empty entities, so that references to them hold again
// when they come back.

/// Entities that an edit made or deleted.
struct EditedTree {
    Prefab components;             ///< of each, without the root's Parent
    std::vector<Entity> entities;  ///< the root first
    bool made = false;             ///< otherwise deleted
};

struct Edit {
    LevelPart part = LevelPart::Component;
    Entity entity;                                     ///< of a Component
    std::uint32_t material = 0;                        ///< index into Assets
    AnyComponent before;                               ///< empty: the entity did not have it
    AnyComponent after;                                ///< empty: it was removed
    std::string label;                                 ///< "lamp: point_light.intensity"
    std::shared_ptr<const EditedTree> tree = nullptr;  ///< then nothing of the above but the label
    bool joined = false;  ///< undone and redone together with the edit before it
};

class UndoStack {
  public:
    /// Records an edit already applied. Clears the redo history.
    void record(Edit edit);
    /// Records an edit already applied, of what the last edit changed: that one's final value is
    /// now this one's. If the last edit changed something else, as record().
    void extend(Edit edit);

    /// Undoes the last edit and returns its label, or "" if there is none. Edits of destroyed
    /// entities are dropped and skipped.
    std::string undo(World& world);
    /// Redoes the next edit, likewise.
    std::string redo(World& world);

    [[nodiscard]] std::size_t undo_count() const { return done_; }
    /// Those that can be undone, oldest first.
    [[nodiscard]] std::span<const Edit> done() const { return {edits_.data(), done_}; }
    [[nodiscard]] std::size_t redo_count() const { return edits_.size() - done_; }
    /// Changes whenever the world may have been edited.
    [[nodiscard]] std::uint64_t revision() const { return revision_; }
    void clear();
    /// After the level's files have changed: rebases the edits on the new values. Drops edits
    /// without effect, such as those whose values were saved to the files.
    void adopt(std::span<const LevelChange> changes);

  private:
    /// Undoes the last edit, or redoes the next one; false if it has been dropped instead.
    bool step(World& world, bool redo);

    std::vector<Edit> edits_;  // the first done_ are done, the others undone
    std::size_t done_ = 0;
    std::uint64_t revision_ = 0;
};

/// Sets the edit's target to the value, or removes the component if the value is empty. Returns
/// false if the target no longer exists.
bool apply_edit_value(World& world, const Edit& edit, const AnyComponent& value);

/// Alive, and not deleted: a deleted entity has no components.
[[nodiscard]] bool exists(const World& world, Entity entity);

/// Removes all components of the living entities, which stay.
void strip(World& world, std::span<const Entity> entities);

/// Sets the target of `edit` to `after` and records that as `what`. Extends the last edit instead
/// if `last`, the name of the edit of a widget or a handle that is still held, is the same.
void record_edit(
    World& world, UndoStack& undo, Edit edit, AnyComponent after, const std::string& what,
    std::string& last);

}  // namespace limn
