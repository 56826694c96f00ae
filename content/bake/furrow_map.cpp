#include "content/bake/furrow_map.h"

#include "content/bake/tangents.h"
#include "ecs/base/check.h"
#include "ecs/base/text.h"
#include "ecs/components/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

// Techniques: wrinkle.furrow.map-cylinder, wrinkle.furrow.map-planar

namespace limn {
namespace {

constexpr float kMargin = 0.01f;   // of a planar image, on each side
constexpr float kMinArea = 1e-6f;  // twice the area of a triangle [px^2]
constexpr float kMaxCopies = 8;    // of a triangle in an image that repeats, per axis

/// A corner of a flattened triangle.
struct Corner {
    Vec2 pixel = {0, 0};  ///< position [px]
    Vec2 field[2] = {};   ///< in pixel directions: right and down
    Vec3 normal = {0, 0, 1};
};
using MapCorners = std::array<Corner, 3>;

Vec2 cross_gradient(const Vec2& ab, const Vec2& ac, float b, float c, float area) {
    return Vec2(b * ac.y - c * ab.y, c * ab.x - b * ac.x) / area;
}

/// Nothing where the triangle is degenerate.
std::optional<FurrowTriangle> set_up(MapCorners corners) {
    Vec2 ab = corners[1].pixel - corners[0].pixel;
    Vec2 ac = corners[2].pixel - corners[0].pixel;
    float area = ab.x * ac.y - ab.y * ac.x;
    if (!(std::abs(area) > kMinArea) || !std::isfinite(area)) {
        return std::nullopt;
    }
    if (area < 0) {
        std::swap(corners[1], corners[2]);
        std::swap(ab, ac);
        area = -area;
    }
    FurrowTriangle triangle = {};
    for (int i = 0; i < 3; ++i) {
        triangle.corner[i] = corners[i].pixel;
    }
    for (int f = 0; f < 2; ++f) {
        triangle.field[f] = corners[0].field[f];
        for (int c = 0; c < 2; ++c) {
            const float at = corners[0].field[f][c];
            const Vec2 gradient = cross_gradient(
                ab, ac, corners[1].field[f][c] - at, corners[2].field[f][c] - at, area);
            triangle.field_right[f][c] = gradient.x;
            triangle.field_down[f][c] = gradient.y;
        }
    }
    triangle.normal = corners[0].normal;
    for (int c = 0; c < 3; ++c) {
        const float at = corners[0].normal[c];
        const Vec2 gradient =
            cross_gradient(ab, ac, corners[1].normal[c] - at, corners[2].normal[c] - at, area);
        triangle.normal_right[c] = gradient.x;
        triangle.normal_down[c] = gradient.y;
    }
    return triangle;
}

/// By which image offsets to the right (or downwards) a part of the surface between `from` and `to`
/// must be copied to overlap the first image: from `first` to `last`.
struct Copies {
    int first = 0;
    int last = 0;
};

std::optional<Copies> copies_of(bool wrap, float from, float to, float length) {
    if (!wrap) {
        return Copies{};
    }
    const float first = -std::floor(to / length);
    const float last = -std::floor(from / length);
    if (!(last - first <= kMaxCopies) || !(std::abs(first) < 1e6f)) {
        return std::nullopt;
    }
    return Copies{static_cast<int>(first), static_cast<int>(last)};
}

/// Adds the triangle, and its copies that overlap a repeating image from beyond its borders.
void add_triangle(FurrowMap& map, const MapCorners& corners) {
    const std::optional<FurrowTriangle> triangle = set_up(corners);
    const Vec2 low = glm::min(corners[0].pixel, glm::min(corners[1].pixel, corners[2].pixel));
    const Vec2 high = glm::max(corners[0].pixel, glm::max(corners[1].pixel, corners[2].pixel));
    const Vec2 size(map.size);
    const std::optional<Copies> right = copies_of(map.wrap_s, low.x, high.x, size.x);
    const std::optional<Copies> down = copies_of(map.wrap_t, low.y, high.y, size.y);
    if (!triangle || !right || !down) {
        return;
    }
    for (int t = down->first; t <= down->last; ++t) {
        for (int s = right->first; s <= right->last; ++s) {
            FurrowTriangle copy = *triangle;
            for (Vec2& corner : copy.corner) {
                corner += Vec2(s, t) * size;
            }
            map.triangles.push_back(copy);
        }
    }
}

/// The corners of triangle `t`, before flattening.
struct Source {
    Vec3 position[3];
    Vec3 normal[3];
    FurrowVectors field[3];
};

Source source_of(const MeshData& mesh, std::span<const FurrowVectors> field, std::size_t t) {
    Source source;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t vertex = mesh.indices[3 * t + i];
        source.position[i] = mesh.positions[vertex];
        source.normal[i] = mesh.normals[vertex];
        source.field[i] = field[vertex];
    }
    return source;
}

void lay_by_uv(const MeshData& mesh, std::span<const FurrowVectors> field, FurrowMap& map) {
    for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
        const Source source = source_of(mesh, field, t);
        const Vec2 uv[3] = {
            mesh.uvs[mesh.indices[3 * t]], mesh.uvs[mesh.indices[3 * t + 1]],
            mesh.uvs[mesh.indices[3 * t + 2]]};
        const TriangleFrame frame = triangle_frame(source.position, uv);
        // d = a dP/du + b dP/dv, by least squares: d may not lie in the triangle's plane.
        const float uu = glm::dot(frame.tangent, frame.tangent);
        const float uv_dot = glm::dot(frame.tangent, frame.bitangent);
        const float vv = glm::dot(frame.bitangent, frame.bitangent);
        const float determinant = uu * vv - uv_dot * uv_dot;
        if (!(determinant > 0)) {
            continue;
        }
        MapCorners corners;
        for (int i = 0; i < 3; ++i) {
            corners[i].pixel = uv[i] * Vec2(map.size);
            for (int f = 0; f < 2; ++f) {
                const Vec3& d = source.field[i][f];
                const float u = glm::dot(d, frame.tangent);
                const float v = glm::dot(d, frame.bitangent);
                const Vec2 along(u * vv - v * uv_dot, v * uu - u * uv_dot);
                const Vec2 pixels = along * Vec2(map.size);
                const float length = glm::length(pixels);
                corners[i].field[f] = length > 0 ? pixels * (glm::length(d) / length) : Vec2(0);
            }
        }
        add_triangle(map, corners);
    }
}

void lay_planar(const MeshData& mesh, std::span<const FurrowVectors> field, FurrowMap& map) {
    Bounds bounds;
    for (const std::uint32_t index : mesh.indices) {
        grow(bounds, mesh.positions[index]);
    }
    const Vec3 extent = bounds.max - bounds.min;
    const float scale =
        (1.0f - 2.0f * kMargin) * static_cast<float>(map.size.x) / std::max(extent.x, extent.y);
    const Vec3 origin = center(bounds);
    for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
        const Source source = source_of(mesh, field, t);
        const Vec3 face = glm::cross(
            source.position[1] - source.position[0], source.position[2] - source.position[0]);
        if (!(face.z > 0)) {
            continue;  // back face
        }
        MapCorners corners;
        for (int i = 0; i < 3; ++i) {
            const Vec3 p = (source.position[i] - origin) * scale;
            corners[i].pixel = 0.5f * Vec2(map.size) + Vec2(p.x, -p.y);
            corners[i].normal = source.normal[i];
            for (int f = 0; f < 2; ++f) {
                corners[i].field[f] = {source.field[i][f].x, -source.field[i][f].y};
            }
        }
        add_triangle(map, corners);
    }
}

bool is_on_axis(const Vec3& p) {
    return p.x == 0 && p.z == 0;
}

/// The angles of the corners of a triangle, less than half a turn apart. A corner on the axis has
/// the mean of the others.
std::array<float, 3> triangle_angles(const Source& source) {
    std::array<float, 3> angles = {};
    float sum = 0;
    int count = 0;
    float first = 0;
    for (int i = 0; i < 3; ++i) {
        if (is_on_axis(source.position[i])) {
            continue;
        }
        angles[i] = cylinder_angle(source.position[i]);
        first = count == 0 ? angles[i] : first;
        angles[i] -= 2.0f * kPi * std::round((angles[i] - first) / (2.0f * kPi));
        sum += angles[i];
        ++count;
    }
    for (int i = 0; i < 3; ++i) {
        if (is_on_axis(source.position[i]) && count > 0) {
            angles[i] = sum / static_cast<float>(count);
        }
    }
    return angles;
}

Status lay_cylinder(const MeshData& mesh, std::span<const FurrowVectors> field, FurrowMap& map) {
    double radius = 0;
    float low = INFINITY;
    float high = -INFINITY;
    for (const std::uint32_t index : mesh.indices) {
        const Vec3& p = mesh.positions[index];
        radius += std::sqrt(static_cast<double>(p.x) * p.x + static_cast<double>(p.z) * p.z);
        low = std::min(low, p.y);
        high = std::max(high, p.y);
    }
    const float turn =
        2.0f * kPi * static_cast<float>(radius / static_cast<double>(mesh.indices.size()));
    const float scale = static_cast<float>(map.size.x) / turn;  // [px/m]
    const float rows = std::round((high - low) * scale);
    if (!(rows <= kMaxFurrowSize)) {
        return Error{fmt::format(
            "{}: found {:.4g} m along y and {:.4g} m around it, {:.0f} rows of pixels, expected at "
            "most {}",
            mesh.name, high - low, turn, rows, kMaxFurrowSize)};
    }
    map.size.y = std::max(static_cast<int>(rows), 1);
    for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
        const Source source = source_of(mesh, field, t);
        const std::array<float, 3> angles = triangle_angles(source);
        MapCorners corners;
        for (int i = 0; i < 3; ++i) {
            corners[i].pixel = {
                angles[i] / (2.0f * kPi) * static_cast<float>(map.size.x),
                (high - source.position[i].y) * scale};
            corners[i].normal = unroll_vector(source.normal[i], angles[i]);
            for (int f = 0; f < 2; ++f) {
                const Vec3 flat = unroll_vector(source.field[i][f], angles[i]);
                corners[i].field[f] = {flat.x, -flat.y};
            }
        }
        add_triangle(map, corners);
    }
    return Done{};
}

}  // namespace

float cylinder_angle(const Vec3& p) {
    const float r = std::sqrt(p.x * p.x + p.z * p.z);
    if (!(r > 0)) {
        return 0;
    }
    const float angle = std::acos(std::clamp(p.z / r, -1.0f, 1.0f));
    return p.x > 0 ? angle : 2.0f * kPi - angle;
}

Vec3 unroll_vector(const Vec3& v, float s) {
    const float c = std::cos(s);
    const float sine = std::sin(s);
    return {v.x * c - v.z * sine, v.y, v.x * sine + v.z * c};
}

Result<FurrowMap> make_furrow_map(
    const MeshData& mesh, std::span<const FurrowVectors> field, const FurrowMapShape& shape) {
    LIMN_CHECK(field.size() == mesh.positions.size());
    LIMN_CHECK(mesh.normals.size() == mesh.positions.size());
    LIMN_CHECK(shape.size >= 1 && shape.size <= kMaxFurrowSize);
    FurrowMap map;
    map.size = IVec2(shape.size);
    if (shape.projection == FurrowProjection::Uv) {
        if (mesh.uvs.size() != mesh.positions.size()) {
            return fail("{}: found no texture coordinates, expected some", mesh.name);
        }
        map.wrap_s = map.wrap_t = shape.tiles;
        lay_by_uv(mesh, field, map);
    } else if (shape.projection == FurrowProjection::Planar) {
        lay_planar(mesh, field, map);
    } else {
        map.wrap_s = true;
        LIMN_TRY(lay_cylinder(mesh, field, map));
    }
    if (map.triangles.empty()) {
        return fail(
            "{}: found no triangle with an area in the image, expected at least one", mesh.name);
    }
    return map;
}

}  // namespace limn
