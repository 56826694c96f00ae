// What keys, mouse and gamepad do in the window of `limn play`.

#include "content/app/gamepad.h"
#include "content/app/pick.h"
#include "content/app/player.h"
#include "ecs/components/name.h"
#include "ecs/components/surface.h"

#include <fmt/format.h>

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

bool is_down(const Window& window, std::string_view name) {
    const int key = key_code(name);
    const bool has_right = key == GLFW_KEY_LEFT_SHIFT || key == GLFW_KEY_LEFT_ALT;
    return key != GLFW_KEY_UNKNOWN
           && (window.is_key_down(key)
               || (has_right && window.is_key_down(key + GLFW_KEY_RIGHT_ALT - GLFW_KEY_LEFT_ALT)));
}

}  // namespace

void Player::handle_key(const KeyPress& press) {
    if (leave_.is_open()) {
        if (press.key == GLFW_KEY_ENTER || press.key == GLFW_KEY_KP_ENTER
            || press.key == GLFW_KEY_Y) {
            leave_.accept();
        } else if (press.key == GLFW_KEY_ESCAPE || press.key == GLFW_KEY_N) {
            leave_.stay();
        }
        return;
    }
    if (press.key >= GLFW_KEY_F1 && press.key <= GLFW_KEY_F12) {
        if (!press.repeated) {
            handle_function_key(press.key, (press.modifiers & GLFW_MOD_SHIFT) != 0);
        }
        return;
    }
    if (hud_->wants_keyboard()) {
        return;
    }
    if ((press.modifiers & GLFW_MOD_CONTROL) != 0) {
        if (press.key == GLFW_KEY_Z || press.key == GLFW_KEY_Y) {
            undo_or_redo(press.key == GLFW_KEY_Z && (press.modifiers & GLFW_MOD_SHIFT) == 0);
        }
        return;
    }
    if (press.key == GLFW_KEY_PERIOD) {
        paused_ = true;
        step_once_ = true;
    }
    if (press.repeated) {
        return;
    }
    switch (press.key) {
    case GLFW_KEY_ESCAPE:
        if (!close_one()) {
            ask_to_quit();
        }
        break;
    case GLFW_KEY_HOME:
        go_home();
        break;
    case GLFW_KEY_F:
        focus_selection();
        break;
    case GLFW_KEY_SPACE:
        paused_ = !paused_;
        break;
    case GLFW_KEY_C:
        cycle_camera();
        break;
    case GLFW_KEY_M:
        model_panel_.open = stage_->scene.model && !model_panel_.open;
        break;
    case GLFW_KEY_R:
        leave_level([this] { load_or_report(options_.scene, options_.show); }, "Reload");
        break;
    case GLFW_KEY_TAB:
    case GLFW_KEY_PAGE_DOWN:
        leave_level([this] { load_neighbor(1); });
        break;
    case GLFW_KEY_PAGE_UP:
        leave_level([this] { load_neighbor(-1); });
        break;
    default:
        break;
    }
}

bool Player::close_one() {
    if (hud_->close_popup()) {
        return true;
    }
    const std::pair<std::string_view, bool*> panels[] = {
        {"Keys", &hud_->help_open},      {"Shows", &shows_.open},
        {"Inspector", &inspector_.open}, {"Profiler", &profiler_.open},
        {"Buffers", &buffers_->open},    {"Model", &model_panel_.open}};
    bool* last = nullptr;
    for (const auto& [title, open] : panels) {
        if (*open && (last == nullptr || title == hud_->focused_panel())) {
            last = open;
        }
    }
    if (last != nullptr) {
        *last = false;
    }
    return last != nullptr;
}

void Player::handle_function_key(int key, bool shift) {
    switch (key) {
    case GLFW_KEY_F1:
        hud_->help_open = !hud_->help_open;
        break;
    case GLFW_KEY_F2:
        inspector_.open = !inspector_.open;
        break;
    case GLFW_KEY_F3:
        profiler_.open = !profiler_.open;
        break;
    case GLFW_KEY_F4:
        buffers_->open = !buffers_->open;
        break;
    case GLFW_KEY_F5:
        reload_shaders(true);
        break;
    case GLFW_KEY_F6:
        shows_.open = !shows_.open;
        break;
    case GLFW_KEY_F7:
        shows_.cycle_side();
        hud_->toast(off_stage_ != nullptr ? show_side_name(shows_.side) : "no show; F6 lists them");
        break;
    case GLFW_KEY_F8:
        hud_->status_shown = !hud_->status_shown;
        break;
    case GLFW_KEY_F9:
        screenshot_wanted_ = true;
        screenshot_with_hud_ = shift;
        break;
    case GLFW_KEY_F10:
        exr_wanted_ = true;
        break;
    case GLFW_KEY_F11:
        window_->toggle_fullscreen();
        break;
    case GLFW_KEY_F12:
        paths_shown_ = !paths_shown_;
        break;
    default:
        break;
    }
}

void Player::undo_or_redo(bool undo) {
    UndoStack& stack = inspector_.undo_stack();
    const std::string label = undo ? stack.undo(stage_->world) : stack.redo(stage_->world);
    const char* word = undo ? "undo" : "redo";
    hud_->toast(
        label.empty() ? fmt::format("nothing to {}", word) : fmt::format("{}: {}", word, label));
}

Input Player::read_input(const WindowEvents& events, float dt) {
    Input input;
    const bool dragging = window_->is_button_down(GLFW_MOUSE_BUTTON_LEFT)
                          || window_->is_button_down(GLFW_MOUSE_BUTTON_RIGHT)
                          || window_->is_button_down(GLFW_MOUSE_BUTTON_MIDDLE);
    const bool on_panel = hud_->wants_mouse() && !window_->is_mouse_captured();
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
            if (std::any_of(keys.begin(), keys.end(), [this](const std::string& key) {
                    return is_down(*window_, key);
                })) {
                set_action(input, action);
            }
        };
        for (const ActionGroup& group : action_groups()) {
            for (const ActionInfo& action : group.actions) {
                read(action.name, keys_of(action, bindings));
            }
        }
        for (const Bindings::Binding& binding :
             bindings != nullptr ? bindings->bindings : std::vector<Bindings::Binding>{}) {
            read(binding.action, binding.keys);
        }
    }
    const GamepadInput gamepad = poll_gamepad();
    add_gamepad(gamepad, dt, input);
    const bool gamepad_clicked = gamepad.click && !gamepad_click_;
    gamepad_click_ = gamepad.click;
    orbit_model(events, input, on_panel);
    const Ray ray = pointer_ray();
    input.eye = ray.origin;
    input.pointing = on_panel ? Vec3(0) : ray.direction;
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

void Player::orbit_model(const WindowEvents& events, Input& input, bool on_panel) {
    const bool of_model = stage_->scene.model && camera_.mode == CameraMode::Level;
    if (of_model && camera_.started && (input.look != Vec2(0) || input.zoom != 0)) {
        start_orbit(camera_, camera_.pose, model_middle());
    }
    const bool pans = window_->is_button_down(GLFW_MOUSE_BUTTON_RIGHT)
                      || window_->is_button_down(GLFW_MOUSE_BUTTON_MIDDLE);
    if (camera_.mode == CameraMode::Orbit && pans && !on_panel) {
        if (const auto middle = entity_middle(stage_->world, camera_.orbit.target)) {
            camera_.aim = *middle;
            camera_.orbit.target = {};
        }
        pan_orbit(camera_, events.mouse_motion, static_cast<float>(window_->framebuffer_size().y));
        input.look = {0, 0};
    }
}

Vec3 Player::model_middle() const {
    const LoadedScene& scene = stage_->scene;
    const Bounds& box = scene.model ? scene.model->subject : scene.bounds;
    return is_empty(box) ? Vec3(0) : center(box);
}

void Player::focus_under_pointer() {
    const Ray ray = pointer_ray();
    const std::optional<Hit> hit = pick_entity(stage_->world, ray);
    if (!hit) {
        return;
    }
    if (camera_.mode != CameraMode::Orbit) {
        start_orbit(camera_, camera_.pose, model_middle());
    }
    camera_.orbit.target = {};
    camera_.aim = ray.origin + hit->distance * ray.direction;
}

void Player::focus_selection() {
    const Entity selected = inspector_.selected();
    const std::optional<Vec3> middle = entity_middle(stage_->world, selected);
    if (!middle) {
        hud_->toast("nothing is selected: click an object, or choose one in the inspector (F2)");
        return;
    }
    start_orbit(camera_, camera_.pose, *middle);
    camera_.orbit.target = selected;
    const Bounds box = entity_bounds(stage_->world, selected);
    if (!is_empty(box)) {
        camera_.orbit.distance = framing_distance(camera_.lens, glm::length(half_extent(box)));
    }
}

void Player::go_home() {
    camera_.mode = CameraMode::Level;
    activate_camera(0);
    hud_->toast(camera_mode_name(camera_.mode));
}

void Player::cycle_camera() {
    switch (camera_.mode) {
    case CameraMode::Level:
        if (next_level_camera()) {
            return;
        }
        start_fly(camera_, camera_.pose);
        break;
    case CameraMode::Fly: {
        camera_.orbit.target = inspector_.selected();
        start_orbit(
            camera_, camera_.pose,
            entity_middle(stage_->world, camera_.orbit.target).value_or(model_middle()));
        break;
    }
    case CameraMode::Orbit:
        go_home();
        return;
    }
    hud_->toast(camera_mode_name(camera_.mode));
}

bool Player::next_level_camera() {
    const std::vector<Entity> cameras = level_cameras();
    const auto now = std::find(cameras.begin(), cameras.end(), stage_->scene.camera);
    const auto next = static_cast<std::size_t>(now - cameras.begin()) + 1;
    if (next >= cameras.size()) {
        return false;
    }
    activate_camera(next);
    const auto* name = std::as_const(stage_->world).find<Name>(stage_->scene.camera);
    if (const ActionGroup* const driver = driving_group(stage_->world, stage_->scene.camera)) {
        hud_->toast(
            describe_group(*driver, std::as_const(stage_->world).find_resource<Bindings>()));
    } else {
        hud_->toast(name != nullptr ? name->text : "level camera");
    }
    return true;
}

std::vector<Entity> Player::level_cameras() {
    std::vector<Entity> cameras;
    stage_->world.query<const Camera>().each(
        [&](Entity entity, const Camera&) { cameras.push_back(entity); });
    std::sort(cameras.begin(), cameras.end(), [](Entity a, Entity b) { return a.index < b.index; });
    const auto first = std::find(cameras.begin(), cameras.end(), first_camera_);
    if (first != cameras.end()) {
        std::rotate(cameras.begin(), first, first + 1);
    }
    return cameras;
}

void Player::activate_camera(std::size_t index) {
    const std::vector<Entity> cameras = level_cameras();
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        stage_->world.get<Camera>(cameras[i]).active = i == index;
    }
    if (index < cameras.size()) {
        stage_->scene.camera = cameras[index];
    }
}

Ray Player::pointer_ray() const {
    return ray_through(
        view_, window_->mouse_position() / Vec2(glm::max(window_->framebuffer_size(), IVec2(1))));
}

void Player::select_under_pointer() {
    const std::optional<Hit> hit = pick_entity(stage_->world, pointer_ray());
    inspector_.select(hit ? hit->entity : Entity{});
    if (!stage_->scene.model) {
        camera_.orbit.target = inspector_.selected();
    }
}

}  // namespace limn
