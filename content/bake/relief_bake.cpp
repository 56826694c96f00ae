#include "content/bake/relief_bake.h"

#include "ecs/base/check.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

// Techniques: bump.nm-from-basrelief, relief.map-bake

namespace limn {

namespace {

/// What one ray sees.
struct ReliefSample {
    ReliefTexel texel;
    bool hit = false;
    bool open = false;
};

ReliefSample cast_relief(
    const TileSurface& tile, const TileCaster& caster, ReliefLayout layout, const Vec2& at,
    std::vector<RayHit>& hits) {
    // Down to the floor of the relief, from a little above the polygon, so that a surface on it is
    // not missed. t - kLead is the depth.
    constexpr float kLead = 0x1p-6f;
    const MeshRay ray = {
        .origin = Vec3(at, kLead * tile.depth),
        .direction = {0, 0, -tile.depth},
        .max_t = 1 + kLead + 1e-6f};
    ReliefSample sample;
    const std::optional<RayHit> front = caster.single().nearest(ray);
    if (!front) {
        return sample;
    }
    sample.hit = true;
    sample.texel.depth = std::clamp(front->t - kLead, 0.0f, 1.0f);
    Vec3 normal = normal_at(tile, *front);
    normal = !front->front && normal.z < 0 ? -normal : normal;  // of a sheet seen from behind
    normal.z = std::max(normal.z, 0.0f);
    sample.texel.normal = normalize_or(normal, Vec3(0, 0, 1));
    if (layout == ReliefLayout::Double) {
        caster.single().find_all(ray, hits);
        sample.open = hits.empty() || hits.back().front;
        sample.texel.back =
            sample.open ? 1.0f : std::clamp(hits.back().t - kLead, sample.texel.depth, 1.0f);
    }
    return sample;
}

}  // namespace

int rows_of(const Vec2& tile_size, int width) {
    const float rows = tile_size.y / tile_size.x * static_cast<float>(width);
    return std::max(static_cast<int>(std::lround(std::min(rows, 65536.0f))), 1);
}

Vec2 tile_point(const TileSurface& tile, int width, int height, float x, float y) {
    return {
        x / static_cast<float>(width) * tile.size.x,
        (1 - y / static_cast<float>(height)) * tile.size.y};
}

ReliefBake bake_relief(
    const TileSurface& tile, const TileCaster& caster, ReliefLayout layout, int width, int samples,
    const RowProgress& progress) {
    LIMN_CHECK(width > 0 && samples > 0 && layout != ReliefLayout::Cone);
    const int height = rows_of(tile.size, width);
    ReliefBake bake = {.map = make_baked_map(width, height)};
    std::atomic<std::size_t> empty = 0;
    std::atomic<std::size_t> open = 0;
    const auto bake_texel = [&](int x, int y, std::vector<RayHit>& hits) {
        ReliefTexel sum = {.normal = Vec3(0), .depth = 0, .back = 0};
        float count = 0;
        bool any_hit = false;
        bool any_open = false;
        for (int j = 0; j < samples; ++j) {
            for (int i = 0; i < samples; ++i) {
                const auto center = [samples](int texel, int k) {
                    return static_cast<float>(texel)
                           + (static_cast<float>(k) + 0.5f) / static_cast<float>(samples);
                };
                const Vec2 at = tile_point(tile, width, height, center(x, i), center(y, j));
                const ReliefSample sample = cast_relief(tile, caster, layout, at, hits);
                if (!sample.hit && layout == ReliefLayout::Double) {
                    continue;
                }
                count += 1;
                sum.normal += sample.texel.normal;
                sum.depth += sample.texel.depth;
                sum.back += sample.texel.back;
                any_hit = any_hit || sample.hit;
                any_open = any_open || sample.open;
            }
        }
        sum.normal = normalize_or(sum.normal, Vec3(0, 0, 1));
        sum.depth = count > 0 ? sum.depth / count : 1.0f;
        sum.back = count > 0 ? sum.back / count : 1.0f;
        empty += any_hit ? 0 : 1;
        open += any_open ? 1 : 0;
        bake.map.texels[bake.map.at(x, y)] = encode_relief(sum, layout);
    };
    bake_rows(height, progress, [&](int y) {
        std::vector<RayHit> hits;
        for (int x = 0; x < width; ++x) {
            bake_texel(x, y, hits);
        }
    });
    bake.empty = empty;
    bake.open = open;
    return bake;
}

HeightMap heights_of(const BakedMap& relief, bool repeats) {
    HeightMap map = {.width = relief.width, .height = relief.height, .repeats = repeats};
    for (const Vec4& texel : relief.texels) {
        map.heights.push_back(1 - texel.w);
    }
    return map;
}

}  // namespace limn
