#include "content/make/models/terrain.h"

#include "content/make/models/surface_grid.h"
#include "content/make/patterns/noise.h"
#include "ecs/base/check.h"
#include "ecs/base/jobs.h"
#include "ecs/base/log.h"

#include <cmath>
#include <vector>

namespace limn {

namespace {

/// About 0 .. 1.
float eroded_hills(Vec2 p, std::uint32_t seed, const TerrainShape& shape) {
    float sum = 0;
    float amplitude = 1;
    Vec2 slope = {0, 0};
    for (int i = 0; i < shape.octaves; ++i) {
        const NoiseSample n = gradient_noise_slope(p, seed + static_cast<std::uint32_t>(i));
        slope += 0.5f * n.slope;
        sum += amplitude * n.value / (1.0f + shape.erosion * glm::dot(slope, slope));
        amplitude *= 0.5f;
        // Doubled and rotated (by the angle of the 3-4-5 triangle) so that octaves do not align.
        p = 2.0f * Vec2(0.8f * p.x - 0.6f * p.y, 0.6f * p.x + 0.8f * p.y);
    }
    return 0.5f + 0.6f * sum;
}

float landscape(const TerrainShape& shape, float x, float z) {
    const auto seed = static_cast<std::uint32_t>(shape.seed) * 64u;
    const Vec2 p = Vec2(x, z) / shape.feature_size;
    const Vec2 bend = {gradient_noise(0.7f * p, seed + 40), gradient_noise(0.7f * p, seed + 41)};
    const Vec2 bent = p + shape.warp * bend;
    // Transition from hills to mountains: `ridges` sets the fraction of mountains.
    const float region = 0.5f + 0.7f * gradient_noise(0.6f * p + 31.5f, seed + 42);
    const float mountains =
        shape.ridges >= 1 ? 1.0f : glm::smoothstep(0.9f, 1.5f, region + 1.2f * shape.ridges);
    const float hills = mountains < 1 ? eroded_hills(bent, seed, shape) : 0.0f;
    const float crests =
        mountains > 0 ? ridged_noise(0.5f * bent, seed + 20, {.count = shape.octaves, .gain = 0.5f})
                      : 0.0f;
    return shape.height * glm::mix(hills, crests, mountains);
}

/// The height of the clearing: the mean of the terrain around it.
float clearing_height(const TerrainShape& shape) {
    constexpr int kSamples = 16;
    float sum = 0;
    for (int i = 0; i < kSamples; ++i) {
        const float angle = 2.0f * kPi * static_cast<float>(i) / kSamples;
        const float radius = 1.5f * shape.clearing;
        sum += landscape(shape, radius * std::cos(angle), radius * std::sin(angle));
    }
    return sum / kSamples;
}

/// Factor of the height near the coast, which is the ellipse inscribed in the rectangle.
float risen(const TerrainShape& shape, float x, float z) {
    const Vec2 half = 0.5f * shape.size;
    const float inland = 1.0f - glm::length(Vec2(x, z) / half);
    const float whole = std::min(shape.shore / std::min(half.x, half.y), 1.0f);
    return glm::smoothstep(0.0f, whole, inland);
}

/// Depth below the seabed [m] toward the edges of the rectangle, so that the sea hides them; by
/// eye.
float drop(const TerrainShape& shape, float x, float z) {
    constexpr float kBegin = 0.9f;
    constexpr float kDepth = 0.3f;  // of half the smaller side
    const Vec2 half = 0.5f * shape.size;
    const float outward = glm::length(Vec2(x, z) / half);
    const float t = std::clamp((outward - kBegin) / (1 - kBegin), 0.0f, 1.0f);
    return kDepth * std::min(half.x, half.y) * square(t);
}

/// `level` is clearing_height(); ignored without a clearing.
float height_at(const TerrainShape& shape, float level, float x, float z) {
    const float wild =
        shape.clearing > 0
            ? glm::smoothstep(shape.clearing, 2.0f * shape.clearing, std::sqrt(x * x + z * z))
            : 1.0f;
    const float land = wild > 0 ? glm::mix(level, landscape(shape, x, z), wild) : level;
    if (shape.shore <= 0) {
        return land;
    }
    const float dry = risen(shape, x, z);
    return glm::mix(-kSeabed * shape.height - drop(shape, x, z), land, dry);
}

/// Ground color at a position; `level` is the y of the normal, 1 = flat.
Vec4 ground_color(const TerrainShape& shape, const Vec3& at, float level) {
    constexpr Vec3 kRock = {0.21f, 0.17f, 0.14f};
    constexpr Vec3 kDarkRock = {0.11f, 0.095f, 0.085f};
    constexpr Vec3 kScrub = {0.075f, 0.085f, 0.035f};
    constexpr Vec3 kSand = {0.40f, 0.33f, 0.24f};
    const Vec2 position = Vec2(at.x, at.z) / shape.feature_size;
    const auto seed = static_cast<std::uint32_t>(shape.seed);
    const float patches = gradient_noise(9.0f * position, seed);
    const float layers = std::sin(0.9f * at.y + 3.0f * patches);
    const Vec3 rock = glm::mix(kDarkRock, kRock, 0.5f + 0.35f * layers + 0.3f * patches);
    const float grows = glm::smoothstep(0.70f, 0.88f, level + 0.12f * patches);
    Vec3 color = glm::mix(rock, kScrub * (1.0f + 0.5f * patches), grows);
    if (shape.shore > 0) {
        const float low = 0.05f * shape.height;
        color =
            glm::mix(kSand, color, glm::smoothstep(0.8f * low, 1.6f * low, at.y + low * patches));
    }
    return Vec4(glm::max(color, Vec3(0)), 1);
}

}  // namespace

float terrain_height(const TerrainShape& shape, float x, float z) {
    return height_at(shape, shape.clearing > 0 ? clearing_height(shape) : 0.0f, x, z);
}

MeshData make_terrain(const TerrainShape& shape) {
    LIMN_CHECK(shape.size.x > 0 && shape.size.y > 0 && shape.feature_size > 0);
    LIMN_CHECK(shape.divisions >= 1 && shape.octaves >= 1);

    const float level = shape.clearing > 0 ? clearing_height(shape) : 0.0f;
    if (shape.clearing > 0) {
        log_debug("the clearing of the terrain with seed {} lies at y = {} m", shape.seed, level);
    }

    // One row and column more on each side, for the normals at the rim.
    const int n = shape.divisions;
    const int width = n + 3;
    const Vec2 step = shape.size / static_cast<float>(n);
    const auto grid_point = [&](int i, int j) { return Vec2(i, j) * step - 0.5f * shape.size; };
    std::vector<float> heights(static_cast<std::size_t>(width) * static_cast<std::size_t>(width));
    const auto at = [&](int i, int j) -> float& {
        return heights
            [static_cast<std::size_t>(j + 1) * static_cast<std::size_t>(width)
             + static_cast<std::size_t>(i + 1)];
    };
    parallel_for(static_cast<std::size_t>(width), 8, [&](std::size_t begin, std::size_t end) {
        for (int j = static_cast<int>(begin) - 1; j < static_cast<int>(end) - 1; ++j) {
            for (int i = -1; i <= n + 1; ++i) {
                const Vec2 p = grid_point(i, j);
                at(i, j) = height_at(shape, level, p.x, p.y);
            }
        }
    });

    MeshData mesh;
    append_grid(mesh, n, n, {}, [&](int i, int j) {
        const Vec2 p = grid_point(i, j);
        const float rise_x = (at(i + 1, j) - at(i - 1, j)) / (2.0f * step.x);
        const float rise_z = (at(i, j + 1) - at(i, j - 1)) / (2.0f * step.y);
        GridVertex vertex;
        vertex.position = {p.x, at(i, j), p.y};
        vertex.normal = glm::normalize(Vec3(-rise_x, 1, -rise_z));
        vertex.tangent = glm::normalize(Vec3(1, rise_x, 0));
        vertex.uv = Vec2(i, j) / static_cast<float>(n);
        if (shape.colors) {
            mesh.colors.push_back(ground_color(shape, vertex.position, vertex.normal.y));
        }
        return vertex;
    });
    return mesh;
}

}  // namespace limn
