#include "content/make/patterns/relief_patterns.h"

#include "content/bake/odd_map.h"
#include "content/make/patterns/pattern_tools.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace limn {
namespace {

/// Height 0 .. 1 of a dome over -1 .. 1.
float dome(float x) {
    return std::sqrt(std::max(1.0f - x * x, 0.0f));
}

/// Height 0 .. 1 of one ring of petals between two radii, at polar coordinates; 0 between petals.
float petal_ring(float radius, float turn, int petals, float begin, float end) {
    const float sector = turn * static_cast<float>(petals);
    const float across = 2.0f * (sector - std::floor(sector) - 0.5f);  // -1 .. 1
    const float along = (radius - begin) / (end - begin);
    if (along < 0 || along > 1) {
        return 0;
    }
    // Widest at two thirds of its length, round at its tip.
    const float width =
        along < 0.65f ? 0.55f + 0.42f * along / 0.65f : 0.97f * dome((along - 0.65f) / 0.35f);
    const float side = std::abs(across) / std::max(width, 1e-3f);
    if (side >= 1) {
        return 0;
    }
    const float rib = 1.0f - 0.25f * std::exp(-square(across / 0.08f));
    const float curl = 0.55f + 0.45f * std::sin(kPi * std::min(along, 0.8f));
    return dome(0.9f * side) * curl * rib;
}

/// A row of beads along the sides of a square, in its coordinates -1 .. 1.
float bead_row(const Vec2& p, float radius, float half_width, int beads) {
    const float side = std::max(std::abs(p.x), std::abs(p.y));
    const float along = std::abs(p.x) > std::abs(p.y) ? p.y : p.x;
    const float spacing = 2.0f * radius / static_cast<float>(beads);
    const float nearest = (std::floor((along + radius) / spacing) + 0.5f) * spacing - radius;
    const Vec2 from = {side - radius, along - nearest};
    return dome(std::min(glm::length(from) / half_width, 1.0f));
}

/// Depths as heights, averaged to a few texels per position of an ODD map.
HeightMap heights_for_odd(const ImageData& relief) {
    const int step = std::max(1, relief.width / (4 * kOddPositions));
    HeightMap map;
    map.width = std::max(1, relief.width / step);
    map.height = std::max(1, relief.height / step);
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            int sum = 0;
            for (int i = 0; i < step * step; ++i) {
                const int pixel = (step * y + i / step) * relief.width + step * x + i % step;
                sum += relief.pixels[static_cast<std::size_t>(4 * pixel + 3)];
            }
            map.heights.push_back(
                1 - static_cast<float>(sum) / static_cast<float>(255 * step * step));
        }
    }
    return map;
}

PatternMaps with_odd_map(PatternMaps maps, bool odd, float depth) {
    if (odd) {
        maps.relief = make_odd_map(maps.relief, depth);
    }
    return maps;
}

}  // namespace

ImageData make_odd_map(const ImageData& relief, float depth) {
    const TileSurface tile = tile_of(heights_for_odd(relief), depth);
    const BakedMap map = bake_odd(tile, TileCaster(tile), OddOrder::Directions);
    ImageData image;
    image.width = map.width;
    image.height = map.height;
    image.pixels = map_bytes(map, 4);
    return image;
}

PatternMaps make_blocks(const BlocksPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const int rows = even(pattern.rows);
    const int columns =
        std::max(1, static_cast<int>(std::lround(static_cast<float>(rows) / pattern.aspect)));
    const float block = static_cast<float>(rows) / static_cast<float>(columns);  // in heights
    PatternMaps maps = make_relief_maps(pattern.image.size, pattern.relief, [&](const Vec2& uv) {
        const Vec2 ragged = {fbm(uv, 3 * rows, seed + 40, 4), fbm(uv, 3 * rows, seed + 50, 4)};
        const Vec2 p = uv * Vec2(columns, rows) + 0.05f * pattern.broken * ragged;
        const int course = static_cast<int>(std::floor(p.y));
        const int row = (course % rows + rows) % rows;
        const float x = p.x + 0.5f * static_cast<float>(row % 2);
        const int whole = static_cast<int>(std::floor(x));
        const int column = (whole % columns + columns) % columns;
        const float local_x = x - static_cast<float>(whole);
        const float local_y = p.y - static_cast<float>(course);
        const float end = std::min(local_x, 1.0f - local_x) * block;
        const float edge = std::min(end, std::min(local_y, 1.0f - local_y));
        const std::uint32_t random = lattice_hash(column, row, seed + 2);
        const float own = static_cast<float>(random & 255u) / 255.0f;

        const float half = 0.5f * pattern.joint;
        const float chips = fbm(uv, 5 * rows, seed + 60, 4, 0.6f);
        const float rounding = 0.05f + 0.16f * pattern.broken * (0.6f + chips);
        const float wall = glm::smoothstep(half, half + 0.025f, edge);
        const float face = dome(1.0f - std::clamp((edge - half) / rounding, 0.0f, 1.0f));
        const float grain = fbm(uv, 14 * rows, seed + 10, 4, 0.7f);
        const float cloud = fbm(uv, rows, seed + 20, 4);
        const float pits = std::max(fbm(uv, 7 * rows, seed + 70, 3) - 0.25f, 0.0f);
        PatternTexel t;
        t.height = wall * (0.45f + 0.35f * face + 0.1f * own)
                   + wall * (0.05f * cloud + 0.025f * grain - 0.5f * pattern.broken * pits)
                   + 0.06f * (1.0f - wall) * (1.0f + grain);
        const Vec3 stone = tinted(pattern.color, pattern.variation, random)
                           * (1.0f + 0.3f * cloud + 0.25f * grain - 0.6f * pits);
        t.color = glm::mix(pattern.joint_color * (0.8f + 0.4f * grain), stone, wall);
        t.roughness = 0.88f + 0.08f * grain;
        t.occlusion = glm::mix(0.35f, 1.0f, glm::smoothstep(0.0f, half + 0.12f, edge));
        return t;
    });
    return with_odd_map(std::move(maps), pattern.odd, pattern.relief);
}

PatternMaps make_rosettes(const RosettesPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const int cells = 8 * pattern.panels;
    PatternMaps maps = make_relief_maps(pattern.image.size, pattern.relief, [&](const Vec2& uv) {
        const float wear = pattern.worn;
        const Vec2 ragged = {fbm(uv, 2 * cells, seed + 40, 3), fbm(uv, 2 * cells, seed + 50, 3)};
        const Vec2 panel = uv * static_cast<float>(pattern.panels);
        const Vec2 p = 2.0f * (panel - glm::floor(panel)) - 1.0f + 0.012f * wear * ragged;
        const float side = std::max(std::abs(p.x), std::abs(p.y));
        const float radius = glm::length(p);
        const float turn = std::atan2(p.y, p.x) / (2.0f * kPi) + 0.5f;
        const float half_petal = 0.5f / static_cast<float>(pattern.petals);

        const float frame = glm::smoothstep(0.84f, 0.88f + 0.04f * wear, side);
        const float fillet = 0.35f * glm::smoothstep(0.66f, 0.69f, side);
        const float beads = 0.42f * bead_row(p, 0.765f, 0.07f, 11);
        const float outer = 0.62f * petal_ring(radius, turn, pattern.petals, 0.16f, 0.64f);
        const float inner =
            0.3f + 0.5f * petal_ring(radius, turn + half_petal, pattern.petals, 0.08f, 0.36f);
        const float boss = 0.55f + 0.4f * dome(std::min(radius / 0.13f, 1.0f));
        float height = std::max(fillet + beads, outer);
        height = inner > 0.3f ? std::max(height, inner) : height;
        height = radius < 0.13f ? std::max(height, boss) : height;
        height = std::max(height, 0.9f * frame);

        const float grain = fbm(uv, 12 * cells, seed + 10, 4, 0.7f);
        const float cloud = fbm(uv, cells, seed + 20, 5);
        const float pits = std::max(fbm(uv, 4 * cells, seed + 70, 3) - 0.3f, 0.0f);
        PatternTexel t;
        t.height = height + 0.03f * cloud * wear + 0.012f * grain - 0.6f * wear * pits;
        t.color = pattern.color * (0.72f + 0.34f * height + 0.25f * cloud + 0.2f * grain);
        t.roughness = 0.84f + 0.1f * grain - 0.12f * height;
        t.occlusion = 0.55f + 0.45f * std::min(height * 1.4f, 1.0f);
        t.opacity = pattern.pierced && height < 0.05f ? 0.0f : 1.0f;
        return t;
    });
    return with_odd_map(std::move(maps), pattern.odd, pattern.relief);
}

PatternMaps make_flutes(const FlutesPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const int size = pattern.image.size;
    PatternMaps maps = make_pattern_maps(size, [&](const Vec2& uv) {
        const float grain = fbm(uv, 48, seed + 10, 4, 0.7f);
        PatternTexel t;
        t.color = pattern.color * (1.0f + 0.3f * fbm(uv, 6, seed + 20) + 0.2f * grain);
        t.roughness = 0.8f + 0.1f * grain;
        return t;
    });
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            // Longitude and latitude, as make_sphere() has them: the seam is at -z, the top at +y.
            const Vec2 uv = (Vec2(x, y) + 0.5f) / static_cast<float>(size);
            const float longitude = 2 * kPi * (uv.x - 0.5f);
            const float latitude = kPi * uv.y;
            const Vec3 east = {std::cos(longitude), 0, -std::sin(longitude)};
            const Vec3 out = {
                std::sin(latitude) * std::sin(longitude), std::cos(latitude),
                std::sin(latitude) * std::cos(longitude)};
            const float slope = pattern.depth * std::sin(latitude)
                                * std::sin(static_cast<float>(pattern.flutes) * longitude);
            const Vec3 normal = 0.5f + 0.5f * glm::normalize(out + slope * east);
            for (int k = 0; k < 3; ++k) {
                maps.normal.pixels[static_cast<std::size_t>(4 * (y * size + x) + k)] =
                    static_cast<std::uint8_t>(std::lround(255 * normal[k]));
            }
        }
    }
    return maps;
}

}  // namespace limn
