#pragma once

#include "content/app/player/pose_gizmo.h"
#include "content/app/player/press_edge.h"
#include "content/app/player/skeleton_overlay.h"
#include "ecs/components/pose_keys.h"
#include "ecs/entity.h"

#include <optional>
#include <string>
#include <utility>

namespace limn {

class UndoStack;
class World;
struct HudStyle;
struct PanelPointer;
struct RenderView;

// Shift F2: a character's skeleton, with names, axes and limits of joints, ghosts, trails and
// curves (char.ghost-view), and the editor of poses by hand (char.fk-keypose): a click selects a
// joint, a drag of a ring turns it and sets a key. Edits go on the inspector's undo stack.

class SkeletonPanel {
  public:
    /// Shows a character; a null entity is ignored.
    void open(Entity character);
    void close() { character_ = {}; }
    [[nodiscard]] bool is_open() const { return !character_.is_null(); }
    /// The one that is shown; null: none.
    [[nodiscard]] Entity character() const { return character_; }
    /// Whether poses are edited.
    [[nodiscard]] bool poses() const { return is_open() && poses_; }
    /// For a new world.
    void reset() { *this = {}; }

    /// Keeps the poses of the last steps for ghosts and trails. Call every frame.
    void record(const World& world, double time);
    /// Whether the editor takes the pointer in this frame, so that it moves no camera.
    [[nodiscard]] bool take_pointer(
        World& world, UndoStack& undo, const RenderView& view, const PanelPointer& pointer);
    void draw_overlay(const RenderView& view, const World& world) const;
    void draw(const HudStyle& style, World& world, UndoStack& undo);

    /// Message on what was saved or failed since the last call; empty: none.
    [[nodiscard]] std::string take_message() { return std::exchange(message_, {}); }

    // ---- edits, without a window ----

    /// Begins to pose the character: its present pose is the first key, at 0 s, and it stands
    /// still.
    void start_poses(World& world, UndoStack& undo);
    /// Selects a joint by index; -1: none.
    void select(int joint) { overlay_.selected = joint; }
    /// Turns the selected joint from its rest pose, within its limits, in a key at the present
    /// time.
    void turn_selected(World& world, UndoStack& undo, const Quat& turn);
    void set_time(World& world, float time);
    void set_key(World& world, UndoStack& undo);
    void remove_key(World& world, UndoStack& undo);
    void mirror(World& world, UndoStack& undo);
    /// Writes skeleton and keys as a clip in a .glb.
    void save(const World& world);
    /// A drag is over: the next edit is another one.
    void release() { last_edit_.clear(); }

  private:
    struct Posing {
        CharacterView view;
        PoseKeys keys;
    };
    [[nodiscard]] std::optional<Posing> posing(const World& world) const;
    void set_keys(World& world, UndoStack& undo, PoseKeys after, const char* what);
    void draw_view();
    void draw_joints(const HudStyle& style, const CharacterView& view);
    void draw_curves(const HudStyle& style, const CharacterView& view) const;
    void draw_poses(const HudStyle& style, World& world, UndoStack& undo);
    void draw_angles(World& world, UndoStack& undo, const CharacterView& view);
    void draw_timeline(const HudStyle& style, World& world, const Posing& posing);

    Entity character_;
    SkeletonOverlay overlay_;
    MotionHistory history_;
    bool poses_ = false;
    bool curves_ = false;
    bool by_limits_ = true;
    float snap_ = 0.0f;    ///< [degrees]
    float length_ = 2.0f;  ///< of the timeline [s]
    PressEdge left_;
    int ring_ = -1;            ///< that is dragged
    float ring_start_ = 0.0f;  ///< angle of the pointer at the begin of the drag [rad]
    PoseGizmo ring_gizmo_;     ///< then
    Quat ring_turn_ = {1, 0, 0, 0};
    std::string last_edit_;
    std::string search_;
    std::string message_;
    int saved_ = 0;
};

}  // namespace limn
