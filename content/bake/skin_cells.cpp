#include "content/bake/skin_cells.h"

#include "ecs/base/check.h"
#include "ecs/base/hash.h"
#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

// Techniques: wrinkle.furrow.polygon-models

namespace limn {
namespace {

int wrapped_cell(int i, int size) {
    return (i % size + size) % size;
}

/// Position of the site within its square of the grid, in units of the square.
Vec2 jitter(const IVec2& cell, int cells, int level, int seed) {
    const auto index =
        static_cast<std::uint64_t>(wrapped_cell(cell.y, cells)) * static_cast<std::uint64_t>(cells)
        + static_cast<std::uint64_t>(wrapped_cell(cell.x, cells));
    Random random(
        static_cast<std::uint64_t>(seed), index, name_hash("skin_cells"),
        static_cast<std::uint64_t>(level));
    const float x = random.uniform();
    return {x, random.uniform()};
}

/// 1 - d1 / d2 of the distances to the nearest two sites.
float level_height(const Vec2& uv, int cells, int level, int seed) {
    const Vec2 p = uv * static_cast<float>(cells);
    const IVec2 own_cell(glm::floor(p));
    float nearest = INFINITY;
    float second = INFINITY;
    for (int y = -2; y <= 2; ++y) {
        for (int x = -2; x <= 2; ++x) {
            const IVec2 cell = own_cell + IVec2(x, y);
            const float distance = glm::distance(p, Vec2(cell) + jitter(cell, cells, level, seed));
            second = std::min(second, std::max(nearest, distance));
            nearest = std::min(nearest, distance);
        }
    }
    return second > 0 ? 1.0f - nearest / second : 1.0f;
}

}  // namespace

Vec2 skin_cell_site(const IVec2& cell, const SkinCells& cells) {
    return (Vec2(cell) + jitter(cell, cells.cells, 0, cells.seed))
           / static_cast<float>(cells.cells);
}

float skin_cell_height(const Vec2& uv, const SkinCells& cells) {
    LIMN_CHECK(cells.cells >= 2 && cells.levels >= 1 && cells.levels <= 4);
    float height = 1;
    float depth = 1;
    for (int level = 0; level < cells.levels; ++level) {
        const float own = level_height(uv, cells.cells << level, level, cells.seed);
        height = std::min(height, 1.0f - depth * (1.0f - own));
        depth *= 0.5f;
    }
    return height;
}

std::vector<float> make_skin_cells(int size, const SkinCells& cells) {
    LIMN_CHECK(size >= 1);
    std::vector<float> heights(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
    parallel_for(static_cast<std::size_t>(size), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) {
            for (int x = 0; x < size; ++x) {
                const Vec2 uv = (Vec2(x, static_cast<int>(y)) + 0.5f) / static_cast<float>(size);
                heights[y * static_cast<std::size_t>(size) + static_cast<std::size_t>(x)] =
                    skin_cell_height(uv, cells);
            }
        }
    });
    return heights;
}

}  // namespace limn
