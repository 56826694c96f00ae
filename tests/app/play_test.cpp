#include "tests/app/close_window.h"
#include "tests/app/virtual_display.h"
#include "tests/content/gltf_samples.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <filesystem>

// `limn play` as a player meets it: a window on a virtual display (Xvfb), real key presses
// (xdotool), and what the display shows, read from the memory of its screen.

namespace limn::play_test {

using test::can_play;
using test::count_different;
using test::first_line;
using test::Pixels;
using test::ProgramRun;
using test::read_png;
using test::sleep_ms;
using test::TemporaryFolder;
using test::wait_for;
using test::xdotool;

namespace {

/// Small enough that a processor draws it quickly. The spinning box shows whether time passes.
constexpr const char* kLevel = R"({
  "title": "A box to play with",
  "resources": {"environment": {"sky": "gradient"}},
  "materials": {"red": {"base_color": [0.8, 0.1, 0.05], "roughness": 0.4}},
  "meshes": {"box": {"make": "box", "size": [1, 1, 1]}},
  "entities": [
    {"name": "box", "mesh_instance": {"mesh": "box", "material": "red"}, "spin": {"axis": [0, 1, 0], "speed": 2}},
    {"name": "sun", "transform": {"rotation": [-40, -50, 0]}, "directional_light": {"illuminance": 3}},
    {"name": "eye", "transform": {"position": [0, 0.6, 3], "rotation": [0, -10, 0]}, "camera": {}}
  ]
})";

/// A racer to drive, viewed by a fixed camera.
constexpr const char* kRace = R"({
  "title": "A box to drive",
  "resources": {"environment": {"sky": "gradient"}},
  "paths": {"way": {"knots": [{"position": [-50, 0, 0]}, {"position": [50, 0, 0]}]}},
  "materials": {"red": {"base_color": [0.8, 0.1, 0.05], "roughness": 0.4}},
  "meshes": {"box": {"make": "box", "size": [1, 1, 1]}},
  "entities": [
    {"name": "car", "transform": {}, "mesh_instance": {"mesh": "box", "material": "red"},
      "racer": {"track": "way", "distance": 48, "player": true, "speed": 0}},
    {"name": "eye", "transform": {"position": [0, 0.6, 5]}, "camera": {}}
  ]
})";

/// A ball that a show takes away.
constexpr const char* kShow = R"({
  "title": "A ball to show",
  "resources": {"environment": {"sky": "uniform", "zenith": [0.2, 0.3, 0.4]}},
  "materials": {"red": {"base_color": [0.8, 0.1, 0.05]}},
  "meshes": {"ball": {"make": "sphere", "radius": 1}},
  "entities": [
    {"name": "ball", "mesh_instance": {"mesh": "ball", "material": "red"}},
    {"name": "eye", "transform": {"position": [0, 0, 5]}, "camera": {}}
  ],
  "shows": [{"technique": "a.ball", "text": "A ball.", "off": {"entities": {"ball": null}}}]
})";

/// The level in a window that fills the display.
struct PlaySession : test::DisplaySession {
    void start(const char* level = kLevel, const std::vector<std::string>& options = {}) {
        test::write_text(folder.file("toy.level.json"), level);
        std::vector<std::string> arguments = {"play", "toy.level.json", "--scale",
                                              "0.5",  "--antialiasing", "none"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        DisplaySession::start(arguments);
    }
    /// Esc until it asks, then yes.
    void quit() {
        CHECK(wait_for([&] {
            if (program->running()) {
                xdotool("key Escape sleep 0.3 key Return sleep 0.3");
            }
            return !program->running();
        }));
    }
};

/// Whether the pixel is rather red than blue.
bool is_red(const Pixels& image, int x, int y) {
    const std::size_t at = static_cast<std::size_t>(y * image.width + x) * 3;
    return image.bytes[at] > image.bytes[at + 2];
}

}  // namespace

TEST_CASE("play: keys move the camera and open the inspector, and F9 saves what is shown") {
    if (!can_play()) {
        return;
    }
    PlaySession session;
    session.start();

    xdotool("search --name '^toy - Limn$'");  // the window's title; fails where there is none

    // Time passes until Space stops it. F8 hides the status, whose numbers never rest.
    xdotool("key F8");
    const Pixels first = session.display.grab();
    CHECK(session.changes_from(first, 500));
    xdotool("key space");
    const Pixels paused = session.wait_until_still();

    // W flies nearer: the box grows.
    xdotool("keydown w sleep 0.5 keyup w");
    CHECK(session.changes_from(paused, 2000));
    const Pixels moved = session.wait_until_still();
    // Home brings the level's camera back.
    xdotool("key Home");
    CHECK(session.changes_from(moved, 2000));
    // Its message is shown for some seconds, then the picture is as before.
    CHECK(wait_for([&] { return count_different(session.display.grab(), paused) == 0; }));

    // The inspector covers the right side.
    xdotool("key F2");
    CHECK(session.changes_from(paused, 20000));
    const Pixels inspected = session.wait_until_still();

    xdotool("key shift+F9");
    REQUIRE(wait_for([&] { return !first_line(session.folder).empty(); }));
    const std::string first_file = first_line(session.folder);
    const Pixels saved = read_png(session.folder.file(first_file));
    CHECK(saved.width == test::kDisplayWidth);
    CHECK(saved.height == test::kDisplayHeight);
    CHECK(count_different(saved, inspected) == 0);
    // Without Shift, without the panels.
    xdotool("key F9");
    const std::string second_file = "limn-toy-0002.png";
    REQUIRE(first_file == "limn-toy-0001.png");
    REQUIRE(wait_for(
        [&] { return count_different(read_png(session.folder.file(second_file)), paused) == 0; }));

    // F2 closes the inspector; a click selects the box, F frames it.
    xdotool("key F2 mousemove 320 200 sleep 0.5 click 1 sleep 0.5 key f");
    CHECK(session.changes_from(paused, 2000));
    xdotool("mousemove 20 20 key Home");
    CHECK(wait_for([&] { return count_different(session.display.grab(), paused) == 0; }));
    // Full screen and back: the window is as large as the display already.
    for (int i = 0; i < 2; ++i) {
        xdotool("key F11 sleep 1");
        CHECK(session.program->running());
        CHECK(wait_for([&] { return count_different(session.display.grab(), paused) < 2000; }));
    }

    session.quit();
    CHECK(session.program->wait().exit_code == 0);
}

TEST_CASE("play: Esc closes panel after panel, then asks; leaving with edits asks until undone") {
    if (!can_play()) {
        return;
    }
    PlaySession session;
    session.start();
    xdotool("sleep 1 key F8 key space");  // in the midst of a turn of the box
    const Pixels level = session.wait_until_still();
    xdotool("key F1");
    REQUIRE(session.changes_from(level, 20000));
    const Pixels help = session.wait_until_still();
    xdotool("mousemove 320 200 click 5 click 5 click 5");  // it is longer than the window
    CHECK(session.changes_from(help, 2000));
    xdotool("key Escape");
    CHECK(count_different(session.wait_until_still(), level) == 0);
    xdotool("key Escape");
    CHECK(session.changes_from(level, 20000));  // Quit?
    xdotool("key Escape");
    CHECK(count_different(session.wait_until_still(), level) == 0);

    // Esc takes the menu of a heading away, then the panel.
    xdotool("key F2 mousemove 260 190 sleep 0.3 click 1 mousemove 20 20");
    const Pixels inspected = session.wait_until_still();
    xdotool("mousemove 380 237 sleep 0.3 click 3 mousemove 20 20");
    CHECK(session.changes_from(inspected, 500));
    xdotool("key Escape");
    CHECK(count_different(session.wait_until_still(), inspected) == 0);
    xdotool("key Escape");
    CHECK(count_different(session.wait_until_still(), level) == 0);

    // Select the box and drag the last number of its scale.
    xdotool("key F2 mousemove 260 190 sleep 0.3 click 1");
    const Pixels selected = session.wait_until_still();
    xdotool("mousemove 581 291 sleep 0.3 mousedown 1 sleep 0.3 mousemove_relative 30 0 sleep 0.3 "
            "mouseup 1");
    CHECK(session.changes_from(selected, 50));
    xdotool("mousemove 20 20 key F2");
    const Pixels edited = session.wait_until_still();
    CHECK(count_different(edited, level) > 500);  // shown although time stands still
    for (const char* key : {"Next", "Prior", "Tab", "r"}) {
        CAPTURE(key);
        xdotool(std::string("key ") + key);
        CHECK(session.changes_from(edited, 20000));  // Leave?
        xdotool("key Escape");
        CHECK(count_different(session.wait_until_still(), edited) == 0);
    }
    // A show of another level, in the list.
    xdotool("key F6");
    const Pixels list = session.wait_until_still();
    xdotool("mousemove 360 90 sleep 0.3 click 1");
    CHECK(session.changes_from(list, 20000));
    xdotool("key Escape sleep 0.3 mousemove 20 20 key Escape");
    CHECK(count_different(session.wait_until_still(), edited) == 0);
    // The button of the window.
    REQUIRE(test::close_window(session.display.name()));
    CHECK(session.changes_from(edited, 20000));
    xdotool("key Escape");
    CHECK(count_different(session.wait_until_still(), edited) == 0);

    xdotool("key ctrl+z");
    CHECK(wait_for([&] { return count_different(session.display.grab(), level) == 0; }));

    // Typed within a frame or two: what is wrong is taken back, and Enter counts. GLFW drops a
    // second press of a key within the same millisecond.
    xdotool("key F2 mousemove 581 291 sleep 0.5 keydown ctrl click 1 keyup ctrl sleep 0.5 "
            "key --delay 3 ctrl+a 9 9 BackSpace BackSpace 3 Return sleep 0.5");
    xdotool("mousemove 20 20 key F2");
    const Pixels typed = session.wait_until_still();
    CHECK(count_different(typed, level) > 500);
    // The same, typed slowly.
    xdotool("key ctrl+z key F2 mousemove 581 291 sleep 0.5 keydown ctrl click 1 keyup ctrl sleep "
            "0.5 key ctrl+a sleep 0.3 key 3 sleep 0.3 key Return sleep 0.5");
    xdotool("mousemove 20 20 key F2");
    CHECK(wait_for([&] { return count_different(session.display.grab(), typed) == 0; }));
    xdotool("key ctrl+z key r sleep 3");  // nothing to lose: the level restarts, and time passes
    CHECK(session.changes_from(session.display.grab(), 500));
    session.quit();
    CHECK(session.program->wait().exit_code == 0);
}

TEST_CASE(
    "play: edits while paused show at once, without the previous color"
    * technique("engine.main-loop")) {
    if (!can_play()) {
        return;
    }
    PlaySession session;
    const auto write_level = [&](const char* light) {
        test::write_text(
            session.folder.file("toy.level.json"), std::string(R"({
              "resources": {"environment": {"sky": "uniform", "zenith": [0, 0, 0]}},
              "images": {"squares": {"make": "checker", "size": 64, "cells": 64,
                "color_a": [1, 1, 1], "color_b": [0, 0, 0], "roughness": 1}},
              "materials": {"squares": {"pattern": "squares"}},
              "meshes": {"wall": {"make": "box", "size": [4, 4, 0.1]}},
              "entities": [
                {"name": "wall", "mesh_instance": {"mesh": "wall", "material": "squares"}},
                {"name": "sun", "directional_light": {"illuminance": 8, "color": )")
                                                       + light + R"(}},
                {"name": "eye", "transform": {"position": [0, 0, 5]}, "camera": {}}
              ]
            })");
    };
    write_level("[1, 0, 0]");
    session.DisplaySession::start({"play", "toy.level.json", "--scale", "0.5"});
    xdotool("key F8 key space");
    sleep_ms(3000);  // until a frame has little weight in the mean of many
    write_level("[0, 0, 1]");
    int purple = 0;
    int blue = 0;
    CHECK(wait_for([&] {
        for (int i = 0; i < 20; ++i) {
            const Pixels image = session.display.grab();
            const auto* const middle =
                &image.bytes[static_cast<std::size_t>(3 * image.width * (image.height + 1) / 2)];
            purple += middle[0] > 20 && middle[2] > 20 ? 1 : 0;
            blue += middle[0] <= 20 && middle[2] > 100 ? 1 : 0;
        }
        return blue > 50;
    }));
    CHECK(purple == 0);
    session.quit();
}

TEST_CASE("play: while driving, the keys move the car and not the camera") {
    if (!can_play()) {
        return;
    }
    PlaySession session;
    session.start(kRace);
    xdotool("key F8 key space sleep 6");  // until the message of what the keys do is gone
    const Pixels start = session.wait_until_still();
    // While time stands, nothing moves; a camera would fly.
    xdotool("keydown w sleep 0.5 keyup w");
    CHECK(count_different(session.wait_until_still(), start) == 0);
    // F12 draws the track and its knots.
    xdotool("key F12");
    CHECK(session.changes_from(start, 500));
    xdotool("key F12");
    CHECK(count_different(session.wait_until_still(), start) == 0);
    // C hands the keys to the camera.
    xdotool("key c keydown w sleep 0.5 keyup w");
    CHECK(session.changes_from(start, 2000));
    session.quit();
}

TEST_CASE("play: effects follow their file, and a broken one is reported and changes nothing") {
    if (!can_play()) {
        return;
    }
    PlaySession session;
    const auto write_effect = [&](const char* rate) {
        test::write_text(
            session.folder.file("a.effect.json"),
            std::string(R"({"prefabs": {"puffs": {"particle_emitter": {"rate": )") + rate
                + R"(, "speed": 0, "life": 60}}}})");
    };
    write_effect("0");
    session.start(R"({
      "include": ["a.effect.json"],
      "resources": {"environment": {"sky": "uniform", "zenith": [0.1, 0.1, 0.1]}},
      "entities": [
        {"name": "puffs", "prefab": "puffs", "particle_motion": {"gravity": 0},
          "particle_look": {"size": 0.5, "emission": 3}},
        {"name": "eye", "transform": {"position": [0, 0, 4]}, "camera": {}}
      ]
    })");
    xdotool("key F8");
    const Pixels empty = session.wait_until_still();
    // An error is told, once, and the level goes on; a number that is right again counts.
    write_effect("-5");
    const auto errors = [&] { return session.program->error_text(); };
    CHECK(wait_for([&] { return errors().find("a.effect.json:1:") != std::string::npos; }));
    CHECK(errors().find("rate: found the number -5") != std::string::npos);
    sleep_ms(1500);
    CHECK(errors().find("a.effect.json:1:") == errors().rfind("a.effect.json:1:"));
    write_effect("50");
    CHECK(session.changes_from(empty, 5000));
    session.quit();
    CHECK(session.program->wait().exit_code == 0);
}

TEST_CASE("play: F7 shows a technique with, without and side by side, F6 lists them all") {
    if (!can_play()) {
        return;
    }
    PlaySession session;
    session.start(kShow, {"--show", "a.ball"});
    xdotool("key F8");
    const Pixels with = session.wait_until_still();
    const int left = test::kDisplayWidth / 2 - 40;
    const int right = test::kDisplayWidth / 2 + 40;
    const int center_row = test::kDisplayHeight / 2;
    CHECK(is_red(with, left, center_row));
    CHECK(is_red(with, right, center_row));
    xdotool("key F7");
    REQUIRE(session.changes_from(with, 2000));
    const Pixels without = session.wait_until_still();
    CHECK_FALSE(is_red(without, left, center_row));
    CHECK_FALSE(is_red(without, right, center_row));
    xdotool("key F7");
    REQUIRE(session.changes_from(without, 2000));
    const Pixels both = session.wait_until_still();
    CHECK_FALSE(is_red(both, left, center_row));
    CHECK(is_red(both, right, center_row));
    xdotool("key F6");
    CHECK(session.changes_from(both, 20000));
    session.quit();
    CHECK(session.program->wait().exit_code == 0);
}

TEST_CASE("play: a drag looks around, and the level comes back with R") {
    if (!can_play()) {
        return;
    }
    PlaySession session;
    session.start();
    xdotool("key F8 key space");
    const Pixels start = session.wait_until_still();
    xdotool("mousemove 320 200 mousedown 1 sleep 0.5 mousemove_relative 60 0 sleep 0.3 "
            "mousemove_relative "
            "60 0 sleep 0.3 mouseup 1");
    CHECK(session.changes_from(start, 5000));
    xdotool("key F3");  // the profiler opens without harm
    sleep_ms(500);
    xdotool("key F3 key r");
    session.quit();
    const ProgramRun run = session.program->wait();
    CHECK(run.exit_code == 0);
    CHECK(run.err.find("error") == std::string::npos);
}

TEST_CASE("play: a model orbits with a drag, pans with a right drag, zooms with the wheel") {
    if (!can_play()) {
        return;
    }
    PlaySession session;
    const std::vector<std::byte> glb = test::square_glb();
    test::write_text(
        session.folder.file("square.glb"),
        std::string(reinterpret_cast<const char*>(glb.data()), glb.size()));
    session.DisplaySession::start(
        {"play", "square.glb", "--scale", "0.5", "--antialiasing", "none"});
    xdotool("key F8 mousemove 320 200");
    const Pixels framed = session.wait_until_still();
    xdotool("mousedown 1 sleep 0.5 mousemove_relative 40 0 sleep 0.3 mousemove_relative 40 0 sleep "
            "0.3 mouseup 1");
    CHECK(session.changes_from(framed, 2000));
    const Pixels turned = session.wait_until_still();
    xdotool("mousedown 3 sleep 0.5 mousemove_relative 40 30 sleep 0.3 mousemove_relative 40 30 "
            "sleep 0.3 mouseup 3");
    CHECK(session.changes_from(turned, 2000));
    const Pixels moved = session.wait_until_still();
    xdotool("click 5 click 5 click 5");
    CHECK(session.changes_from(moved, 2000));
    const Pixels far = session.wait_until_still();
    xdotool("click --repeat 2 --delay 60 1");  // centers what is under the pointer
    CHECK(session.changes_from(far, 1000));
    session.quit();
    CHECK(session.program->wait().exit_code == 0);
}

TEST_CASE("play: without a display it renders the camera path and says where the images are") {
    const TemporaryFolder folder;
    test::write_text(folder.file("toy.level.json"), kLevel);
    const char* display = std::getenv("DISPLAY");
    const std::string saved = display != nullptr ? display : "";
    unsetenv("DISPLAY");
    const ProgramRun run =
        test::run_limn(folder, {"play", "toy.level.json", "--size", "96x54", "-o", "pictures"});
    if (!saved.empty()) {
        setenv("DISPLAY", saved.c_str(), 1);
    }
    CHECK(run.exit_code == 0);
    CHECK(run.out.find("no display") != std::string::npos);
    CHECK(run.out.find("pictures") != std::string::npos);
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.file("pictures"))) {
        CHECK(read_png(entry.path().string()).width >= 0);
        ++count;
    }
    CHECK(count == 8);
}

}  // namespace limn::play_test
