#pragma once

#include "content/app/panels/hud.h"
#include "content/app/player/player_camera.h"
#include "ecs/components/input.h"
#include "ecs/entity.h"

#include <span>
#include <string>
#include <vector>

namespace limn {

class Player;
class World;

// The keys of the window, one table for their actions and for the help (F1), which lists only keys
// that apply to this level and the open panels.

/// What the player is doing.
struct HelpState {
    CameraMode camera = CameraMode::Level;
    Entity level_camera = {};
    bool drives = false;      ///< the level's camera follows something that the keys drive
    bool throws = false;      ///< a click throws a stone
    bool paths = false;       ///< there are paths to show
    bool model = false;       ///< a single model is shown
    bool show = false;        ///< a technique with and without is loaded
    bool selected = false;    ///< an entity is
    bool edited = false;      ///< there is something to undo or to redo
    bool inspector = false;   ///< its panel is open
    bool furrows = false;     ///< the editor of furrows is open
    bool characters = false;  ///< there are some
    bool skeleton = false;    ///< one is shown
    bool poses = false;       ///< and posed
    bool skin = false;        ///< some skin can be pulled
    bool markers = false;     ///< of a recording are loaded
    bool places = false;      ///< and their places are edited
    bool panel = false;       ///< some panel is open
    bool relief = false;      ///< some material has surface detail beyond normal maps
};

/// A key of the window: its action and when the help lists it.
struct PlayerKey {
    const char* heading = "";
    const char* label = "";  ///< "Ctrl Z"; empty: another key for the same, which no help lists
    const char* text = "";   ///< neighbors with the same share a line
    int key = 0;             ///< GLFW's code; 0: of the mouse, only listed
    int modifiers = 0;       ///< GLFW_MOD_CONTROL, GLFW_MOD_SHIFT
    void (*act)(Player& player) = nullptr;
    bool (*shown)(const HelpState& state) = nullptr;  ///< nullptr: always
    bool repeats = false;                             ///< while held
};

/// The row for a press: with its modifiers, or else the one without Shift, which also means flying
/// faster; nullptr: none.
[[nodiscard]] const PlayerKey* find_key(std::span<const PlayerKey> keys, int key, int modifiers);

/// The group of actions that moves something other than the player's camera; nullptr: none.
[[nodiscard]] const ActionGroup* driving_group(const World& world, Entity camera);

/// The keys of an action, without those that the level assigns to actions of its own.
[[nodiscard]] std::vector<std::string>
free_keys(const ActionInfo& action, const Bindings* bindings);

/// Headings and lines, in reading order: the level's actions, then `keys`.
[[nodiscard]] std::vector<KeyHelp>
player_help(const World& world, const HelpState& state, std::span<const PlayerKey> keys);

/// "drive: W S accelerate, brake; A D steer ..." of the actions of a group.
[[nodiscard]] std::string describe_group(const ActionGroup& group, const Bindings* bindings);

}  // namespace limn
