#pragma once

#include <set>
#include <vector>

namespace limn {

// Keys and characters on their way to panels, which look at the keys once a frame. However long a
// frame takes, nothing is lost and the order is kept: a press of Enter, Backspace, Ctrl A ... lasts
// at least one frame, and what follows it waits for the next one. Plain text never waits.

/// A key goes down or up, or a character is typed.
struct TypingEvent {
    int key = -1;            ///< GLFW's code; -1: a character
    bool down = false;       ///< of the key
    unsigned character = 0;  ///< Unicode
};

class TypingQueue {
  public:
    void add(const TypingEvent& event) { waiting_.push_back(event); }
    /// What the next frame sees, in order.
    [[nodiscard]] std::vector<TypingEvent> take_frame();

  private:
    std::vector<TypingEvent> waiting_;
    std::set<int> down_;  ///< keys
};

}  // namespace limn
