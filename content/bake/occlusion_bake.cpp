#include "content/bake/occlusion_bake.h"

#include "content/bake/relief_bake.h"
#include "ecs/base/check.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {

std::vector<Vec3> cosine_directions(int count) {
    std::vector<Vec3> directions;
    for (int i = 0; i < count; ++i) {
        std::uint32_t bits = static_cast<std::uint32_t>(i);  // reversed: van der Corput's sequence
        bits = (bits << 16u) | (bits >> 16u);
        bits = ((bits & 0x00ff00ffu) << 8u) | ((bits & 0xff00ff00u) >> 8u);
        bits = ((bits & 0x0f0f0f0fu) << 4u) | ((bits & 0xf0f0f0f0u) >> 4u);
        bits = ((bits & 0x33333333u) << 2u) | ((bits & 0xccccccccu) >> 2u);
        bits = ((bits & 0x55555555u) << 1u) | ((bits & 0xaaaaaaaau) >> 1u);
        const float u = (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
        const float angle = 2 * kPi * static_cast<float>(bits) * 0x1p-32f;
        const float radius = std::sqrt(u);
        directions.emplace_back(
            radius * std::cos(angle), radius * std::sin(angle), std::sqrt(1 - u));
    }
    return directions;
}

Vec3 turn_to(const Vec3& direction, const Vec3& normal, std::uint32_t seed) {
    seed = (seed ^ (seed >> 16u)) * 0x7feb352du;
    seed = (seed ^ (seed >> 15u)) * 0x846ca68bu;
    seed ^= seed >> 16u;
    const float angle = 2 * kPi * static_cast<float>(seed) * 0x1p-32f;
    const float c = std::cos(angle);
    const float s = std::sin(angle);
    const Vec3 t = any_perpendicular(normal);
    const Vec3 b = glm::cross(normal, t);
    return (c * direction.x - s * direction.y) * t + (s * direction.x + c * direction.y) * b
           + direction.z * normal;
}

BakedMap bake_occlusion(
    const TileSurface& tile, const TileCaster& caster, int width, int height, int rays, float reach,
    const RowProgress& progress) {
    LIMN_CHECK(rays > 0);
    constexpr float kLift = 1e-4f;  // off the surface, in widths of the tile
    const std::vector<Vec3> directions = cosine_directions(rays);
    BakedMap map = make_baked_map(width, height, Vec4(1));
    bake_rows(height, progress, [&](int y) {
        for (int x = 0; x < width; ++x) {
            const Vec2 at = tile_point(
                tile, width, height, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            const std::optional<RayHit> hit =
                caster.nearest({.origin = Vec3(at, 1e-3f), .max_t = tile.depth + 2e-3f});
            if (!hit) {
                continue;
            }
            const Vec3 surface = normal_at(tile, *hit);
            const Vec3 normal = hit->front ? surface : -surface;
            const Vec3 origin = Vec3(at, 1e-3f - hit->t) + kLift * normal;
            const std::size_t texel = map.at(x, y);
            int open = 0;
            for (const Vec3& direction : directions) {
                const Vec3 to_sky = turn_to(direction, normal, static_cast<std::uint32_t>(texel));
                open +=
                    caster.nearest({.origin = origin, .direction = to_sky, .max_t = reach}) ? 0 : 1;
            }
            const float value = static_cast<float>(open) / static_cast<float>(rays);
            map.texels[texel] = {value, value, value, 1};
        }
    });
    return map;
}

}  // namespace limn
