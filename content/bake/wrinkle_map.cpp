#include "content/bake/wrinkle_map.h"

#include "ecs/base/check.h"
#include "ecs/base/math.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

// Techniques: wrinkle.compression.map

namespace limn {

int limit_wrinkle_map(ImageData& map, float max_square) {
    if (map.format != PixelFormat::Rgba8) {
        return 0;
    }
    constexpr float kUnit = 127;
    int beyond = 0;
    const auto texels = static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
    for (std::size_t i = 0; i < std::min(texels, map.pixels.size() / 4); ++i) {
        const Vec2 xy = wrinkle_normal_at(map, i);
        const float length2 = glm::dot(xy, xy);
        if (length2 <= max_square) {
            continue;
        }
        ++beyond;
        // Towards zero, so that rounding does not exceed the limit.
        const Vec2 limited = glm::trunc(xy * (kUnit * std::sqrt(max_square / length2)));
        map.pixels[4 * i] = static_cast<std::uint8_t>(128 + static_cast<int>(limited.x));
        map.pixels[4 * i + 1] = static_cast<std::uint8_t>(128 + static_cast<int>(limited.y));
        const float z = std::sqrt(std::max(1 - glm::dot(limited, limited) / (kUnit * kUnit), 0.0f));
        map.pixels[4 * i + 2] = static_cast<std::uint8_t>(128 + std::lround(kUnit * z));
    }
    return beyond;
}

void write_wrinkle_map(ImageData& map, std::span<const float> heights) {
    const auto width = static_cast<std::size_t>(map.width);
    const auto height = static_cast<std::size_t>(map.height);
    LIMN_CHECK(map.format == PixelFormat::Rgba8 && heights.size() == width * height);
    constexpr float kUnit = 127;
    std::vector<Vec2> below(width + 2, Vec2(0));  // rounding errors, passed on to the next row
    for (std::size_t y = 0; y < height; ++y) {
        std::vector<Vec2> here(width + 2, Vec2(0));
        std::swap(here, below);
        for (std::size_t x = 0; x < width; ++x) {
            const auto at = [&](std::size_t column, std::size_t row) {
                return heights[row % height * width + column % width];
            };
            // Rows run downwards while green points up, so the signs of the two slopes differ.
            const float right = 0.5f * (at(x + 1, y) - at(x + width - 1, y));
            const float down = 0.5f * (at(x, y + 1) - at(x, y + height - 1));
            std::uint8_t* const texel = &map.pixels[4 * (y * width + x)];
            if (right == 0 && down == 0) {
                texel[0] = texel[1] = 128;
                texel[2] = 255;
                continue;
            }
            const Vec2 exact = Vec2(-right, down) / std::sqrt(1 + right * right + down * down);
            const Vec2 steps = glm::clamp(kUnit * exact + here[x + 1], -kUnit, kUnit);
            const Vec2 rounded = glm::floor(steps + 0.5f);
            const Vec2 left_over = steps - rounded;
            here[x + 2] += 7.0f / 16 * left_over;
            below[x] += 3.0f / 16 * left_over;
            below[x + 1] += 5.0f / 16 * left_over;
            below[x + 2] += 1.0f / 16 * left_over;
            const float z = std::sqrt(std::max(1 - glm::dot(exact, exact), 0.0f));
            texel[0] = static_cast<std::uint8_t>(128 + static_cast<int>(rounded.x));
            texel[1] = static_cast<std::uint8_t>(128 + static_cast<int>(rounded.y));
            texel[2] = static_cast<std::uint8_t>(128 + std::lround(kUnit * z));
        }
    }
}

}  // namespace limn
