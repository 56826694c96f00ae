#include "content/bake/wrinkle_map.h"

#include "ecs/base/math.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace limn {

int limit_wrinkle_map(ImageData& map, float most) {
    if (map.format != PixelFormat::Rgba8) {
        return 0;
    }
    constexpr float kUnit = 127;
    int beyond = 0;
    const auto texels = static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
    for (std::size_t i = 0; i < std::min(texels, map.pixels.size() / 4); ++i) {
        const Vec2 xy = Vec2(map.pixels[4 * i] - 128, map.pixels[4 * i + 1] - 128) / kUnit;
        const float length2 = glm::dot(xy, xy);
        if (length2 <= most) {
            continue;
        }
        ++beyond;
        // Towards zero, so that rounding does not lead beyond again.
        const Vec2 limited = glm::trunc(xy * (kUnit * std::sqrt(most / length2)));
        map.pixels[4 * i] = static_cast<std::uint8_t>(128 + static_cast<int>(limited.x));
        map.pixels[4 * i + 1] = static_cast<std::uint8_t>(128 + static_cast<int>(limited.y));
        const float z = std::sqrt(std::max(1 - glm::dot(limited, limited) / (kUnit * kUnit), 0.0f));
        map.pixels[4 * i + 2] = static_cast<std::uint8_t>(128 + std::lround(kUnit * z));
    }
    return beyond;
}

}  // namespace limn
