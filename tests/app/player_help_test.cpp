#include "content/app/player/play_command.h"
#include "content/app/player/player.h"
#include "content/app/player/player_help.h"
#include "content/game/game.h"
#include "ecs/components/rendering.h"
#include "ecs/components/weather.h"
#include "ecs/world.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace limn::player_help_test {
namespace {

/// The lines of the help.
std::vector<std::string> help(const HelpState& state, const World& world) {
    std::vector<std::string> lines;
    for (const KeyHelp& line : player_help(world, state, Player::keys())) {
        lines.push_back(line.keys + ": " + line.text);
    }
    return lines;
}
std::vector<std::string> help(const HelpState& state) {
    register_game_components();
    return help(state, World());
}

bool has(const std::vector<std::string>& lines, const char* begin) {
    return std::any_of(lines.begin(), lines.end(), [&](const std::string& line) {
        return line.starts_with(begin);
    });
}

}  // namespace

TEST_CASE(
    "player help: no two keys are the same, and each is listed or does what a listed one does") {
    std::set<std::pair<int, int>> presses;
    std::set<std::string> listed;
    for (const PlayerKey& key : Player::keys()) {
        CAPTURE(key.text);
        CHECK((key.act != nullptr) == (key.key != 0));
        if (key.act != nullptr) {
            CHECK(presses.insert({key.key, key.modifiers}).second);
            CHECK(find_key(Player::keys(), key.key, key.modifiers) == &key);
        }
        if (*key.label != '\0') {
            listed.insert(key.text);
        }
    }
    for (const PlayerKey& key : Player::keys()) {
        CHECK(listed.contains(key.text));
    }
}

TEST_CASE("player help: Shift changes a key only where it means something else, Ctrl always") {
    const auto text = [](int key, int modifiers) -> std::string {
        const PlayerKey* const found = find_key(Player::keys(), key, modifiers);
        return found != nullptr ? found->text : "";
    };
    CHECK(text(GLFW_KEY_F9, 0) == "screenshot as PNG");
    CHECK(text(GLFW_KEY_F9, GLFW_MOD_SHIFT) == "screenshot with status and panels");
    CHECK(text(GLFW_KEY_C, GLFW_MOD_SHIFT) == text(GLFW_KEY_C, 0));
    CHECK(text(GLFW_KEY_M, GLFW_MOD_CONTROL).empty());
    CHECK(text(GLFW_KEY_C, GLFW_MOD_CONTROL) != text(GLFW_KEY_C, 0));
    CHECK(text(GLFW_KEY_Z, 0).empty());
    CHECK(text(GLFW_KEY_Z, GLFW_MOD_CONTROL) == "undo");
    CHECK(text(GLFW_KEY_Z, GLFW_MOD_CONTROL | GLFW_MOD_SHIFT) == "redo");
    CHECK(text(GLFW_KEY_Y, GLFW_MOD_CONTROL) == "redo");
}

TEST_CASE("player help: it lists the keys of this state, and no others") {
    const std::vector<std::string> plain = help({});
    for (const char* always : {"Space: ", "Home: ", "C: ", "R: ", "F5: ", "Esc: ", "PgDn Tab: "}) {
        CAPTURE(always);
        CHECK(has(plain, always));
    }
    struct Case {
        const char* line;
        HelpState state;
    };
    const Case cases[] = {
        {"F7: ", {.show = true}},
        {"F12: ", {.paths = true}},
        {"M: ", {.model = true}},
        {"F: ", {.selected = true}},
        {"Ctrl Z: ", {.edited = true}},
        {"Ctrl Y: ", {.edited = true}},
        {"Right click: ", {.inspector = true}},
        {"Drag: a number", {.panel = true}},
        {"Drag: the skin", {.skin = true}},
        {"Drag: orbit", {.camera = CameraMode::Orbit}},
        {"Wheel: distance", {.camera = CameraMode::Orbit}},
        {"Wheel: fly", {.camera = CameraMode::Fly}},
        {"Click: select; throw", {.throws = true}}};
    for (const Case& one : cases) {
        CAPTURE(one.line);
        CHECK_FALSE(has(plain, one.line));
        CHECK(has(help(one.state), one.line));
    }
    CHECK_FALSE(has(help({.camera = CameraMode::Orbit}), "Drag: look"));
}

TEST_CASE("player help: actions are listed if the level uses them, and its own keys come first") {
    register_game_components();
    World world;
    CHECK_FALSE(has(help({}, world), "I K: wind"));
    world.insert_resource(Weather{});
    CHECK(has(help({}, world), "I K: wind"));
    world.insert_resource(Bindings{{{"cut", {"K"}, "cut the wall"}}});
    const std::vector<std::string> lines = help({}, world);
    CHECK(has(lines, "K: cut the wall"));
    CHECK(has(lines, "I: wind"));
    CHECK_FALSE(has(lines, "I K: wind"));
    world.resource<Bindings>() = {{{"all", {"I", "J", "K", "L", "O", "U"}, "everything"}}};
    CHECK_FALSE(has(help({}, world), ": Weather"));
}

TEST_CASE("play: frames are antialiased unless the player or the level says how") {
    register_game_components();
    const auto set = [](Antialiasing level, Antialiasing wanted) {
        World world;
        world.insert_resource(Rendering{.antialiasing = level});
        set_antialiasing(world, wanted);
        return world.resource<Rendering>().antialiasing;
    };
    CHECK(set(Antialiasing::Auto, Antialiasing::Auto) == Antialiasing::Temporal);
    CHECK(set(Antialiasing::None, Antialiasing::Auto) == Antialiasing::None);
    CHECK(set(Antialiasing::Temporal, Antialiasing::None) == Antialiasing::None);
    World world;
    set_antialiasing(world, Antialiasing::Auto);
    CHECK(world.resource<Rendering>().antialiasing == Antialiasing::Temporal);
}

}  // namespace limn::player_help_test
