#include "content/make/head/head_furrow_pattern.h"

#include "content/bake/furrow_field.h"
#include "content/bake/furrow_height.h"
#include "content/bake/furrow_map.h"
#include "content/bake/skin_texels.h"
#include "content/bake/wrinkle_map.h"
#include "content/make/head/head.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// Techniques: skin.pipeline

namespace limn {

namespace {

constexpr float kSize = 1024;         ///< [px] of the image that scales refer to
constexpr float kFineDepth = 1.2f;    ///< height of the relief relative to its width; by eye
constexpr float kCoarseDepth = 3.0f;  ///< likewise
constexpr float kCoarseTurn = 0.25f;  ///< factor of the fine furrows' angle: folds are straighter
constexpr float kCoarseWidth = 1.5f;  ///< factor of their width
constexpr int kGutter = 4;

/// Vectors of both fields at each vertex, and how much it folds.
struct HeadFields {
    std::vector<FurrowVectors> vectors;
    std::vector<float> mask;
};

HeadFields make_fields(const MeshData& mesh) {
    const std::size_t vertices = mesh.positions.size();
    HeadFields fields = {{}, std::vector<float>(vertices, 0.0f)};
    std::vector<float> strongest(vertices, 0.0f);
    for (const Vec3& normal : mesh.normals) {
        fields.vectors.push_back(initial_furrow_vectors(normal));
    }
    for (const VertexRegion& region : mesh.regions) {
        for (std::size_t v = 0; v < vertices && !region.across.empty(); ++v) {
            const float weight = region.weights[v];
            fields.mask[v] = std::min(fields.mask[v] + weight, 1.0f);
            if (weight > strongest[v] && glm::length(region.across[v]) > 0.5f) {
                strongest[v] = weight;
                fields.vectors[v] = {
                    region.across[v], glm::cross(mesh.normals[v], region.across[v])};
            }
        }
    }
    return fields;
}

/// Box-blurred over 2 `radius` + 1 pixels, twice in each direction.
void blur(std::vector<float>& image, int size, int radius) {
    std::vector<float> other(image.size());
    const auto pass = [&](const std::vector<float>& from, std::vector<float>& to, bool down) {
        for (int line = 0; line < size; ++line) {
            for (int i = 0; i < size; ++i) {
                float sum = 0;
                for (int k = -radius; k <= radius; ++k) {
                    const int at = std::clamp(i + k, 0, size - 1);
                    sum +=
                        from[static_cast<std::size_t>(down ? at * size + line : line * size + at)];
                }
                to[static_cast<std::size_t>(down ? i * size + line : line * size + i)] =
                    sum / static_cast<float>(2 * radius + 1);
            }
        }
    };
    for (int i = 0; i < 2; ++i) {
        pass(image, other, false);
        pass(other, image, true);
    }
}

/// The slope of heights at a pixel, to the right and upwards.
Vec2 slope_at(const std::vector<float>& height, int size, int x, int y) {
    const auto at = [&](int i, int j) {
        i = std::clamp(i, 0, size - 1);
        j = std::clamp(j, 0, size - 1);
        return height[static_cast<std::size_t>(j * size + i)];
    };
    return 0.5f * Vec2(at(x + 1, y) - at(x - 1, y), at(x, y - 1) - at(x, y + 1));
}

/// x and y of the unit normal of a slope, as bytes where 128 is flat.
std::array<std::uint8_t, 2> encoded_normal(const Vec2& slope) {
    const Vec2 n = -slope / std::sqrt(1 + glm::dot(slope, slope));
    const float length2 = glm::dot(n, n);
    const Vec2 limited = length2 > kSteepestWrinkle ? n * std::sqrt(kSteepestWrinkle / length2) : n;
    return {
        static_cast<std::uint8_t>(128 + std::lround(127 * limited.x)),
        static_cast<std::uint8_t>(128 + std::lround(127 * limited.y))};
}

struct HeadRelief {
    std::vector<float> first;  ///< heights [px], 0: without a furrow
    std::vector<float> second;
};

HeadRelief grow_head(const HeadFurrowsPattern& pattern) {
    const int size = pattern.image.size;
    const bool coarse = pattern.map != HeadFurrowMap::Fine;
    const MeshData mesh = make_head({.age = pattern.age});
    const HeadFields fields = make_fields(mesh);
    HeadRelief relief = {
        std::vector<float>(static_cast<std::size_t>(size) * static_cast<std::size_t>(size), 0.0f),
        {}};
    relief.second = relief.first;
    const Result<FurrowMap> map = make_furrow_map(mesh, fields.vectors, {.size = size});
    if (!map) {
        return relief;  // no triangle covers a texel
    }
    const float scale =
        pattern.scale * (coarse ? pattern.coarse : 1.0f) * static_cast<float>(size) / kSize;
    FurrowStyle style = {.scale = scale, .seed = pattern.image.seed};
    if (coarse) {
        style.functions.angle *= kCoarseTurn;
        style.functions.width *= kCoarseWidth;
    }
    const FurrowGrowth growth = grow_furrows(*map, style);
    const std::vector<SkinTexel> texels = find_skin_texels(mesh, size, kGutter);
    const float depth = pattern.depth * scale * (coarse ? kCoarseDepth : kFineDepth);
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const float mask =
            coarse ? at_texel(mesh.indices, texels[i], std::span<const float>(fields.mask)) : 1.0f;
        relief.first[i] = depth * mask * (growth.first[i] - 1);
        relief.second[i] = depth * mask * (growth.second[i] - 1);
    }
    if (coarse) {
        const int radius = std::max(static_cast<int>(std::lround(0.5f * scale)), 1);
        blur(relief.first, size, radius);
        blur(relief.second, size, radius);
    }
    return relief;
}

}  // namespace

PatternMaps make_head_furrows(const HeadFurrowsPattern& pattern) {
    const HeadRelief relief = grow_head(pattern);
    const int size = pattern.image.size;
    PatternMaps maps = make_pattern_maps(size, [](const Vec2&) { return PatternTexel{}; });
    std::vector<float> shown =
        pattern.map == HeadFurrowMap::Stretched ? relief.first : relief.second;
    if (pattern.map == HeadFurrowMap::Fine) {
        for (std::size_t i = 0; i < shown.size(); ++i) {
            shown[i] = std::min(shown[i], relief.first[i]);
        }
    }
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            std::uint8_t* const texel =
                &maps.normal.pixels[4 * static_cast<std::size_t>(y * size + x)];
            const Vec2 slope = slope_at(shown, size, x, y);
            const auto first = encoded_normal(slope);
            texel[0] = first[0];
            texel[1] = first[1];
            if (pattern.map == HeadFurrowMap::Layers) {
                const auto second = encoded_normal(slope_at(relief.first, size, x, y));
                texel[2] = second[0];
                texel[3] = second[1];
            } else {
                const Vec2 n = (Vec2(first[0], first[1]) - 128.0f) / 127.0f;
                texel[2] = static_cast<std::uint8_t>(
                    128 + std::lround(127 * std::sqrt(std::max(1 - glm::dot(n, n), 0.0f))));
            }
        }
    }
    return maps;
}

}  // namespace limn
