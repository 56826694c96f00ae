#pragma once

#include "ecs/any_component.h"
#include "ecs/entity.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace limn {

class World;

// What the inspector changed, so that it can be taken back. An edit holds one component of one
// entity (or a resource, or a material of Assets) before and after; these are small, so whole
// values are kept, and a drag of a slider is one edit however many frames it took.

enum class EditKind : std::uint8_t { Component, Resource, Material };

struct Edit {
    EditKind kind = EditKind::Component;
    Entity entity;               ///< of a Component
    std::uint32_t material = 0;  ///< index into Assets
    AnyComponent before;         ///< empty: the entity did not have it
    AnyComponent after;          ///< empty: it was removed
    std::string label;           ///< "lamp: point_light.intensity"
};

class UndoStack {
  public:
    static constexpr std::size_t kMostEdits = 1000;  ///< the oldest are forgotten

    /// Adds an edit that has been made. What was undone cannot be redone any more.
    void record(Edit edit);
    /// The edit recorded last goes on: it now ends at `after`.
    void extend(AnyComponent after);

    /// Takes the last edit back; its label, or "" if there is none. Edits of entities that are gone
    /// are dropped, and the one before them taken.
    std::string undo(World& world);
    /// Makes it again.
    std::string redo(World& world);

    [[nodiscard]] std::size_t undo_count() const { return done_; }
    [[nodiscard]] std::size_t redo_count() const { return edits_.size() - done_; }
    void clear();

  private:
    std::vector<Edit> edits_;  // the first done_ are done, the others undone
    std::size_t done_ = 0;
};

/// Gives the edit's target the value, or takes the component away if it is empty. False: the target
/// is gone.
bool apply_edit_value(World& world, const Edit& edit, const AnyComponent& value);

}  // namespace limn
