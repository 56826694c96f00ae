#pragma once

#include "content/app/panels/field_widgets.h"
#include "content/app/panels/storage_panel.h"
#include "content/app/panels/subtree_edits.h"
#include "content/app/panels/undo.h"
#include "content/load/level/level_place.h"
#include "ecs/any_component.h"
#include "ecs/base/math.h"
#include "ecs/entity.h"

#include <cstdint>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

namespace limn {

class Hierarchy;
struct HudStyle;
class Schedule;
class World;

// F2: inspects and edits the world. Entities as a searchable tree, every component of the selected
// one, resources, materials and ECS storage. Nothing is written until a value really changes, so
// that inspecting bumps no change versions and causes no uploads.

class Inspector {
  public:
    /// Draws the panel; edits are applied to `world` at once and recorded on the undo stack.
    void draw(const HudStyle& style, World& world, const Schedule& schedule);

    void select(Entity entity) {
        selected_ = entity;
        reveal_ = true;
    }
    [[nodiscard]] Entity selected() const { return selected_; }
    [[nodiscard]] UndoStack& undo_stack() { return undo_; }
    [[nodiscard]] const UndoStack& undo_stack() const { return undo_; }
    /// Edits that leaving the level would lose.
    [[nodiscard]] std::size_t edit_count() const;
    /// The edits so far are in a file now.
    void note_saved() { saved_revision_ = undo_.revision(); }
    /// Those edits as a patch of the level (edit_json.h).
    [[nodiscard]] std::string edits_as_json(World& world) const;
    /// What the keys and buttons for whole entities do to the selected one.
    enum class TreeCommand : std::uint8_t { Cut, Copy, Paste, PasteLocal, Duplicate, Delete };
    /// Returns a line for the user: what was done, or why not.
    std::string run(World& world, TreeCommand command);
    /// What the menu of a whole entity did since the last call, as run() says; "" for nothing.
    [[nodiscard]] std::string take_message() { return std::exchange(message_, {}); }
    /// Whether "Focus" was pressed since the last call.
    [[nodiscard]] bool take_focus() { return std::exchange(focus_, false); }
    /// Whether "Step" of an emitter was pressed since the last call.
    [[nodiscard]] bool take_step() { return std::exchange(step_, false); }
    /// Whether "Edit furrows" of the selected entity was pressed since the last call.
    [[nodiscard]] bool take_furrows() { return std::exchange(furrows_, false); }
    /// Whether "Save" was pressed since the last call.
    [[nodiscard]] bool take_save() { return std::exchange(save_, false); }
    /// Whether "Show skeleton" of the selected entity was pressed since the last call.
    [[nodiscard]] bool take_skeleton() { return std::exchange(skeleton_, false); }
    /// For a new world: clears the selection and the undo stack. `level`: what it was loaded from,
    /// whose prefabs can be placed.
    void reset(const PlacedLevel& level = {});
    /// Selects a new instance of a prefab of the level, at a place in the world. Returns a line for
    /// the user, as run() does.
    std::string place(World& world, const std::string& prefab, const Vec3& position);
    /// The prefab that was chosen in the list since the last call; "" for none.
    [[nodiscard]] std::string take_placed() { return std::exchange(placed_, {}); }

    bool open = false;

  private:
    struct Row {
        Entity entity;
        int depth = 0;
        bool has_children = false;
        bool collapsed = false;
    };

    void draw_entities(const HudStyle& style, World& world);
    void draw_tree(const HudStyle& style, World& world);
    void draw_selected(const HudStyle& style, World& world);
    /// The number of edits, and a button that copies them.
    void draw_edits(World& world);
    void draw_component(const HudStyle& style, World& world, const ComponentInfo& info);
    void draw_add_button(World& world);
    /// The prefabs of the level, to choose one.
    void draw_place_button();
    /// Cut, copy, paste ... of the selected entity, as items of a menu.
    void draw_tree_menu(World& world);
    /// Buttons and counts above the fields of a selected particle emitter.
    void draw_emitter(World& world);
    /// Events as buttons, state, weights of clips and layers of a selected motion graph.
    void draw_graph(World& world);
    void draw_resources(const HudStyle& style, World& world);
    void draw_materials(const HudStyle& style, World& world);

    void rebuild_rows(World& world);
    void add_rows(const Hierarchy& tree, Entity entity, int depth);
    /// Edits a copy of the value; on a change, records it under the label `label` and applies it to
    /// the world.
    void edit_copy(
        const HudStyle& style, World& world, Edit edit, const ComponentInfo& info,
        const void* value, const std::string& label, const FoldedFields& folded = {});

    UndoStack undo_;
    SubtreeEditor subtrees_;
    Entity selected_;
    Entity copied_;     ///< whose JSON was copied last
    Entity noted_;      ///< of note_
    std::string note_;  ///< hint for editing the selected entity (edit_json.h)
    std::string search_;
    std::string resource_search_;
    std::string material_search_;
    std::string message_;               ///< for take_message()
    PlacedLevel level_;                 ///< whose prefabs can be placed
    std::string placed_;                ///< for take_placed()
    std::vector<std::string> prefabs_;  ///< of the level, when the list was opened
    std::string no_prefabs_;            ///< why there are none
    bool focus_ = false;
    bool step_ = false;
    bool furrows_ = false;
    bool skeleton_ = false;
    bool save_ = false;
    std::vector<Row> rows_;
    std::unordered_set<Entity> collapsed_;
    double rows_built_at_ = -1.0;      // [s]
    std::uint64_t rows_revision_ = 0;  // of the edits that they show
    bool reveal_ = false;              // scroll to the selected entity
    std::uint32_t material_ = 0;
    Entity material_of_;                // whose material was shown when it was selected
    std::uint64_t copied_edits_ = 0;    // revision of the edits that were copied last
    std::uint64_t saved_revision_ = 0;  // likewise saved
    StoragePanel storage_;
    std::string dragging_;  // label of the edit that a drag extends
};

}  // namespace limn
