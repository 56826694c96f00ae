#pragma once

#include "ecs/base/math.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

class World;

// Input as named actions ("steer_left"). Systems read their values; which keys they have is up to
// the level, or else the defaults that are registered with them.

struct ActionValue {
    std::string action;
    float value = 0.0f;
};

LIMN_FIELDS(ActionValue) {
    LIMN_FIELD(action, "name of the action");
    LIMN_FIELD(value, "1 while its key is held", "", -1, 1);
}

/// Resource: player input of this step, independent of its source: a window, a level's timed events
/// or a replay.
struct Input {
    std::vector<ActionValue> actions{};  ///< those not listed are 0
    std::vector<ActionValue> before{};   ///< in the previous step; kept by keep_input
    Vec2 look = {0, 0};                  ///< mouse motion [pixels]: x right, y down
    float zoom = 0.0f;
    bool click = false;  ///< click at the pointer; reset to false by the system that handles it
    Vec3 eye = {0, 0, 0};
    Vec3 pointing = {0, 0, 0};
};

LIMN_FIELDS(Input) {
    LIMN_FIELD(actions, "actions in use");
    LIMN_FIELD(before, "actions in use in the previous step");
    LIMN_FIELD(look, "mouse motion", "pixels");
    LIMN_FIELD(zoom, "wheel steps, > 0 = closer");
    LIMN_FIELD(click, "click at the pointer; reset when handled");
    LIMN_FIELD(eye, "origin of the pointer ray", "m");
    LIMN_FIELD(pointing, "direction of the pointer ray; 0: none");
}

[[nodiscard]] float action_value(const Input& input, std::string_view action);
/// Whether the action is in use since this step; or no longer is since this step.
[[nodiscard]] bool is_pressed(const Input& input, std::string_view action);
[[nodiscard]] bool is_released(const Input& input, std::string_view action);
/// Value of `more` minus that of `less`.
[[nodiscard]] float action_axis(const Input& input, std::string_view more, std::string_view less);
void set_action(Input& input, std::string_view action, float value = 1.0f);
/// Replaces the input by that of a new frame. The actions of the previous step are kept, and a
/// click is kept until a step has handled it, since a frame may run no step.
void take_input(Input& input, const Input& frame);

/// Input that moves a camera or a person: values of `move` are right, up and forward.
struct MoveInput {
    Vec3 move = {0, 0, 0};
    Vec2 look = {0, 0};
    float zoom = 0.0f;
    bool fast = false;
};

/// The values of the actions move_left, move_right, move_down, move_up, move_back, move_forward and
/// move_fast.
[[nodiscard]] MoveInput camera_input(const Input& input);

// ---- which actions there are --------------------------------------------------------------------

struct ActionInfo {
    std::string name;
    std::string doc;  ///< for the help; neighbors with the same share a line
    std::vector<std::string> keys;
};

/// Actions with one purpose.
struct ActionGroup {
    std::string title;
    std::vector<ActionInfo> actions;
    /// Whether something in the world responds to them while `camera` is active.
    bool (*is_used)(const World& world, Entity camera) = nullptr;
    bool drives = false;  ///< they move something, so that the player's own camera does not move
    bool turns = false;   ///< they turn it by Input::look
};

/// Makes the group known; a second one with the same title is ignored.
void register_actions(ActionGroup group);
/// Those of the engine: camera, lens, skin, weather. Called by register_all_components.
void register_engine_actions();
[[nodiscard]] std::span<const ActionGroup> action_groups();
/// The names of all actions.
[[nodiscard]] std::vector<std::string_view> action_names();

/// Resource: the keys of a level, instead of the default ones.
struct Bindings {
    struct Binding {
        std::string action;
        std::vector<std::string> keys;
        std::string text = {};  ///< for the help, of an action of the level's own
    };
    std::vector<Binding> bindings;
};

template <>
struct ComponentTraits<Bindings> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
};

[[nodiscard]] std::span<const std::string> keys_of(const ActionInfo& action, const Bindings* level);

/// Names of the keys that can be bound: "A", "7", "[", "Left", "Shift" ... Those that the program
/// itself uses are not among them.
[[nodiscard]] const std::vector<std::string_view>& key_names();

}  // namespace limn
