#pragma once

#include <utility>

namespace limn {

/// Detects when a button that is polled every frame goes down.
class PressEdge {
  public:
    [[nodiscard]] bool begins(bool down) {
        const bool was_down = std::exchange(was_down_, down);
        return down && !was_down;
    }

  private:
    bool was_down_ = false;
};

}  // namespace limn
