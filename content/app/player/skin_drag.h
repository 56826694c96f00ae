#pragma once

#include "content/app/player/pick.h"
#include "content/app/player/press_edge.h"

namespace limn {

class World;

/// Whether the first mesh that the ray hits is skin that can be pulled: one with PullableSkin, or
/// one that follows it.
[[nodiscard]] bool is_pullable(const World& world, const Ray& ray);

/// A drag by the left button that begins on such skin: it pulls the skin, and moves no camera.
class SkinDrag {
  public:
    /// Call every frame; `left`: the button is down, `blocked`: over a panel.
    void follow(const World& world, const Ray& ray, bool left, bool blocked);
    [[nodiscard]] bool pulls() const { return pulls_; }

  private:
    PressEdge left_;
    bool pulls_ = false;
};

}  // namespace limn
