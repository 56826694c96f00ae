#include "ecs/components/input.h"

#include "ecs/components/camera_lens.h"
#include "ecs/components/motor.h"
#include "ecs/components/skin_pull.h"
#include "ecs/components/weather.h"
#include "ecs/world.h"

#include <algorithm>
#include <utility>

namespace limn {

namespace {

std::vector<ActionGroup>& groups() {
    static std::vector<ActionGroup> all;
    return all;
}

float value_in(const std::vector<ActionValue>& actions, std::string_view action) {
    for (const ActionValue& one : actions) {
        if (one.action == action) {
            return one.value;
        }
    }
    return 0.0f;
}

}  // namespace

float action_value(const Input& input, std::string_view action) {
    return value_in(input.actions, action);
}

bool is_pressed(const Input& input, std::string_view action) {
    return value_in(input.actions, action) > 0 && !(value_in(input.before, action) > 0);
}

bool is_released(const Input& input, std::string_view action) {
    return value_in(input.before, action) > 0 && !(value_in(input.actions, action) > 0);
}

float action_axis(const Input& input, std::string_view more, std::string_view less) {
    return action_value(input, more) - action_value(input, less);
}

void set_action(Input& input, std::string_view action, float value) {
    std::erase_if(input.actions, [&](const ActionValue& one) { return one.action == action; });
    if (value != 0.0f) {
        input.actions.push_back({std::string(action), value});
    }
}

void take_input(Input& input, const Input& frame) {
    std::vector<ActionValue> before = std::move(input.before);
    const bool waiting = input.click;
    input = frame;
    input.before = std::move(before);
    input.click = frame.click || waiting;
}

MoveInput camera_input(const Input& input) {
    return {
        {action_axis(input, "move_right", "move_left"), action_axis(input, "move_up", "move_down"),
         action_axis(input, "move_forward", "move_back")},
        input.look,
        input.zoom,
        action_value(input, "move_fast") > 0.0f};
}

void register_actions(ActionGroup group) {
    const bool is_known = std::any_of(groups().begin(), groups().end(), [&](const ActionGroup& g) {
        return g.title == group.title;
    });
    if (!is_known) {
        groups().push_back(std::move(group));
    }
}

void register_engine_actions() {
    register_actions(
        {"Move",
         {{"move_forward", "forward, back", {"W", "Up"}},
          {"move_back", "forward, back", {"S", "Down"}},
          {"move_left", "left, right", {"A", "Left"}},
          {"move_right", "left, right", {"D", "Right"}},
          {"move_down", "down, up", {"Q"}},
          {"move_up", "down, up", {"E"}},
          {"move_fast", "faster", {"Shift"}}},
         [](const World&, Entity) { return true; }});
    register_actions(
        {"Lens",
         {{"focus_nearer", "focus nearer, farther", {"["}},
          {"focus_farther", "focus nearer, farther", {"]"}},
          {"aperture_close", "close, open the aperture", {"-"}},
          {"aperture_open", "close, open the aperture", {"="}},
          {"shutter_shorter", "shutter: shorter, longer", {"9"}},
          {"shutter_longer", "shutter: shorter, longer", {"0"}}},
         [](const World& world, Entity) { return !world.query<const Lens>().empty(); }});
    register_actions(
        {"Hero",
         {{"hero_forward", "forward, back", {"W", "Up"}},
          {"hero_back", "forward, back", {"S", "Down"}},
          {"hero_left", "left, right; drag to look", {"A", "Left"}},
          {"hero_right", "left, right; drag to look", {"D", "Right"}},
          {"hero_run", "runs", {"Shift"}},
          {"hero_jump", "jumps; swims up", {"E", "Enter"}},
          {"hero_dive", "dives", {"Q"}},
          {"hero_carry", "picks up, throws", {"G"}}},
         [](const World& world, Entity camera) {
             bool found = false;
             world.query<const Hero>().each([&](const Hero& hero) {
                 found = found || hero.camera.is_null() || hero.camera == camera;
             });
             return found;
         },
         true,
         true});
    register_actions(
        {"Skin",
         {{"pull_skin", "pull the skin under the pointer, as dragging it does", {"P"}}},
         [](const World& world, Entity) { return !world.query<const PullableSkin>().empty(); }});
    register_actions(
        {"Weather",
         {{"wind_stronger", "wind: stronger, weaker", {"I"}},
          {"wind_weaker", "wind: stronger, weaker", {"K"}},
          {"wind_back", "wind: backs, veers", {"J"}},
          {"wind_veer", "wind: backs, veers", {"L"}},
          {"rain_more", "more, less rain", {"O"}},
          {"rain_less", "more, less rain", {"U"}}},
         [](const World& world, Entity) { return world.find_resource<Weather>() != nullptr; }});
}

std::span<const ActionGroup> action_groups() {
    return groups();
}

std::vector<std::string_view> action_names() {
    std::vector<std::string_view> names;
    for (const ActionGroup& group : groups()) {
        for (const ActionInfo& action : group.actions) {
            names.emplace_back(action.name);
        }
    }
    return names;
}

std::span<const std::string> keys_of(const ActionInfo& action, const Bindings* level) {
    if (level != nullptr) {
        for (const Bindings::Binding& binding : level->bindings) {
            if (binding.action == action.name) {
                return binding.keys;
            }
        }
    }
    return action.keys;
}

const std::vector<std::string_view>& key_names() {
    static const std::vector<std::string_view> names = {
        "A", "B", "D",    "E",     "G",  "H",    "I",     "J",   "K",     "L",        "N", "O", "P",
        "Q", "S", "T",    "U",     "V",  "W",    "X",     "Y",   "Z",     "0",        "1", "2", "3",
        "4", "5", "6",    "7",     "8",  "9",    "-",     "=",   "[",     "]",        ";", "'", ",",
        "/", "`", "Left", "Right", "Up", "Down", "Shift", "Alt", "Enter", "Backspace"};
    return names;
}

}  // namespace limn
