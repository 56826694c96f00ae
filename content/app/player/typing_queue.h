#pragma once

#include <set>
#include <vector>

namespace limn {

// Queues keys and characters for panels, which poll the keys once per frame. However long a
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
    /// Input of the next frame, in order.
    [[nodiscard]] std::vector<TypingEvent> take_frame();

  private:
    std::vector<TypingEvent> waiting_;
    std::set<int> down_;  ///< keys
};

}  // namespace limn
