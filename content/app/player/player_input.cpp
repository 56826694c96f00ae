// What held keys, mouse and gamepad do in the window of `limn play`.

#include "content/app/player/gamepad.h"
#include "content/app/player/pick.h"
#include "content/app/player/player.h"

#include <algorithm>
#include <string_view>
#include <unordered_map>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace limn {
namespace {

/// GLFW's code of a bound key; those of one character are its code.
int key_code(std::string_view name) {
    static const std::unordered_map<std::string_view, int> codes = {
        {"Left", GLFW_KEY_LEFT},   {"Right", GLFW_KEY_RIGHT},        {"Up", GLFW_KEY_UP},
        {"Down", GLFW_KEY_DOWN},   {"Shift", GLFW_KEY_LEFT_SHIFT},   {"Alt", GLFW_KEY_LEFT_ALT},
        {"Enter", GLFW_KEY_ENTER}, {"Backspace", GLFW_KEY_BACKSPACE}};
    const auto found = codes.find(name);
    return found != codes.end() ? found->second : name.size() == 1 ? name[0] : GLFW_KEY_UNKNOWN;
}

/// Held, or pressed and released since the last frame.
bool is_down(const Window& window, const WindowEvents& events, std::string_view name) {
    const int key = key_code(name);
    const bool has_right = key == GLFW_KEY_LEFT_SHIFT || key == GLFW_KEY_LEFT_ALT;
    const bool tapped =
        std::any_of(events.keys.begin(), events.keys.end(), [key](const KeyPress& press) {
            return press.key == key && !press.repeated;
        });
    return key != GLFW_KEY_UNKNOWN
           && (tapped || window.is_key_down(key)
               || (has_right && window.is_key_down(key + GLFW_KEY_RIGHT_ALT - GLFW_KEY_LEFT_ALT)));
}

}  // namespace

Input Player::read_input(const WindowEvents& events, float dt) {
    Input input;
    const bool dragging = window_->is_button_down(GLFW_MOUSE_BUTTON_LEFT)
                          || window_->is_button_down(GLFW_MOUSE_BUTTON_RIGHT)
                          || window_->is_button_down(GLFW_MOUSE_BUTTON_MIDDLE);
    const bool on_panel = (hud_->wants_mouse() && !window_->is_mouse_captured()) || pointer_taken_;
    window_->capture_mouse(dragging && !on_panel);
    if (dragging && !on_panel) {
        input.look = events.mouse_motion;
    }
    if (!on_panel) {
        input.zoom = events.wheel;
    }
    if (!hud_->wants_keyboard() && !window_->is_key_down(GLFW_KEY_LEFT_CONTROL)
        && !window_->is_key_down(GLFW_KEY_RIGHT_CONTROL)) {
        const auto* bindings = std::as_const(stage_->world).find_resource<Bindings>();
        const auto read = [&](std::string_view action, std::span<const std::string> keys) {
            if (std::any_of(keys.begin(), keys.end(), [&](const std::string& key) {
                    return is_down(*window_, events, key);
                })) {
                set_action(input, action);
            }
        };
        for (const ActionGroup& group : action_groups()) {
            for (const ActionInfo& action : group.actions) {
                read(action.name, free_keys(action, bindings));
            }
        }
        for (const Bindings::Binding& binding :
             bindings != nullptr ? bindings->bindings : std::vector<Bindings::Binding>{}) {
            read(binding.action, binding.keys);
        }
    }
    if (skin_.pulls()) {
        set_action(input, "pull_skin");
    }
    const GamepadInput gamepad = poll_gamepad();
    add_gamepad(gamepad, dt, input);
    const bool gamepad_clicked = gamepad.click && !gamepad_click_;
    gamepad_click_ = gamepad.click;
    orbit_model(events, input, on_panel);
    const Ray ray = pointer_ray();
    input.eye = ray.origin;
    input.pointing = on_panel && !skin_.pulls() ? Vec3(0) : ray.direction;
    input.click = (events.left_clicked && !on_panel) || gamepad_clicked;
    // Moving or looking around takes over from the level's camera.
    const ActionGroup* const driver = driving_group(stage_->world, stage_->scene.camera);
    const bool turns = driver != nullptr && driver->turns;
    const bool moved = (input.look != Vec2(0) && !turns)
                       || (driver == nullptr && camera_input(input).move != Vec3(0));
    if (camera_.mode == CameraMode::Level && camera_.started && moved) {
        start_fly(camera_, camera_.pose);
    }
    return input;
}

Ray Player::pointer_ray() const {
    return ray_through(
        view_, window_->mouse_position() / Vec2(glm::max(window_->framebuffer_size(), IVec2(1))));
}

bool Player::edit_by_pointer(const WindowEvents& events) {
    const PanelPointer pointer = {
        .at = window_->mouse_position(),
        .motion = events.mouse_motion,
        .left = window_->is_button_down(GLFW_MOUSE_BUTTON_LEFT),
        .right = window_->is_button_down(GLFW_MOUSE_BUTTON_RIGHT),
        .clicked = events.left_clicked,
        .blocked = hud_->wants_mouse() || window_->is_mouse_captured(),
        .window = window_->framebuffer_size()};
    World& world = stage_->world;
    UndoStack& undo = inspector_.undo_stack();
    if (furrows_.take_pointer(world, undo, view_, pointer)) {
        return true;
    }
    if (skeleton_.take_pointer(world, undo, view_, pointer)) {
        return true;
    }
    // Clicks before the first frame were at nothing that is shown.
    if (last_window_size_ != IVec2(0) && markers_.take_pointer(world, view_, pointer)) {
        return true;
    }
    const bool directs = pointer.left && window_->is_key_down(GLFW_KEY_L) && !pointer.blocked
                         && !hud_->wants_keyboard();
    skin_.follow(std::as_const(world), pointer_ray(), pointer.left, pointer.blocked || directs);
    if (!directs) {
        light_.release();
        return skin_.pulls();
    }
    const std::optional<Hit> ahead = pick_entity(world, ray_through(view_, {0.5f, 0.5f}));
    const Vec3 center =
        entity_center(world, inspector_.selected())
            .value_or(
                ahead ? entity_center(world, ahead->entity).value_or(Vec3(0)) : model_center());
    light_.drag(
        world, undo, center, pointer.motion, static_cast<float>(pointer.window.y),
        view_.world_from_camera);
    return true;
}

void Player::select_under_pointer() {
    const std::optional<Hit> hit = pick_entity(stage_->world, pointer_ray());
    inspector_.select(hit ? hit->entity : Entity{});
    if (!stage_->scene.model) {
        camera_.orbit.target = inspector_.selected();
    }
}

}  // namespace limn
