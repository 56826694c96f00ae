#include "content/app/player/label_layout.h"

#include <algorithm>

namespace limn {

std::optional<Vec2> LabelLayout::place(const Vec2& point, const Vec2& size, float gap) {
    const Vec2 right = point + Vec2(gap, -0.5f * size.y);
    const Vec2 left = point + Vec2(-gap - size.x, -0.5f * size.y);
    const bool is_left = point.x < middle_;
    const Vec2 corners[] = {
        is_left ? left : right, is_left ? right : left, point + Vec2(-0.5f * size.x, -gap - size.y),
        point + Vec2(-0.5f * size.x, gap)};
    for (const Vec2& corner : corners) {
        const Box box = {corner, corner + size};
        const bool is_free = std::ranges::none_of(taken_, [&](const Box& other) {
            return box.min.x < other.max.x && other.min.x < box.max.x && box.min.y < other.max.y
                   && other.min.y < box.max.y;
        });
        if (is_free) {
            taken_.push_back(box);
            return corner;
        }
    }
    return std::nullopt;
}

}  // namespace limn
