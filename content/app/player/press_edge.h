#pragma once

#include <utility>

namespace limn {

/// Tells when a button goes down, of one that is looked at in every frame.
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
