#include "content/bake/tile_surface.h"

#include "ecs/base/check.h"
#include "ecs/components/surface.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace limn {

namespace {

/// Axes of the image and toward the viewer.
struct FaceAxes {
    Vec3 right;
    Vec3 up;
    Vec3 toward;
};

FaceAxes axes_of(BoxFace face) {
    switch (face) {
    case BoxFace::Right:
        return {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}};
    case BoxFace::Left:
        return {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}};
    case BoxFace::Top:
        return {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
    case BoxFace::Bottom:
        return {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
    case BoxFace::Back:
        return {{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
    case BoxFace::Front:
        break;
    }
    return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
}

Vec3 in_axes(const FaceAxes& axes, const Vec3& v) {
    return {glm::dot(axes.right, v), glm::dot(axes.up, v), glm::dot(axes.toward, v)};
}

/// The vertex normals of a mesh; where they are missing or not finite, sums of those of triangles.
std::vector<Vec3> tile_normals(const MeshData& mesh) {
    std::vector<Vec3> sums(mesh.positions.size(), Vec3(0));
    for (std::size_t i = 0; i + 3 <= mesh.indices.size(); i += 3) {
        const Vec3& a = mesh.positions[mesh.indices[i]];
        const Vec3 normal = glm::cross(
            mesh.positions[mesh.indices[i + 1]] - a, mesh.positions[mesh.indices[i + 2]] - a);
        for (std::size_t k = 0; k < 3 && is_finite(normal); ++k) {
            sums[mesh.indices[i + k]] += normal;
        }
    }
    for (std::size_t v = 0; v < sums.size(); ++v) {
        const Vec3 given = v < mesh.normals.size() ? mesh.normals[v] : Vec3(0);
        sums[v] = normalize_or(given, normalize_or(sums[v], Vec3(0, 0, 1)));
    }
    return sums;
}

}  // namespace

TileSurface tile_of(const HeightMap& map, float depth) {
    LIMN_CHECK(map.width > 0 && map.height > 0);
    TileSurface tile;
    const float texel = 1.0f / static_cast<float>(map.width);
    tile.size = {1, static_cast<float>(map.height) * texel};
    tile.depth = depth;
    tile.repeats = map.repeats;
    const std::vector<Vec3> normals = normals_of(map, depth);
    // A map that repeats has its first row and column once more; else its edge texels reach to the
    // edge of the tile.
    tile.low = map.repeats ? Vec2(0.5f * texel) : Vec2(0);
    const int columns = map.width + (map.repeats ? 1 : 2);
    const int rows = map.height + (map.repeats ? 1 : 2);
    const auto place = [&](int i, int count) {
        const auto at = static_cast<float>(i);
        return map.repeats ? at + 0.5f : std::clamp(at - 0.5f, 0.0f, static_cast<float>(count));
    };
    for (int j = 0; j < rows; ++j) {  // from the bottom
        for (int i = 0; i < columns; ++i) {
            const int x = map.repeats ? i % map.width : std::clamp(i - 1, 0, map.width - 1);
            const int up = map.repeats ? j % map.height : std::clamp(j - 1, 0, map.height - 1);
            const int y = map.height - 1 - up;
            const float height = std::clamp(map.at(x, y), 0.0f, 1.0f);
            tile.positions.emplace_back(
                place(i, map.width) * texel, place(j, map.height) * texel, depth * (height - 1));
            tile.normals.push_back(
                normals
                    [static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width)
                     + static_cast<std::size_t>(x)]);
        }
    }
    for (int j = 0; j + 1 < rows; ++j) {
        for (int i = 0; i + 1 < columns; ++i) {
            const auto a = static_cast<std::uint32_t>(j * columns + i);
            const std::uint32_t b = a + static_cast<std::uint32_t>(columns);
            tile.indices.insert(tile.indices.end(), {a, a + 1, b + 1, a, b + 1, b});
        }
    }
    return tile;
}

TileSurface tile_of(const MeshData& mesh, BoxFace face, float depth, bool repeats) {
    const FaceAxes axes = axes_of(face);
    TileSurface tile;
    Bounds box;
    for (const Vec3& p : mesh.positions) {
        tile.positions.push_back(in_axes(axes, p));
        if (is_finite(p)) {
            grow(box, tile.positions.back());
        }
    }
    for (const Vec3& normal : tile_normals(mesh)) {
        tile.normals.push_back(in_axes(axes, normal));
    }
    tile.indices = mesh.indices;
    tile.repeats = repeats;
    if (is_empty(box)) {
        return tile;
    }
    const Vec3 extent = box.max - box.min;
    const float width = std::max(extent.x, 1e-12f);
    for (Vec3& p : tile.positions) {
        p = (p - Vec3(box.min.x, box.min.y, box.max.z)) / width;
    }
    tile.size = {1, std::max(extent.y, 1e-12f) / width};
    tile.meters = width;
    tile.depth = std::max(depth > 0 ? depth : extent.z, 1e-12f) / width;
    return tile;
}

TileCaster::TileCaster(const TileSurface& tile)
    : caster_(tile.positions, tile.indices), low_(tile.low), size_(tile.size),
      box_(caster_.bounds()), repeats_(tile.repeats) {}

std::optional<RayHit> TileCaster::nearest(const MeshRay& ray) const {
    if (!repeats_ || is_empty(box_)) {
        return caster_.nearest(ray);
    }
    // Between the planes of the lowest and the highest point, the ray visits tile after tile. The
    // mesh of a tile that reaches beyond its edges is found only from the tile itself.
    constexpr float kSlack = 1e-4f;
    float begin = ray.min_t;
    float end = ray.max_t;
    const float dz = ray.direction.z;
    if (dz != 0) {
        const float a = (box_.min.z - kSlack - ray.origin.z) / dz;
        const float b = (box_.max.z + kSlack - ray.origin.z) / dz;
        begin = std::max(begin, std::min(a, b));
        end = std::min(end, std::max(a, b));
    } else if (ray.origin.z < box_.min.z - kSlack || ray.origin.z > box_.max.z + kSlack) {
        return std::nullopt;
    }
    LIMN_CHECK(std::isfinite(end) || begin > end);
    float t = begin;
    while (t <= end) {
        // The tile just after t, and where the ray leaves it.
        const float ahead = t + kSlack * std::min(size_.x, size_.y);
        const Vec3 at = ray.origin + ahead * ray.direction;
        const Vec2 tile = glm::floor((Vec2(at) - low_) / size_);
        float leave = end;
        for (int axis = 0; axis < 2; ++axis) {
            const float d = ray.direction[axis];
            if (d != 0) {
                const float edge = low_[axis] + (tile[axis] + (d > 0 ? 1.0f : 0.0f)) * size_[axis];
                leave = std::min(leave, (edge - ray.origin[axis]) / d);
            }
        }
        leave = std::max(leave, ahead);
        MeshRay local = ray;
        local.origin.x -= tile.x * size_.x;
        local.origin.y -= tile.y * size_.y;
        local.min_t = std::max(t - kSlack, ray.min_t);
        local.max_t = std::min(leave + kSlack, ray.max_t);
        if (const std::optional<RayHit> hit = caster_.nearest(local)) {
            return hit;
        }
        t = leave;
    }
    return std::nullopt;
}

Vec3 normal_at(const TileSurface& tile, const RayHit& hit) {
    return normalize_or(at_hit<Vec3>(hit, tile.indices, tile.normals), Vec3(0, 0, 1));
}

}  // namespace limn
