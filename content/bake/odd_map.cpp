#include "content/bake/odd_map.h"

#include "content/bake/relief_bake.h"
#include "ecs/base/check.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: odd.bake, odd.direction, odd.index-map, odd.map-format, odd.order

namespace limn {

namespace {

constexpr float kOddFine = 0.005f;  // of the index map

}  // namespace

Vec2 odd_angles(const Vec3& to_viewer) {
    // acos(y) and acos(x / sqrt(1 - y^2)), without their loss of precision near 0 and pi.
    const float across = std::hypot(to_viewer.x, to_viewer.z);
    Vec2 angles = {0.5f, std::atan2(across, to_viewer.y) / kPi};
    if (across > 1e-6f) {
        angles.x = std::atan2(std::max(to_viewer.z, 0.0f), to_viewer.x) / kPi;
    }
    return angles;
}

Vec3 odd_direction(const Vec2& angles) {
    const Vec2 a = kPi * angles;
    return {std::cos(a.x) * std::sin(a.y), std::cos(a.y), std::sin(a.x) * std::sin(a.y)};
}

int odd_cell(float angle) {
    return std::clamp(static_cast<int>(angle * kOddDirections), 0, kOddDirections - 1);
}

IVec2 odd_texel(const IVec2& position, const IVec2& direction, OddOrder order) {
    return order == OddOrder::Directions ? kOddPositions * direction + position
                                         : kOddDirections * position + direction;
}

Vec2 odd_coordinates(const Vec2& position, const Vec2& angles, OddOrder order) {
    constexpr float kPositions = kOddPositions;
    constexpr float kDirections = kOddDirections;
    return order == OddOrder::Directions
               ? (glm::floor(kDirections * angles) + glm::fract(position)) / kDirections
               : (glm::floor(kPositions * position) + angles) / kPositions;
}

BakedMap odd_reordered(const BakedMap& map, OddOrder from) {
    const OddOrder to = from == OddOrder::Directions ? OddOrder::Positions : OddOrder::Directions;
    BakedMap other = make_baked_map(map.width, map.height);
    for (int b = 0; b < kOddDirections; ++b) {
        for (int a = 0; a < kOddDirections; ++a) {
            for (int y = 0; y < kOddPositions; ++y) {
                for (int x = 0; x < kOddPositions; ++x) {
                    const IVec2 source = odd_texel({x, y}, {a, b}, from);
                    const IVec2 target = odd_texel({x, y}, {a, b}, to);
                    other.texels[other.at(target.x, target.y)] =
                        map.texels[map.at(source.x, source.y)];
                }
            }
        }
    }
    return other;
}

BakedMap bake_odd(
    const TileSurface& tile, const TileCaster& caster, OddOrder order,
    const RowProgress& progress) {
    constexpr int kSize = kOddPositions * kOddDirections;
    BakedMap map = make_baked_map(kSize, kSize);
    const float scale = 1 / (kOddDistance * tile.depth);
    const auto bake_texel = [&](const IVec2& position, const IVec2& direction) {
        const Vec2 at = tile_point(
            tile, kOddPositions, kOddPositions, static_cast<float>(position.x) + 0.5f,
            static_cast<float>(position.y) + 0.5f);
        const Vec3 to_viewer = odd_direction((Vec2(direction) + 0.5f) / float{kOddDirections});
        const float lead = 0.01f * tile.depth;  // from above the polygon, to hit a surface on it
        const std::optional<RayHit> hit = caster.nearest(
            {.origin = Vec3(at, 0) + lead * to_viewer,
             .direction = -to_viewer,
             .max_t = 1 / scale + lead});
        const Vec3 normal = hit ? normal_at(tile, *hit) : Vec3(0, 0, 1);
        const float distance = hit ? std::min(std::max(hit->t - lead, 0.0f) * scale, 1.0f) : 1.0f;
        const IVec2 texel = odd_texel(position, direction, order);
        map.texels[map.at(texel.x, texel.y)] = Vec4(encode_normal(normal), distance);
    };
    bake_rows(kOddPositions * kOddDirections, progress, [&](int row) {
        for (int a = 0; a < kOddDirections; ++a) {
            for (int x = 0; x < kOddPositions; ++x) {
                bake_texel({x, row % kOddPositions}, {a, row / kOddPositions});
            }
        }
    });
    return map;
}

BakedMap make_odd_index_map(int size) {
    BakedMap map = make_baked_map(size, size);
    const auto coarse = [](float angle) { return std::floor(255 * angle) / 255; };
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            Vec2 cosines = 2.0f * (Vec2(x, y) + 0.5f) / static_cast<float>(size) - 1.0f;
            const float length = glm::length(cosines);
            cosines = length > 1 ? cosines / length : cosines;
            const float up = std::sqrt(std::max(1 - glm::dot(cosines, cosines), 0.0f));
            const Vec2 angles = odd_angles(Vec3(cosines, up));
            const Vec2 low = {coarse(angles.x), coarse(angles.y)};
            map.texels[map.at(x, y)] = Vec4(low, (angles - low) / kOddFine);
        }
    }
    return map;
}

Vec2 decode_odd_index(const Vec4& rgba) {
    return Vec2(rgba.x, rgba.y) + kOddFine * Vec2(rgba.z, rgba.w);
}

}  // namespace limn
