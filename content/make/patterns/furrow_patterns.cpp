#include "content/make/patterns/furrow_patterns.h"

#include "content/bake/furrow_map.h"
#include "content/bake/skin_cells.h"
#include "content/make/models/body_part.h"
#include "ecs/base/check.h"
#include "ecs/base/jobs.h"
#include "ecs/components/surface.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

// Techniques: wrinkle.furrow.polygon-models

namespace limn {
namespace {

constexpr int kDivisions = 32;       // quads along each side of a surface
constexpr float kPadHeight = 0.22f;  // [m]; by eye
constexpr float kPadRadius = 0.46f;  // [m]

/// Height and slopes of the elevation at a point: a smooth bump that flattens out at its rim.
Vec3 pad_at(const Vec2& p) {
    const float q = 1.0f - glm::dot(p, p) / square(kPadRadius);
    if (q <= 0) {
        return Vec3(0);
    }
    const Vec2 slope = kPadHeight * -4.0f * q * p / square(kPadRadius);
    return {kPadHeight * q * q, slope.x, slope.y};
}

/// Height and normals that become maps, in rows from top to bottom.
struct Relief {
    IVec2 size = {0, 0};
    std::vector<float> height;
    std::vector<Vec3> normals;
};

Relief grow(const FurrowMap& map, const FurrowsPattern& pattern) {
    const FurrowStyle style = style_of(pattern.recipe);
    const FurrowGrowth growth = grow_furrows(map, style);
    Relief relief;
    relief.size = map.size;
    relief.height = add_furrow_noise(growth, style);
    if (pattern.cells >= 2 && map.size.x == map.size.y) {
        const auto cells =
            make_skin_cells(map.size.x, {.cells = pattern.cells, .seed = style.seed});
        for (std::size_t i = 0; i < cells.size(); ++i) {
            relief.height[i] -= pattern.cell_depth * (1.0f - glm::smoothstep(0.0f, 0.5f, cells[i]));
        }
    }
    relief.normals = make_furrow_normals(map, growth, relief.height, style.bump);
    return relief;
}

/// The relief of a limb by planar projection from the front and, mirrored, from the back, resampled
/// to the image of the unrolled limb.
Relief unroll_planar(const Relief& planar, const MeshData& mesh) {
    Relief limb = planar;
    float radius = 0;
    for (const Vec3& p : mesh.positions) {
        radius = std::max(radius, p.x);
    }
    const auto size = static_cast<float>(planar.size.x);
    for (int y = 0; y < planar.size.y; ++y) {
        for (int x = 0; x < planar.size.x; ++x) {
            const float s = 2.0f * kPi * (static_cast<float>(x) + 0.5f) / size;
            const float across = radius * std::sin(s);  // [m]; the image shows 1 m in 98 % of it
            const float down = (static_cast<float>(y) + 0.5f) / size - 0.5f;
            const IVec2 from = glm::clamp(
                IVec2(glm::floor((0.5f + 0.98f * Vec2(across, down)) * size)), IVec2(0),
                planar.size - 1);
            const auto source = static_cast<std::size_t>(from.y * planar.size.x + from.x);
            const auto target = static_cast<std::size_t>(y * planar.size.x + x);
            Vec3 n = planar.normals[source];
            n.z *= std::cos(s) < 0 ? -1.0f : 1.0f;
            const Vec3 flat = unroll_vector(n, s);
            limb.height[target] = planar.height[source];
            limb.normals[target] = glm::normalize(Vec3(flat.x, flat.y, std::max(flat.z, 0.05f)));
        }
    }
    return limb;
}

Relief make_relief(const FurrowsPattern& pattern) {
    MeshData mesh = make_furrow_surface(pattern.surface);
    FurrowRecipe recipe = pattern.recipe;
    Result<FurrowMap> map = lay_out_furrows(mesh, recipe);
    if (!map || map->size.y != recipe.size) {
        const auto pixels =
            static_cast<std::size_t>(recipe.size) * static_cast<std::size_t>(recipe.size);
        return {
            IVec2(recipe.size), std::vector<float>(pixels, 1.0f),
            std::vector<Vec3>(pixels, Vec3(0, 0, 1))};
    }
    if (!pattern.smooth_normals) {
        for (FurrowTriangle& t : map->triangles) {
            t.normal = {0, 0, 1};
            t.normal_right = t.normal_down = Vec3(0);
        }
    }
    const Relief relief = grow(*map, pattern);
    const bool unrolls =
        pattern.surface == FurrowSurface::Limb && recipe.projection == FurrowProjection::Planar;
    return unrolls ? unroll_planar(relief, mesh) : relief;
}

}  // namespace

MeshData make_furrow_surface(FurrowSurface surface) {
    if (surface == FurrowSurface::Hand || surface == FurrowSurface::Foot) {
        const bool hand = surface == FurrowSurface::Hand;
        return make_body_part(
            {.part = hand ? BodyPartKind::Hand : BodyPartKind::Foot, .length = 1, .cells = 64});
    }
    MeshData mesh;
    mesh.name = "furrows";
    const float radius = 1.0f / (2.0f * kPi);
    for (int j = 0; j <= kDivisions; ++j) {
        for (int i = 0; i <= kDivisions; ++i) {
            const Vec2 uv = Vec2(i, j) / static_cast<float>(kDivisions);
            const Vec2 p(uv.x - 0.5f, 0.5f - uv.y);
            const float s = 2.0f * kPi * uv.x;
            mesh.uvs.push_back(uv);
            if (surface == FurrowSurface::Limb) {
                mesh.normals.emplace_back(std::sin(s), 0, std::cos(s));
                mesh.positions.emplace_back(radius * std::sin(s), p.y, radius * std::cos(s));
                continue;
            }
            const Vec3 pad = surface == FurrowSurface::Pad ? pad_at(p) : Vec3(0);
            mesh.positions.emplace_back(p, pad.x);
            mesh.normals.push_back(glm::normalize(Vec3(-pad.y, -pad.z, 1)));
        }
    }
    for (std::uint32_t j = 0; j < kDivisions; ++j) {
        for (std::uint32_t i = 0; i < kDivisions; ++i) {
            const std::uint32_t a = j * (kDivisions + 1) + i;  // upper left
            const std::uint32_t b = a + kDivisions + 1;
            mesh.indices.insert(mesh.indices.end(), {a, b, b + 1, a, b + 1, a + 1});
        }
    }
    return mesh;
}

PatternMaps make_furrows(const FurrowsPattern& pattern) {
    const Relief relief = make_relief(pattern);
    const int size = relief.size.x;
    PatternMaps maps = make_pattern_maps(size, [&](const Vec2& uv) {
        const IVec2 at(uv * static_cast<float>(size));
        const float height = relief.height[static_cast<std::size_t>(at.y * size + at.x)];
        const float depth = std::clamp(1.0f - height, 0.0f, 1.0f);
        PatternTexel t;
        t.color = pattern.color * (1.0f - 0.25f * depth);
        t.roughness = std::min(pattern.roughness * (1.0f + 0.3f * depth), 1.0f);
        t.occlusion = 1.0f - 0.5f * depth;
        return t;
    });
    parallel_for(relief.normals.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            for (int c = 0; c < 3; ++c) {
                maps.normal.pixels[4 * i + static_cast<std::size_t>(c)] =
                    static_cast<std::uint8_t>(std::lround(127.5f + 127.5f * relief.normals[i][c]));
            }
        }
    });
    return maps;
}

}  // namespace limn
