#include "content/app/player/gamepad.h"
#include "content/game/game.h"
#include "ecs/components/input.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace limn::gamepad_test {
namespace {

GLFWgamepadstate at_rest() {
    GLFWgamepadstate state = {};
    state.axes[GLFW_GAMEPAD_AXIS_LEFT_TRIGGER] = -1;
    state.axes[GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER] = -1;
    return state;
}

Input input_of(const GLFWgamepadstate& state, float dt = 0.1f) {
    register_game_components();
    Input input;
    add_gamepad(read_gamepad(state), dt, input);
    return input;
}

}  // namespace

TEST_CASE("gamepad: at rest, and within the dead zone, nothing moves") {
    GLFWgamepadstate state = at_rest();
    state.axes[GLFW_GAMEPAD_AXIS_LEFT_X] = 0.1f;
    state.axes[GLFW_GAMEPAD_AXIS_RIGHT_Y] = -0.1f;
    const Input input = input_of(state);
    CHECK(input.actions.empty());
    CHECK(input.look == Vec2(0));
    CHECK_FALSE(read_gamepad(state).click);
}

TEST_CASE("gamepad: outside the dead zone a stick starts at 0 and keeps its direction") {
    CHECK(glm::length(without_dead_zone({0.1501f, 0})) < 1e-3f);
    CHECK(glm::length(without_dead_zone({0, -1})) == test::near(1).epsilon(1e-6));
    CHECK(glm::length(without_dead_zone({1, 1})) == test::near(1).epsilon(1e-6));
    const Vec2 stick = without_dead_zone({0.3f, 0.4f});
    CHECK(stick.y / stick.x == test::near(4.0 / 3.0).epsilon(1e-5));
    CHECK(glm::length(stick) == test::near(0.35 / 0.85).epsilon(1e-5));
}

TEST_CASE("gamepad: the left stick flies and drives, triggers rise and sink, B is faster") {
    GLFWgamepadstate state = at_rest();
    state.axes[GLFW_GAMEPAD_AXIS_LEFT_Y] = -1;  // pushed forward
    state.axes[GLFW_GAMEPAD_AXIS_LEFT_TRIGGER] = 1;
    state.buttons[GLFW_GAMEPAD_BUTTON_B] = GLFW_PRESS;
    const Input input = input_of(state);
    const MoveInput move = camera_input(input);
    CHECK(move.move == Vec3(0, -1, 1));
    CHECK(move.fast);
    CHECK(action_value(input, "accelerate") == 1.0f);
    CHECK(action_value(input, "brake") == 0.0f);
    state = at_rest();
    state.axes[GLFW_GAMEPAD_AXIS_LEFT_X] = -0.575f;
    CHECK(action_value(input_of(state), "steer_left") == test::near(0.5).epsilon(1e-5));
}

TEST_CASE("gamepad: the right stick looks around like a mouse, at a speed independent of the frame "
          "rate") {
    GLFWgamepadstate state = at_rest();
    state.axes[GLFW_GAMEPAD_AXIS_RIGHT_X] = 1;
    const Vec2 once = input_of(state, 0.2f).look;
    CHECK(once.x > 0);
    CHECK(once.y == 0);
    CHECK(once.x == test::near(2 * input_of(state, 0.1f).look.x).epsilon(1e-5));
    state.buttons[GLFW_GAMEPAD_BUTTON_A] = GLFW_PRESS;
    CHECK(read_gamepad(state).click);
}

}  // namespace limn::gamepad_test
