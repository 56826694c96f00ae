#pragma once

#include "ecs/base/math.h"
#include "ecs/components/input.h"

struct GLFWgamepadstate;

namespace limn {

// A gamepad with the layout of an Xbox controller (GLFW's mapping): the left stick moves or drives,
// the right one looks around, the triggers go down and up, A clicks at the pointer and jumps, B is
// faster, X picks up and throws.

/// The state of a gamepad in terms of the camera's and drivers' actions.
struct GamepadInput {
    Vec2 move = {0, 0};  ///< right, forward; -1 .. 1 after the dead zone
    Vec2 look = {0, 0};  ///< right, down; -1 .. 1
    float rise = 0.0f;   ///< up; -1 .. 1
    bool fast = false;
    bool click = false;  ///< A is down; jumps, too
    bool carry = false;  ///< X is down
};

/// A stick's position without its dead zone: 0 within 0.15 of the center, rising to 1 at the
/// rim; keeps the direction.
[[nodiscard]] Vec2 without_dead_zone(const Vec2& stick);

[[nodiscard]] GamepadInput read_gamepad(const GLFWgamepadstate& state);

/// The first connected gamepad; all 0 without one.
[[nodiscard]] GamepadInput poll_gamepad();

/// Adds it to `input`: the stick as the keys W, A, S, D of every group of actions, the look as the
/// motion of a mouse in `dt` seconds.
void add_gamepad(const GamepadInput& gamepad, float dt, Input& input);

}  // namespace limn
