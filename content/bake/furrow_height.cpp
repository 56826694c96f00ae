#include "content/bake/furrow_height.h"

#include "content/bake/furrow_trace.h"
#include "ecs/base/check.h"
#include "ecs/base/jobs.h"

#include <algorithm>
#include <cstddef>
#include <utility>

// Techniques: wrinkle.furrow.heightfield, wrinkle.furrow.noise, wrinkle.furrow.normal-base,
//     wrinkle.furrow.normal-perturb

namespace limn {
namespace {

constexpr std::size_t kRowsPerJob = 16;

/// Calls body(x, y, pixel) for every pixel, on several threads.
template <typename Body>
void for_each_pixel(const IVec2& size, const Body& body) {
    parallel_for(
        static_cast<std::size_t>(size.y), kRowsPerJob, [&](std::size_t begin, std::size_t end) {
            for (std::size_t y = begin; y < end; ++y) {
                for (int x = 0; x < size.x; ++x) {
                    body(
                        x, static_cast<int>(y),
                        y * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(x));
                }
            }
        });
}

Vec3 base_normal(const FurrowTriangle& triangle, int x, int y) {
    const Vec2 offset = Vec2(x, y) + 0.5f - triangle.corner[0];
    return normalize_or(
        triangle.normal + triangle.normal_right * offset.x + triangle.normal_down * offset.y,
        {0, 0, 1});
}

}  // namespace

FurrowGrowth grow_furrows(const FurrowMap& map, const FurrowStyle& style) {
    FurrowGrowth growth;
    growth.size = map.size;
    growth.cover = cover_furrow_map(map);
    parallel_for(2, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t field = begin; field < end; ++field) {
            FurrowDrawing drawing =
                trace_furrows(map, growth.cover, style, static_cast<int>(field));
            (field == 0 ? growth.first : growth.second) = std::move(drawing.height);
        }
    });
    growth.height.resize(growth.first.size());
    for_each_pixel(map.size, [&](int, int, std::size_t pixel) {
        growth.height[pixel] = std::min(growth.first[pixel], growth.second[pixel]);
    });
    return growth;
}

std::vector<float> add_furrow_noise(const FurrowGrowth& growth, const FurrowStyle& style) {
    std::vector<float> height = growth.height;
    if (style.noise > 0) {
        constexpr std::size_t kWords = 4;  // random words per counter: four pixels in a row
        parallel_for((height.size() + 3) / kWords, 2048, [&](std::size_t begin, std::size_t end) {
            for (std::size_t group = begin; group < end; ++group) {
                Random random = furrow_noise(style, group);
                const std::size_t last = std::min(kWords * group + kWords, height.size());
                for (std::size_t pixel = kWords * group; pixel < last; ++pixel) {
                    height[pixel] -= random.uniform() * style.noise;
                }
            }
        });
    }
    return height;
}

std::vector<Vec3> make_furrow_base_normals(const FurrowMap& map, const FurrowGrowth& growth) {
    std::vector<Vec3> normals(growth.cover.size());
    for_each_pixel(growth.size, [&](int x, int y, std::size_t pixel) {
        const std::int32_t triangle = growth.cover[pixel];
        normals[pixel] = triangle < 0
                             ? Vec3(0, 0, 1)
                             : base_normal(map.triangles[static_cast<std::size_t>(triangle)], x, y);
    });
    return normals;
}

Vec3 perturb_furrow_normal(const Vec3& n, const Vec2& slope) {
    const Vec3 gradient(slope, 0);
    return n - (gradient - glm::dot(gradient, n) * n);
}

std::vector<Vec3> make_furrow_normals(
    const FurrowMap& map, const FurrowGrowth& growth, const std::vector<float>& height,
    float bump) {
    LIMN_CHECK(height.size() == growth.cover.size());
    std::vector<Vec3> normals = make_furrow_base_normals(map, growth);
    const IVec2 size = growth.size;
    for_each_pixel(size, [&](int x, int y, std::size_t pixel) {
        if (growth.cover[pixel] < 0) {
            return;
        }
        const auto difference = [&](int i, int j) {
            const auto to = static_cast<std::size_t>(j * size.x + i);
            return growth.cover[to] < 0 ? 0.0f : height[to] - height[pixel];
        };
        const int right = map.wrap_s ? (x + 1) % size.x : std::min(x + 1, size.x - 1);
        const int up = map.wrap_t ? (y + size.y - 1) % size.y : std::max(y - 1, 0);
        const Vec2 slope(difference(right, y), difference(x, up));
        normals[pixel] = glm::normalize(perturb_furrow_normal(normals[pixel], bump * slope));
    });
    return normals;
}

}  // namespace limn
