#include "content/make/patterns/mask_pattern.h"

#include "content/make/patterns/noise.h"
#include "content/make/patterns/pattern_tools.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cstddef>

// Techniques: wrinkle.maps.masks

namespace limn {
namespace {

Vec4 masks_at(const MasksPattern& pattern, const Vec2& uv) {
    const float wander = pattern.wander * fbm(uv, 4, seed_of(pattern.image));
    Vec4 masks = {0, 0, 0, 0};
    for (const MaskRegion& region : pattern.regions) {
        const float distance = glm::length((uv - region.at) / region.radius) + wander;
        masks[region.channel] += 1 - glm::smoothstep(1 - pattern.softness, 1.0f, distance);
    }
    const float sum = masks.x + masks.y + masks.z + masks.w;
    return masks / std::max(sum, 1.0f);
}

}  // namespace

PatternMaps make_masks(const MasksPattern& pattern) {
    PatternMaps maps =
        make_pattern_maps(pattern.image.size, [](const Vec2&) { return PatternTexel{}; });
    const int size = pattern.image.size;
    maps.base_color.srgb = false;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const Vec2 uv = (Vec2(x, y) + 0.5f) / static_cast<float>(size);
            const Vec4 masks = masks_at(pattern, uv);
            const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(size)
                               + static_cast<std::size_t>(x);
            for (int i = 0; i < 4; ++i) {  // rounded down, so that no sum exceeds 255
                maps.base_color.pixels[4 * pixel + static_cast<std::size_t>(i)] =
                    static_cast<std::uint8_t>(255 * masks[i] + 1e-3f);
            }
        }
    }
    return maps;
}

}  // namespace limn
