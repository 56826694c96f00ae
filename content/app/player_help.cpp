#include "content/app/player_help.h"

#include "content/game/stones.h"
#include "ecs/components/camera_path.h"
#include "ecs/components/input.h"
#include "ecs/components/surface.h"
#include "ecs/world.h"

#include <span>
#include <utility>

namespace limn {
namespace {

/// The actions of a group; neighbors with the same meaning share a line.
void add_group(const ActionGroup& group, const Bindings* bindings, std::vector<KeyHelp>& lines) {
    lines.push_back({"", group.title});
    const ActionInfo* last = nullptr;
    for (const ActionInfo& action : group.actions) {
        const std::span<const std::string> keys = keys_of(action, bindings);
        if (keys.empty()) {
            continue;
        }
        if (last != nullptr && last->doc == action.doc) {
            lines.back().keys += " " + keys.front();
        } else {
            lines.push_back({keys.front(), action.doc});
        }
        last = &action;
    }
}

/// The keys of the level's events.
void add_events(const Bindings* bindings, std::vector<KeyHelp>& lines) {
    bool first = true;
    for (const Bindings::Binding& binding :
         bindings != nullptr ? bindings->bindings : std::vector<Bindings::Binding>{}) {
        if (!binding.text.empty() && !binding.keys.empty()) {
            if (std::exchange(first, false)) {
                lines.push_back({"", "This level"});
            }
            lines.push_back({binding.keys.front(), binding.text});
        }
    }
}

void add_camera(const HelpState& state, std::vector<KeyHelp>& lines) {
    lines.push_back({"", "Camera"});
    if (state.camera == CameraMode::Orbit || state.model) {
        lines.push_back({"Drag", "circle the target"});
        lines.push_back({"Right drag", "move sideways"});
        lines.push_back({"Wheel", "distance"});
    } else {
        lines.push_back({"Drag", "look around"});
        if (state.camera == CameraMode::Fly) {
            lines.push_back({"Wheel", "fly slower, faster"});
        }
    }
    lines.push_back({"Double-click", "circle what is under the pointer"});
    lines.push_back({"Home", "back to the level's camera"});
    lines.push_back({"C", "next camera: those of the level, fly, orbit"});
}

}  // namespace

const ActionGroup* driving_group(const World& world, Entity camera) {
    for (const ActionGroup& group : action_groups()) {
        if (group.drives && group.is_used(world, camera)) {
            return &group;
        }
    }
    return nullptr;
}

std::vector<KeyHelp> player_help(const World& world, const HelpState& state) {
    std::vector<KeyHelp> lines;
    const auto* bindings = world.find_resource<Bindings>();
    for (const ActionGroup& group : action_groups()) {
        // While the keys drive something, they do not move the camera.
        const bool moves_camera = !group.drives && group.title == "Move";
        const bool driven = state.drives && state.camera == CameraMode::Level;
        if (group.is_used(world, state.level_camera) && !(driven && moves_camera)
            && !(group.drives && state.camera != CameraMode::Level)) {
            add_group(group, bindings, lines);
        }
    }
    add_events(bindings, lines);
    add_camera(state, lines);
    lines.push_back({"", "Time and levels"});
    lines.push_back({"Space", "pause, resume"});
    lines.push_back({".", "one step"});
    lines.push_back({"R", "reload the level from its file"});
    lines.push_back({"PgUp PgDn", "previous, next level (Tab too)"});
    lines.push_back({"", "Panels"});
    if (state.model) {
        lines.push_back({"M", "clips, morph targets and cameras of the model"});
    }
    lines.push_back({"F1", "these keys"});
    lines.push_back({"F2", "inspector: every entity and component"});
    lines.push_back({"F3", "profiler of systems and passes"});
    lines.push_back({"F4", "intermediate textures of the frame"});
    lines.push_back({"F6", "techniques that levels show, each with and without"});
    const auto* assets = world.find_resource<Assets>();
    if ((assets != nullptr && !assets->paths.empty()) || !world.query<const CameraPath>().empty()) {
        lines.push_back({"F12", "paths with their knots, cameras' with their times"});
    }
    if (state.show) {
        lines.push_back({"F7", "the technique on, off, side by side"});
    }
    if (state.panel) {
        lines.push_back({"Drag", "a number in a panel; Ctrl click to type it"});
    }
    lines.push_back({"", "Edit"});
    const bool throws = !world.query<const StoneThrower>().empty();
    lines.push_back(
        {"Click", throws ? "select; throw a stone into the water" : "select what is under it"});
    if (state.inspector) {
        lines.push_back({"F", "circle the selection"});
    }
    lines.push_back({"Ctrl Z", "undo"});
    lines.push_back({"Ctrl Y", "redo"});
    lines.push_back({"", "Program"});
    lines.push_back({"F5", "reload the shaders (changed files reload by themselves)"});
    lines.push_back({"F8", "hide the status"});
    lines.push_back({"F9", "screenshot as PNG; with Shift: panels, too"});
    lines.push_back({"F10", "HDR image with all layers as EXR"});
    lines.push_back({"F11", "full screen"});
    lines.push_back({"Esc", "close the popup, the panel; then quit"});
    return lines;
}

std::string describe_group(const ActionGroup& group, const Bindings* bindings) {
    std::vector<KeyHelp> lines;
    add_group(group, bindings, lines);
    std::string text;
    for (const KeyHelp& line : lines) {
        text += line.keys.empty()
                    ? line.text + ":"
                    : (text.ends_with(':') ? " " : "; ") + line.keys + ' ' + line.text;
    }
    return text;
}

}  // namespace limn
