#include "content/app/player/player_help.h"

#include "ecs/components/input.h"
#include "ecs/world.h"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace limn {
namespace {

/// The actions of a group; neighbors with the same meaning share a line.
void add_group(const ActionGroup& group, const Bindings* bindings, std::vector<KeyHelp>& lines) {
    const std::size_t first = lines.size();
    const ActionInfo* last = nullptr;
    for (const ActionInfo& action : group.actions) {
        const std::vector<std::string> keys = free_keys(action, bindings);
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
    if (lines.size() > first) {
        lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(first), KeyHelp{"", group.title});
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

/// Keys of the window that are usable now.
void add_help_keys(
    std::span<const PlayerKey> keys, const HelpState& state, std::vector<KeyHelp>& lines) {
    std::string_view heading;
    const PlayerKey* last = nullptr;
    for (const PlayerKey& key : keys) {
        if (*key.label == '\0' || (key.shown != nullptr && !key.shown(state))) {
            continue;
        }
        if (std::exchange(heading, key.heading) != key.heading) {
            lines.push_back({"", key.heading});
        } else if (last != nullptr && last->text == std::string_view(key.text)) {
            lines.back().keys += std::string(" ") + key.label;
            continue;
        }
        lines.push_back({key.label, key.text});
        last = &key;
    }
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

const PlayerKey* find_key(std::span<const PlayerKey> keys, int key, int modifiers) {
    const PlayerKey* found = nullptr;
    for (const PlayerKey& row : keys) {
        const int missing = row.modifiers & ~modifiers;
        const int other = (row.modifiers ^ modifiers) & GLFW_MOD_CONTROL;
        if (row.key == key && row.act != nullptr && missing == 0 && other == 0
            && (found == nullptr || row.modifiers > found->modifiers)) {
            found = &row;
        }
    }
    return found;
}

std::vector<std::string> free_keys(const ActionInfo& action, const Bindings* bindings) {
    const std::span<const std::string> bound = keys_of(action, bindings);
    std::vector<std::string> keys(bound.begin(), bound.end());
    if (bindings != nullptr) {
        for (const Bindings::Binding& binding : bindings->bindings) {
            if (!binding.text.empty() && binding.action != action.name) {
                std::erase_if(keys, [&](const std::string& key) {
                    return std::find(binding.keys.begin(), binding.keys.end(), key)
                           != binding.keys.end();
                });
            }
        }
    }
    return keys;
}

std::vector<KeyHelp>
player_help(const World& world, const HelpState& state, std::span<const PlayerKey> keys) {
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
    add_help_keys(keys, state, lines);
    return lines;
}

std::string describe_group(const ActionGroup& group, const Bindings* bindings) {
    std::vector<KeyHelp> lines;
    add_group(group, bindings, lines);
    std::string text;
    for (const KeyHelp& line : lines) {
        text += line.keys.empty()
                    ? line.text + ":"
                    : (text.ends_with(':') ? " " : " \u00b7 ") + line.keys + ' ' + line.text;
    }
    return text;
}

}  // namespace limn
