#include "content/app/player/typing_queue.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace limn::typing_queue_test {
namespace {

constexpr int kEnter = GLFW_KEY_ENTER;
constexpr int kBack = GLFW_KEY_BACKSPACE;
constexpr int kControl = GLFW_KEY_LEFT_CONTROL;

constexpr TypingEvent press(int key) {
    return {.key = key, .down = true};
}
constexpr TypingEvent release(int key) {
    return {.key = key, .down = false};
}
constexpr TypingEvent text(char character) {
    return {.character = static_cast<unsigned>(character)};
}

std::string name_of(int key) {
    return key == kEnter     ? "Enter"
           : key == kBack    ? "Back"
           : key == kControl ? "Ctrl"
                             : std::string(1, static_cast<char>(key));
}

/// The frames in which it is shown: "+A" a key goes down, "-A" up, "'a" a character.
std::vector<std::string> frames_of(TypingQueue& queue, const std::vector<TypingEvent>& events) {
    for (const TypingEvent& event : events) {
        queue.add(event);
    }
    std::vector<std::string> frames;
    for (std::vector<TypingEvent> frame; !(frame = queue.take_frame()).empty();) {
        std::string& shown = frames.emplace_back();
        for (const TypingEvent& event : frame) {
            shown += event.key < 0 ? std::string("'") + static_cast<char>(event.character)
                                   : (event.down ? "+" : "-") + name_of(event.key);
        }
    }
    return frames;
}

using Frames = std::vector<std::string>;

}  // namespace

TEST_CASE("typing queue: a key pressed and released within a frame is down for one frame") {
    TypingQueue queue;
    CHECK(frames_of(queue, {press(kEnter), release(kEnter)}) == Frames{"+Enter", "-Enter"});
    CHECK(
        frames_of(queue, {press(kBack), release(kBack), press(kBack), release(kBack)})
        == Frames{"+Back", "-Back", "+Back", "-Back"});
    CHECK(frames_of(queue, {press(kControl), release(kControl)}) == Frames{"+Ctrl", "-Ctrl"});
    // Ctrl is still down when A is processed.
    CHECK(
        frames_of(queue, {press(kControl), press('A'), release('A'), release(kControl)})
        == Frames{"+Ctrl+A", "-A-Ctrl"});
}

TEST_CASE("typing queue: text typed after Backspace or Enter does not overtake it") {
    TypingQueue queue;
    CHECK(
        frames_of(
            queue, {press('5'), text('5'), release('5'), press(kBack), release(kBack), press('3'),
                    text('3'), release('3'), press(kEnter), release(kEnter)})
        == Frames{"+5'5-5+Back", "-Back+3'3-3+Enter", "-Enter"});
    // Nor while it is still down.
    CHECK(frames_of(queue, {press(kBack), press('3'), text('3')}) == Frames{"+Back", "+3'3"});
}

TEST_CASE("typing queue: plain text never waits, however much is typed in a frame") {
    TypingQueue queue;
    CHECK(
        frames_of(
            queue, {press('1'), text('1'), press('2'), text('2'), release('1'), release('2'),
                    press('2'), text('2')})
        == Frames{"+1'1+2'2-1-2+2'2"});
}

}  // namespace limn::typing_queue_test
