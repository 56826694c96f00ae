#include "render/material/acos_table.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

// Techniques: engine.opt-lut

namespace limn {

std::vector<Vec2> make_acos_table(int size) {
    std::vector<Vec2> table;
    for (int row = 0; row < size; ++row) {
        const double y = 2.0 * row / (size - 1) - 1;
        const double reach = std::sqrt(std::max(1 - y * y, 0.0));  // of x
        for (int column = 0; column < size; ++column) {
            const double x = 2.0 * column / (size - 1) - 1;
            const double quotient = reach > 0 ? x / reach : x < 0 ? -1 : x > 0 ? 1 : 0;
            table.emplace_back(
                std::acos(std::clamp(quotient, -1.0, 1.0)), std::acos(std::clamp(y, -1.0, 1.0)));
        }
    }
    return table;
}

Vec2 sample_acos_table(const std::vector<Vec2>& table, int size, float x, float y) {
    const auto last = static_cast<float>(size - 1);
    const Vec2 at = glm::clamp((Vec2(x, y) * 0.5f + 0.5f) * last, Vec2(0), Vec2(last));
    const Vec2 low = glm::min(glm::floor(at), Vec2(last - 1));
    const Vec2 part = at - low;
    const std::size_t row = static_cast<std::size_t>(size);
    const std::size_t first =
        static_cast<std::size_t>(low.y) * row + static_cast<std::size_t>(low.x);
    return glm::mix(
        glm::mix(table[first], table[first + 1], part.x),
        glm::mix(table[first + row], table[first + row + 1], part.x), part.y);
}

}  // namespace limn
