#include "content/app/player/gamepad.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <string_view>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace limn {
namespace {

constexpr float kDeadZone = 0.15f;
constexpr float kLookSpeed = 900.0f;  // [mouse pixels/s] at full deflection

/// The actions that have `key` as their first key by default: "W" moves forward, or accelerates.
void set_actions_of(Input& input, std::string_view key, float value) {
    if (value <= 0) {
        return;
    }
    for (const ActionGroup& group : action_groups()) {
        for (const ActionInfo& action : group.actions) {
            if (!action.keys.empty() && action.keys.front() == key) {
                set_action(input, action.name, std::max(value, action_value(input, action.name)));
            }
        }
    }
}

}  // namespace

Vec2 without_dead_zone(const Vec2& stick) {
    const float length = glm::length(stick);
    if (!(length > kDeadZone)) {
        return {0, 0};
    }
    return stick / length * std::min((length - kDeadZone) / (1.0f - kDeadZone), 1.0f);
}

GamepadInput read_gamepad(const GLFWgamepadstate& state) {
    const auto trigger = [&](int axis) { return 0.5f * (state.axes[axis] + 1.0f); };
    const Vec2 left = without_dead_zone(
        {state.axes[GLFW_GAMEPAD_AXIS_LEFT_X], state.axes[GLFW_GAMEPAD_AXIS_LEFT_Y]});
    const Vec2 triggers = without_dead_zone(
        {trigger(GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER) - trigger(GLFW_GAMEPAD_AXIS_LEFT_TRIGGER), 0});
    return {
        .move = {left.x, -left.y},
        .look = without_dead_zone(
            {state.axes[GLFW_GAMEPAD_AXIS_RIGHT_X], state.axes[GLFW_GAMEPAD_AXIS_RIGHT_Y]}),
        .rise = triggers.x,
        .fast = state.buttons[GLFW_GAMEPAD_BUTTON_B] == GLFW_PRESS,
        .click = state.buttons[GLFW_GAMEPAD_BUTTON_A] == GLFW_PRESS,
        .carry = state.buttons[GLFW_GAMEPAD_BUTTON_X] == GLFW_PRESS};
}

GamepadInput poll_gamepad() {
    for (int joystick = GLFW_JOYSTICK_1; joystick <= GLFW_JOYSTICK_LAST; ++joystick) {
        GLFWgamepadstate state;
        if (glfwGetGamepadState(joystick, &state) == GLFW_TRUE) {
            return read_gamepad(state);
        }
    }
    return {};
}

void add_gamepad(const GamepadInput& gamepad, float dt, Input& input) {
    set_actions_of(input, "D", gamepad.move.x);
    set_actions_of(input, "A", -gamepad.move.x);
    set_actions_of(input, "W", gamepad.move.y);
    set_actions_of(input, "S", -gamepad.move.y);
    set_actions_of(input, "E", gamepad.rise);
    set_actions_of(input, "Q", -gamepad.rise);
    set_actions_of(input, "Shift", gamepad.fast ? 1.0f : 0.0f);
    set_actions_of(input, "Enter", gamepad.click ? 1.0f : 0.0f);
    set_actions_of(input, "G", gamepad.carry ? 1.0f : 0.0f);
    // Squared: small turns near the center stay precise.
    input.look += kLookSpeed * dt * glm::length(gamepad.look) * gamepad.look;
}

}  // namespace limn
