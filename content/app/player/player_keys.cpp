// Single key presses in the window of `limn play`, and their help.

#include "content/app/player/path_overlay.h"
#include "content/app/player/player.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace limn {
namespace {

bool circles(const HelpState& state) {
    return state.camera == CameraMode::Orbit || state.model;
}
bool looks(const HelpState& state) {
    return !circles(state);
}
bool flies(const HelpState& state) {
    return looks(state) && state.camera == CameraMode::Fly;
}
bool has_inspector(const HelpState& state) {
    return state.inspector;
}
bool edits_furrows(const HelpState& state) {
    return state.furrows;
}
bool shows_relief(const HelpState& state) {
    return state.relief;
}
bool has_markers(const HelpState& state) {
    return state.markers;
}
bool is_selected(const HelpState& state) {
    return state.selected;
}
bool has_edits(const HelpState& state) {
    return state.edited;
}

}  // namespace

std::span<const PlayerKey> Player::keys() {
    constexpr int kControl = GLFW_MOD_CONTROL;
    constexpr int kShift = GLFW_MOD_SHIFT;
    static const PlayerKey kKeys[] = {
        {.heading = "Camera", .label = "Drag", .text = "orbit the target", .shown = circles},
        {.heading = "Camera", .label = "Right drag", .text = "pan", .shown = circles},
        {.heading = "Camera", .label = "Wheel", .text = "distance", .shown = circles},
        {.heading = "Camera", .label = "Drag", .text = "look around", .shown = looks},
        {.heading = "Camera", .label = "Wheel", .text = "fly slower, faster", .shown = flies},
        {.heading = "Camera", .label = "Double-click", .text = "orbit what is under the pointer"},
        {"Camera", "Home", "back to the level's camera", GLFW_KEY_HOME, 0,
         [](Player& p) { p.go_home(); }},
        {"Camera", "C", "next camera: those of the level, fly, orbit", GLFW_KEY_C, 0,
         [](Player& p) { p.cycle_camera(); }},
        {"Camera", "F", "orbit the selection", GLFW_KEY_F, 0,
         [](Player& p) { p.focus_selection(); }, is_selected},

        {"Time and levels", "Space", "pause, resume", GLFW_KEY_SPACE, 0,
         [](Player& p) { p.set_paused(!p.paused_); }},
        {"Time and levels", ".", "one step", GLFW_KEY_PERIOD, 0,
         [](Player& p) { p.paused_ = p.step_once_ = true; }, nullptr, true},
        {"Time and levels", "R", "reload the level from its file", GLFW_KEY_R, 0,
         [](Player& p) {
             p.leave_level([&p] { p.load_or_report(p.options_.scene, p.options_.show); }, "Reload");
         }},
        {"Time and levels", "PgUp", "previous level", GLFW_KEY_PAGE_UP, 0,
         [](Player& p) { p.leave_level([&p] { p.load_neighbor(-1); }); }},
        {"Time and levels", "PgDn", "next level", GLFW_KEY_PAGE_DOWN, 0,
         [](Player& p) { p.leave_level([&p] { p.load_neighbor(1); }); }},
        {"Time and levels", "Tab", "next level", GLFW_KEY_TAB, 0,
         [](Player& p) { p.leave_level([&p] { p.load_neighbor(1); }); }},

        {"Panels", "F1", "these keys", GLFW_KEY_F1, 0,
         [](Player& p) { p.hud_->help_open = !p.hud_->help_open; }},
        {"Panels", "F2", "inspector: every entity and component", GLFW_KEY_F2, 0,
         [](Player& p) { p.inspector_.open = !p.inspector_.open; }},
        {"Panels", "Shift F2", "skeleton of a character: ghosts, trails, curves, poses",
         GLFW_KEY_F2, kShift, [](Player& p) { p.toggle_skeleton(); },
         [](const HelpState& state) { return state.characters; }},
        {"Panels", "F3", "profiler of systems and passes", GLFW_KEY_F3, 0,
         [](Player& p) { p.profiler_.open = !p.profiler_.open; }},
        {"Panels", "F4", "intermediate textures of the frame", GLFW_KEY_F4, 0,
         [](Player& p) { p.buffers_->open = !p.buffers_->open; }},
        {"Panels", "F6", "techniques that levels show, with and without", GLFW_KEY_F6, 0,
         [](Player& p) { p.shows_.open = !p.shows_.open; }},
        {"Panels", "F7", "technique on, off, side by side", GLFW_KEY_F7, 0,
         [](Player& p) { p.cycle_show_side(); }, [](const HelpState& state) { return state.show; }},
        {"Panels", "F8", "hide the status", GLFW_KEY_F8, 0,
         [](Player& p) { p.hud_->status_shown = !p.hud_->status_shown; }},
        {"Panels", "-", "less, more surface detail, from flat to relief, with its cost",
         GLFW_KEY_MINUS, 0, [](Player& p) { p.change_detail(1); }, shows_relief},
        {"Panels", "=", "less, more surface detail, from flat to relief, with its cost",
         GLFW_KEY_EQUAL, 0, [](Player& p) { p.change_detail(-1); }, shows_relief},
        {"Panels", "F12", "paths with their knots, camera paths with times", GLFW_KEY_F12, 0,
         [](Player& p) { p.toggle_paths(); }, [](const HelpState& state) { return state.paths; }},
        {"Panels", "M", "clips, morph targets and cameras of the model", GLFW_KEY_M, 0,
         [](Player& p) { p.model_panel_.open = p.stage_->scene.model && !p.model_panel_.open; },
         [](const HelpState& state) { return state.model; }},
        {"Panels", "Shift M", "places of a recording's markers on the face", GLFW_KEY_M, kShift,
         [](Player& p) { p.toggle_markers(); }, has_markers},

        {.heading = "Edit",
         .label = "Click",
         .text = "select what is under the pointer",
         .shown = [](const HelpState& state) { return !state.throws; }},
        {.heading = "Edit",
         .label = "Click",
         .text = "select; throw a stone into the water",
         .shown = [](const HelpState& state) { return state.throws; }},
        {.heading = "Edit",
         .label = "Drag",
         .text = "a number of a panel; Ctrl click to type it",
         .shown = [](const HelpState& state) { return state.panel; }},
        {.heading = "Edit",
         .label = "Right click",
         .text = "a component's heading: copy it as JSON; a key of a curve: remove it",
         .shown = has_inspector},
        {.heading = "Edit",
         .label = "Double-click",
         .text = "a curve or gradient: add a key",
         .shown = has_inspector},
        {.heading = "Edit",
         .label = "L + drag",
         .text = "turn the brightest light around the selection"},
        {.heading = "Edit",
         .label = "Drag",
         .text = "the skin of a face: pull it; it springs back",
         .shown = [](const HelpState& state) { return state.skin; }},
        {.heading = "Edit",
         .label = "Click",
         .text = "furrows: select a vertex",
         .shown = edits_furrows},
        {.heading = "Edit",
         .label = "Drag",
         .text = "furrows: the tip of a vector; right drag: the light",
         .shown = edits_furrows},
        {.heading = "Edit",
         .label = "Click",
         .text = "skeleton: select a joint",
         .shown = [](const HelpState& state) { return state.skeleton; }},
        {.heading = "Edit",
         .label = "Drag",
         .text = "skeleton: a ring of the joint turns it, and sets a key",
         .shown = [](const HelpState& state) { return state.poses; }},
        {.heading = "Edit",
         .label = "Click",
         .text = "markers: the place of the selected one on the face",
         .shown = [](const HelpState& state) { return state.places; }},
        {"Edit", "Ctrl X", "cut, copy, paste the selected entity with its children", GLFW_KEY_X,
         kControl, [](Player& p) { p.run_on_selected(Inspector::TreeCommand::Cut); }, is_selected},
        {"Edit", "Ctrl C", "cut, copy, paste the selected entity with its children", GLFW_KEY_C,
         kControl, [](Player& p) { p.run_on_selected(Inspector::TreeCommand::Copy); }, is_selected},
        {"Edit", "Ctrl V", "cut, copy, paste the selected entity with its children", GLFW_KEY_V,
         kControl, [](Player& p) { p.run_on_selected(Inspector::TreeCommand::Paste); },
         is_selected},
        {"Edit", "Ctrl Shift V", "paste what was cut, with its transform", GLFW_KEY_V,
         kControl | kShift,
         [](Player& p) { p.run_on_selected(Inspector::TreeCommand::PasteLocal); }, is_selected},
        {"Edit", "Ctrl D", "duplicate, delete it", GLFW_KEY_D, kControl,
         [](Player& p) { p.run_on_selected(Inspector::TreeCommand::Duplicate); }, is_selected},
        {"Edit", "Ctrl Del", "duplicate, delete it", GLFW_KEY_DELETE, kControl,
         [](Player& p) { p.run_on_selected(Inspector::TreeCommand::Delete); }, is_selected},
        {"Edit", "Ctrl Z", "undo", GLFW_KEY_Z, kControl, [](Player& p) { p.undo_or_redo(true); },
         has_edits},
        {"Edit", "Ctrl Y", "redo", GLFW_KEY_Y, kControl, [](Player& p) { p.undo_or_redo(false); },
         has_edits},
        {"Edit", "", "redo", GLFW_KEY_Z, kControl | kShift,
         [](Player& p) { p.undo_or_redo(false); }},
        {"Edit", "Ctrl S", "save the edits as a new level", GLFW_KEY_S, kControl,
         [](Player& p) { p.save_edits(); }, has_edits},

        {"Program", "F5", "reload the shaders (changed files reload by themselves)", GLFW_KEY_F5, 0,
         [](Player& p) { p.reload_shaders(true); }},
        {"Program", "Shift F5", "next renderer: full, plain", GLFW_KEY_F5, kShift,
         [](Player& p) { p.request_next_renderer(); }},
        {"Program", "F9", "screenshot as PNG", GLFW_KEY_F9, 0,
         [](Player& p) {
             p.screenshot_wanted_ = true;
             p.screenshot_with_hud_ = false;
         }},
        {"Program", "Shift F9", "screenshot with status and panels", GLFW_KEY_F9, kShift,
         [](Player& p) { p.screenshot_wanted_ = p.screenshot_with_hud_ = true; }},
        {"Program", "F10", "HDR image with all layers as EXR", GLFW_KEY_F10, 0,
         [](Player& p) { p.exr_wanted_ = true; }},
        {"Program", "F11", "full screen", GLFW_KEY_F11, 0,
         [](Player& p) { p.window_->toggle_fullscreen(); }},
        {"Program", "Esc", "close the popup, the panel; then quit", GLFW_KEY_ESCAPE, 0,
         [](Player& p) { p.close_one_or_ask(); }},
    };
    return kKeys;
}

void Player::handle_key(const KeyPress& press) {
    if (leave_.is_open()) {
        if (press.key == GLFW_KEY_ENTER || press.key == GLFW_KEY_KP_ENTER
            || press.key == GLFW_KEY_Y) {
            leave_.accept();
        } else if (press.key == GLFW_KEY_ESCAPE || press.key == GLFW_KEY_N) {
            leave_.stay();
        } else if (press.key == GLFW_KEY_S && !press.repeated) {
            save_edits();
        }
        return;
    }
    // While a text field has the focus, only keys without a character count.
    const bool types = press.key < GLFW_KEY_F1 || press.key > GLFW_KEY_F12;
    if (types && hud_->wants_keyboard()) {
        return;
    }
    const PlayerKey* const key = find_key(keys(), press.key, press.modifiers);
    if (key != nullptr && (key->repeats || !press.repeated)) {
        key->act(*this);
    }
}

void Player::close_one_or_ask() {
    if (hud_->close_popup()) {
        return;
    }
    if (furrows_.is_open()) {
        furrows_.close(stage_->world);
        return;
    }
    if (skeleton_.is_open()) {
        skeleton_.close();
        return;
    }
    if (markers_.is_open()) {
        markers_.close();
        return;
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
    } else {
        ask_to_quit();
    }
}

void Player::change_detail(int steps) {
    DetailLimit& limit = stage_->world.resource<Rendering>().surface_detail;
    const int next = std::clamp(static_cast<int>(limit) + steps, 0, kDetailLimits - 1);
    limit = static_cast<DetailLimit>(next);
    hud_->toast(fmt::format("surface detail: {}", kDetailLimitTexts[next]));
}

void Player::cycle_show_side() {
    shows_.cycle_side();
    hud_->toast(off_stage_ != nullptr ? show_side_name(shows_.side) : "no show; F6 lists them");
}

void Player::toggle_paths() {
    if (has_paths(stage_->world)) {
        paths_shown_ = !paths_shown_;
    } else {
        hud_->toast("this level has no paths");
    }
}

void Player::run_on_selected(Inspector::TreeCommand command) {
    hud_->toast(inspector_.run(stage_->world, command));
}

void Player::undo_or_redo(bool undo) {
    if (undo && markers_.is_open()) {
        hud_->toast(markers_.undo(stage_->world) ? "undo: place of a marker" : "nothing to undo");
        return;
    }
    UndoStack& stack = inspector_.undo_stack();
    const std::string label = undo ? stack.undo(stage_->world) : stack.redo(stage_->world);
    const char* word = undo ? "undo" : "redo";
    hud_->toast(
        label.empty() ? fmt::format("nothing to {}", word) : fmt::format("{}: {}", word, label));
}

}  // namespace limn
