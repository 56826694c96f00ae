#pragma once

#include "ecs/base/math.h"

#include <optional>
#include <vector>

namespace limn {

/// Places for labels beside points of the screen, so that no label covers another: the first one
/// asked for is the most important.
class LabelLayout {
  public:
    /// Labels of points left of `middle` [pixels] prefer their left side, others their right.
    explicit LabelLayout(float middle = 0) : middle_(middle) {}

    /// Top left corner of a label of this size [pixels], `gap` beside, above or below of `point`;
    /// none where all four are taken.
    [[nodiscard]] std::optional<Vec2> place(const Vec2& point, const Vec2& size, float gap);

  private:
    struct Box {
        Vec2 min;
        Vec2 max;
    };
    float middle_;
    std::vector<Box> taken_{};
};

}  // namespace limn
