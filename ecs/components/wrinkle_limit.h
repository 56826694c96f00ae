#pragma once

#include "ecs/base/math.h"
#include "ecs/components/surface.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstddef>

namespace limn {

// Techniques: wrinkle.compression.map, wrinkle.compression.normal-fit

/// x^2 + y^2 of normals up to which the fit to the unit sphere (WrinkleMethod::Sphere) is off by
/// less than 8.76 degrees at any strength. A level whose map is steeper is warned of.
inline constexpr float kSteepestWrinkle = 0.6f;

/// x and y of the normal of a texel of an 8-bit wrinkle map, flat at 128.
inline Vec2 wrinkle_normal_at(const ImageData& map, std::size_t texel) {
    return Vec2(map.pixels[4 * texel] - 128, map.pixels[4 * texel + 1] - 128) / 127.0f;
}

/// How many texels of an 8-bit wrinkle map are steeper; 0 for other formats.
inline std::size_t count_steep_texels(const ImageData& map) {
    const auto whole = static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
    const std::size_t texels =
        map.format == PixelFormat::Rgba8 ? std::min(whole, map.pixels.size() / 4) : 0;
    std::size_t steep = 0;
    for (std::size_t i = 0; i < texels; ++i) {
        const Vec2 xy = wrinkle_normal_at(map, i);
        steep += glm::dot(xy, xy) > kSteepestWrinkle ? 1 : 0;
    }
    return steep;
}

}  // namespace limn
