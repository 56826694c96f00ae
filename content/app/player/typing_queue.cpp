#include "content/app/player/typing_queue.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <cstddef>

namespace limn {
namespace {

bool is_modifier(int key) {
    return key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER;
}

/// Whether it does something other than type a character: Enter, Backspace, Ctrl A ...
bool is_command(int key, const std::set<int>& down) {
    const bool control =
        down.contains(GLFW_KEY_LEFT_CONTROL) || down.contains(GLFW_KEY_RIGHT_CONTROL);
    return !is_modifier(key) && (control || key >= GLFW_KEY_ESCAPE);
}

}  // namespace

std::vector<TypingEvent> TypingQueue::take_frame() {
    std::set<int> changed;   // keys in this frame
    bool commanded = false;  // panels read characters before keys, so nothing may follow
    std::size_t taken = 0;
    for (; taken < waiting_.size() && !commanded; ++taken) {
        const TypingEvent& event = waiting_[taken];
        if (event.key < 0) {
            continue;
        }
        const bool types = !is_modifier(event.key) && !is_command(event.key, down_);
        if (!changed.insert(event.key).second && !types) {
            break;
        }
        if (event.down) {
            down_.insert(event.key);
        } else {
            down_.erase(event.key);
        }
        commanded = event.down && is_command(event.key, down_);
    }
    const auto end = waiting_.begin() + static_cast<std::ptrdiff_t>(taken);
    std::vector<TypingEvent> frame(waiting_.begin(), end);
    waiting_.erase(waiting_.begin(), end);
    return frame;
}

}  // namespace limn
