// What single presses of keys do in the window of `limn play`.

#include "content/app/player.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace limn {

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

}  // namespace limn
