#pragma once

#include "content/app/panels/furrow_edits.h"
#include "content/app/player/light_drag.h"
#include "content/app/player/press_edge.h"
#include "ecs/base/math.h"
#include "ecs/entity.h"

#include <optional>
#include <string>
#include <utility>

namespace limn {

class UndoStack;
class World;
struct HudStyle;
struct RenderView;

/// The mouse in a frame, in pixels of the window from its top left.
struct PanelPointer {
    Vec2 at = {0, 0};
    Vec2 motion = {0, 0};
    bool left = false;     ///< held
    bool right = false;    ///< held
    bool clicked = false;  ///< the left button, without dragging
    bool blocked = false;  ///< over a panel
    IVec2 window = {1, 1};
};

// The editor of furrows in `limn play` (wrinkle.furrow.editor): a click selects a vertex, a drag of
// the tip of one of its vectors turns and stretches it, a right drag aims the light; everything
// else is in the panel. Edits go on the inspector's undo stack.

class FurrowPanel {
  public:
    /// Shows the fields of an entity with Furrows.
    void open(World& world, Entity entity);
    /// Restores the previous FurrowView.
    void close(World& world);
    [[nodiscard]] bool is_open() const { return !entity_.is_null(); }
    [[nodiscard]] Entity entity() const { return entity_; }
    /// For a new world.
    void reset() { *this = {}; }

    /// Whether the editor takes the pointer in this frame, so that it moves no camera.
    [[nodiscard]] bool take_pointer(
        World& world, UndoStack& undo, const RenderView& view, const PanelPointer& pointer);
    void draw(const HudStyle& style, World& world, UndoStack& undo);

    /// Whether view and light were asked to face the entity since the last call.
    [[nodiscard]] bool take_reset() { return std::exchange(reset_view_, false); }
    /// Message on what was saved, loaded or failed since the last call; empty: none.
    [[nodiscard]] std::string take_message() { return std::exchange(message_, {}); }

  private:
    void set_furrows(World& world, UndoStack& undo, const Furrows& after, const char* what);
    void set_material(World& world, UndoStack& undo, const FurrowLook& look, const char* what);
    void drag_tip(World& world, UndoStack& undo, const RenderView& view, const PanelPointer& at);
    void select(World& world, int vertex);

    void draw_display(World& world);
    void draw_vectors(World& world, UndoStack& undo);
    void draw_wrinkles(World& world, UndoStack& undo);
    void draw_skin(World& world, UndoStack& undo);
    void draw_files(World& world, UndoStack& undo);

    Entity entity_;
    std::optional<FurrowView> before_;  ///< of the entity, when it was opened
    std::optional<int> tip_;            ///< of the selected vertex, while dragged
    PressEdge left_;
    LightDrag light_;
    std::string last_edit_;  ///< target of the last edit, which a drag extends
    bool reset_view_ = false;
    std::string path_;
    std::string message_;
};

}  // namespace limn
