#include "content/bake/height_map.h"

#include "ecs/base/check.h"
#include "ecs/base/jobs.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstddef>

// Techniques: bump.nm-from-height

namespace limn {

float HeightMap::at(int x, int y) const {
    const auto wrap = [this](int i, int size) {
        return repeats ? ((i % size) + size) % size : std::clamp(i, 0, size - 1);
    };
    return heights
        [static_cast<std::size_t>(wrap(y, height)) * static_cast<std::size_t>(width)
         + static_cast<std::size_t>(wrap(x, width))];
}

Vec3 normal_of_slope(float du, float dv) {
    return glm::normalize(Vec3(-du, -dv, 1));
}

std::vector<Vec3> normals_of(const HeightMap& map, float depth) {
    LIMN_CHECK(map.width > 0 && map.height > 0);
    std::vector<Vec3> normals(map.heights.size());
    const float scale = depth * static_cast<float>(map.width);  // of a height, in texels
    // At the edge of a map that does not repeat, the difference spans one texel.
    const auto span_of = [&](int i, int size) {
        return !map.repeats && size > 1 && (i == 0 || i == size - 1) ? 1.0f : 2.0f;
    };
    parallel_for(static_cast<std::size_t>(map.height), 16, [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            for (int x = 0; x < map.width; ++x) {
                const float du = (map.at(x + 1, y) - map.at(x - 1, y)) / span_of(x, map.width);
                const float dv = (map.at(x, y - 1) - map.at(x, y + 1)) / span_of(y, map.height);
                normals
                    [static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width)
                     + static_cast<std::size_t>(x)] = normal_of_slope(scale * du, scale * dv);
            }
        }
    });
    return normals;
}

Vec2 normalize_heights(HeightMap& map, float flat) {
    const auto [least, largest] = std::minmax_element(map.heights.begin(), map.heights.end());
    const Vec2 range = {*least, *largest};
    for (float& h : map.heights) {
        h = range.y > range.x ? (h - range.x) / (range.y - range.x) : flat;
    }
    return range;
}

BakedMap relief_of(const HeightMap& map, float depth) {
    const std::vector<Vec3> normals = normals_of(map, depth);
    BakedMap relief = make_baked_map(map.width, map.height);
    for (std::size_t i = 0; i < normals.size(); ++i) {
        relief.texels[i] = encode_relief(
            {.normal = normals[i], .depth = 1 - std::clamp(map.heights[i], 0.0f, 1.0f)},
            ReliefLayout::Single);
    }
    return relief;
}

}  // namespace limn
