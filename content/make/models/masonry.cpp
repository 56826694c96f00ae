#include "content/make/models/masonry.h"

#include "content/make/models/surface_grid.h"
#include "ecs/base/check.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace limn {

namespace {

/// A flat grid of points; its texture coordinates are meters along `right` and against `up`.
void append_flat(
    MeshData& mesh, const Vec3& right, const Vec3& up, std::span<const float> columns,
    std::span<const float> rows, float depth) {
    const Vec3 out = glm::cross(right, up);
    append_grid(
        mesh, static_cast<int>(columns.size()) - 1, static_cast<int>(rows.size()) - 1, {},
        [&](int i, int j) {
            const float x = columns[static_cast<std::size_t>(i)];
            const float y = rows[static_cast<std::size_t>(j)];
            return GridVertex{x * right + y * up + depth * out, out, right, {x, -y}};
        });
}

/// A point of a curve in the x-y plane along which a section is swept.
struct SweepPoint {
    Vec2 position;
    Vec2 normal;       ///< to the left of the curve, unit
    float miter = 1;   ///< factor of offsets at a corner
    float length = 0;  ///< arc length from its start [m]
};

/// The left half of a curve up to the top (mirrored), or the right half down from it; `right_half`
/// runs from the bottom to the top.
std::vector<SweepPoint>
half_curve(std::span<const CurvePoint> right_half, bool is_left, float begin) {
    std::vector<SweepPoint> path;
    for (const CurvePoint& point : right_half) {
        path.push_back({point.position, point.normal});
    }
    // The two halves meet in a corner, where offsets go straight up.
    path.back().miter = 1.0f / path.back().normal.y;
    if (is_left) {
        for (SweepPoint& point : path) {
            point.position.x = -point.position.x;
            point.normal.x = -point.normal.x;
        }
    } else {
        std::reverse(path.begin(), path.end());
    }
    float length = begin;
    for (std::size_t i = 0; i < path.size(); ++i) {
        length += i > 0 ? glm::distance(path[i - 1].position, path[i].position) : 0.0f;
        path[i].length = length;
    }
    return path;
}

/// A corner of the swept section: its offset along the curve's normal, and along z.
struct SectionPoint {
    float offset;
    float z;
};

Vec3 swept(const SweepPoint& point, const SectionPoint& corner) {
    const bool is_top = point.miter != 1.0f;
    const Vec2 direction = is_top ? Vec2(0, point.miter) : point.normal;
    return {point.position + corner.offset * direction, corner.z};
}

/// Sweeps one side of a section, from corner `a` to corner `b`.
void append_side(
    MeshData& mesh, std::span<const SweepPoint> path, const SectionPoint& a, const SectionPoint& b,
    float v) {
    const Vec2 step = Vec2(b.offset - a.offset, b.z - a.z);
    const float width = glm::length(step);
    const Vec2 normal = Vec2(step.y, -step.x) / width;  // along the curve's normal, and along z
    append_grid(mesh, static_cast<int>(path.size()) - 1, 1, {}, [&](int i, int j) {
        const SweepPoint& point = path[static_cast<std::size_t>(i)];
        GridVertex vertex;
        vertex.position = swept(point, j == 0 ? a : b);
        vertex.normal = {normal.x * point.normal, normal.y};
        vertex.tangent = {point.normal.y, -point.normal.x, 0};
        vertex.uv = {point.length, v + (j == 0 ? 0.0f : width)};
        return vertex;
    });
}

/// A convex polygon, counter-clockwise when viewed from the front.
void append_polygon(
    MeshData& mesh, std::span<const Vec3> points, const Vec3& normal, const Vec3& tangent) {
    const Vec3 up = glm::cross(normal, tangent);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3& p : points) {
        mesh.positions.push_back(p);
        mesh.normals.push_back(normal);
        mesh.tangents.push_back(Vec4(tangent, 1.0f));
        mesh.uvs.push_back({glm::dot(p, tangent), -glm::dot(p, up)});
        grow(mesh.bounds, p);
    }
    for (std::uint32_t i = 2; i < points.size(); ++i) {
        mesh.indices.insert(mesh.indices.end(), {first, first + i - 1, first + i});
    }
}

/// Right half of the outline of a wall's opening, from the bottom to the top.
std::vector<CurvePoint> opening_outline(const MasonryWall& shape, const Vec3& size) {
    constexpr float kMinMargin = 0.01f;  // beside and above the opening / wall size
    const float span = std::min(shape.span, (1.0f - kMinMargin) * size.x);
    if (shape.round) {
        const float radius = std::min(0.5f * span, (0.5f - kMinMargin) * size.y);
        const float center = std::clamp(
            shape.spring, radius + kMinMargin * size.y, (1.0f - kMinMargin) * size.y - radius);
        std::vector<CurvePoint> outline;
        const int steps = 2 * shape.segments;
        for (int i = 0; i <= steps; ++i) {
            const double angle = 3.14159265358979323846 * (static_cast<double>(i) / steps - 0.5);
            const Vec2 out = {
                i % steps == 0 ? 0.0f : static_cast<float>(std::cos(angle)),
                static_cast<float>(std::sin(angle))};
            outline.push_back({Vec2(0, center) + radius * out, out});
        }
        return outline;
    }
    const float highest = (1.0f - kMinMargin) * size.y;
    const float spring = std::min(shape.spring, 0.9f * highest);
    const float rise = std::min(shape.rise, highest - spring);
    const float sill = std::min(shape.sill, spring);
    std::vector<CurvePoint> outline = pointed_curve(span, rise, shape.radius, shape.segments);
    for (CurvePoint& point : outline) {
        point.position.y += spring;
    }
    if (sill < spring) {
        outline.insert(outline.begin(), CurvePoint{{outline.front().position.x, sill}, {1, 0}});
    }
    return outline;
}

/// The faces left and right of an opening, on the front (facing = 1) or the back (-1) of a wall.
void append_beside_opening(
    MeshData& mesh, std::span<const CurvePoint> outline, float facing, float half_x, float half_z) {
    for (const float side : {-1.0f, 1.0f}) {
        append_grid(mesh, 1, static_cast<int>(outline.size()) - 1, {}, [&](int i, int j) {
            const Vec2 edge = outline[outline.size() - 1 - static_cast<std::size_t>(j)].position;
            const bool is_outside = (i == 0) == (side < 0);
            const float x = side * (is_outside ? half_x : edge.x);
            return GridVertex{
                {facing * x, edge.y, facing * half_z},
                {0, 0, facing},
                {facing, 0, 0},
                {x, -edge.y}};
        });
    }
}

/// The curve of a vault for a half span of 1 m: x is relative to the half span, y the height [m].
std::vector<CurvePoint> vault_curve(const VaultShape& shape) {
    return pointed_curve(2.0f, shape.rise, std::max(shape.radius, 0.5f), shape.segments);
}

/// Lower and upper side of half a web of a vault, from the center to one corner; the web is level
/// along `level` and falls along `fall`.
void append_web(
    MeshData& mesh, const VaultShape& shape, float half_level, float half_fall, const Vec3& level,
    const Vec3& fall) {
    const std::vector<CurvePoint> curve = vault_curve(shape);
    const int n = shape.segments;
    const auto down = [&](int j) { return curve[static_cast<std::size_t>(n - j)]; };
    std::vector<float> arc_lengths = {0};
    for (int j = 1; j <= n; ++j) {
        const Vec2 step = down(j).position - down(j - 1).position;
        arc_lengths.push_back(arc_lengths.back() + glm::length(step * Vec2(half_fall, 1)));
    }
    for (const float facing : {-1.0f, 1.0f}) {
        const float lift = facing > 0 ? shape.thickness : 0.0f;
        // Viewed from the front, columns run to the right: from the groin to the wall, or reversed.
        const bool outwards = facing * glm::dot(glm::cross(level, Vec3(0, 1, 0)), fall) > 0;
        append_grid(mesh, n, n, {false, true}, [&](int i, int j) {
            const CurvePoint at = down(j);
            const int column = outwards ? i : n - i;
            // At the groin both webs have the same height and the same relative position.
            const float between = static_cast<float>(column) / static_cast<float>(n);
            const float level_fraction =
                column == n ? 1.0f : at.position.x + (1.0f - at.position.x) * between;
            GridVertex vertex;
            vertex.position = half_level * level_fraction * level + half_fall * at.position.x * fall
                              + Vec3(0, at.position.y + lift, 0);
            vertex.normal =
                facing * glm::normalize(at.normal.x / half_fall * fall + Vec3(0, at.normal.y, 0));
            vertex.tangent = outwards ? level : -level;
            vertex.uv = {
                (outwards ? half_level : -half_level) * level_fraction,
                arc_lengths[static_cast<std::size_t>(j)]};
            return vertex;
        });
    }
}

/// The visible thickness of a vault at one of its four walls.
void append_vault_side(
    MeshData& mesh, const VaultShape& shape, float half_out, float half_along, const Vec3& out) {
    const std::vector<CurvePoint> curve = vault_curve(shape);
    const int n = shape.segments;
    const Vec3 right = glm::cross(Vec3(0, 1, 0), out);
    append_grid(mesh, 2 * n, 1, {}, [&](int i, int j) {
        const Vec2 at = curve[static_cast<std::size_t>(i < n ? i : 2 * n - i)].position;
        const float x = half_along * (i < n ? -at.x : at.x);
        const float y = at.y + (j == 0 ? shape.thickness : 0.0f);
        return GridVertex{half_out * out + x * right + Vec3(0, y, 0), out, right, {x, -y}};
    });
}

}  // namespace

std::vector<CurvePoint> pointed_curve(float span, float rise, float radius, int segments) {
    LIMN_CHECK(span > 0 && rise > 0 && segments >= 1);
    const double half = 0.5 * static_cast<double>(span);
    const double ratio = static_cast<double>(rise) / half;
    // In half spans: an arc of radius r about (1 - r, 0) from (1, 0) to (0, sqrt(2 r - 1)).
    const double fitting = 0.5 * (ratio * ratio + 1.0);
    const double r = std::max(radius > 0 ? 2.0 * static_cast<double>(radius) : fitting, 1.0);
    const double stretch = static_cast<double>(rise) / (half * std::sqrt(2.0 * r - 1.0));
    const double last = std::acos((r - 1.0) / r);
    std::vector<CurvePoint> points;
    for (int i = 0; i <= segments; ++i) {
        const double angle = last * i / segments;
        const glm::dvec2 arc = {std::cos(angle), std::sin(angle)};
        const glm::dvec2 position = {half * (1.0 - r + r * arc.x), half * stretch * r * arc.y};
        const glm::dvec2 normal = glm::normalize(glm::dvec2(arc.x * stretch, arc.y));
        points.push_back({Vec2(position), Vec2(normal)});
    }
    points.front() = {{0.5f * span, 0}, {1, 0}};
    points.back().position = {0, rise};
    if (r <= 1.0) {
        points.back().normal = {0, 1};
    }
    return points;
}

MeshData make_arch(const ArchShape& shape) {
    LIMN_CHECK(shape.thickness > 0 && shape.depth > 0 && shape.legs >= 0);
    std::vector<CurvePoint> curve =
        pointed_curve(shape.span, shape.rise, shape.radius, shape.segments);
    if (shape.legs > 0) {
        curve.insert(curve.begin(), CurvePoint{{0.5f * shape.span, -shape.legs}, {1, 0}});
    }
    const float half = 0.5f * shape.depth;
    const float thickness = shape.thickness;
    const float cut = std::clamp(shape.chamfer, 0.0f, 0.95f * std::min(thickness, half));
    std::vector<SectionPoint> section = {{thickness, half}};  // clockwise, looking along the curve
    if (cut > 0) {
        section.insert(
            section.end(), {{cut, half}, {0, half - cut}, {0, cut - half}, {cut, -half}});
    } else {
        section.insert(section.end(), {{0, half}, {0, -half}});
    }
    section.push_back({thickness, -half});

    MeshData mesh;
    const std::vector<SweepPoint> left = half_curve(curve, true, 0);
    const std::vector<SweepPoint> right = half_curve(curve, false, left.back().length);
    for (const std::vector<SweepPoint>& path : {left, right}) {
        float v = 0;
        for (std::size_t i = 0; i < section.size(); ++i) {
            const SectionPoint& a = section[i];
            const SectionPoint& b = section[(i + 1) % section.size()];
            append_side(mesh, path, a, b, v);
            v += glm::distance(Vec2(a.offset, a.z), Vec2(b.offset, b.z));
        }
    }
    std::vector<Vec3> foot;
    for (const SectionPoint& corner : section) {
        foot.push_back(swept(right.back(), corner));
    }
    append_polygon(mesh, foot, {0, -1, 0}, {0, 0, 1});
    for (Vec3& p : foot) {
        p.x = -p.x;
    }
    std::reverse(foot.begin(), foot.end());
    append_polygon(mesh, foot, {0, -1, 0}, {0, 0, 1});
    return mesh;
}

MeshData make_wall(const MasonryWall& shape) {
    const Vec3 size = shape.size;
    LIMN_CHECK(size.x > 0 && size.y > 0 && size.z > 0 && shape.span > 0);
    const float half_x = 0.5f * size.x;
    const float half_z = 0.5f * size.z;
    const std::vector<CurvePoint> outline = opening_outline(shape, size);
    const float bottom = outline.front().position.y;
    const float bottom_half = outline.front().position.x;
    const bool on_ground = bottom <= 0;

    // Every row of the wall crosses the opening at two points, so that the triangles beside it need
    // only the vertices of its outline.
    std::vector<float> floor = {-half_x, -bottom_half, bottom_half, half_x};
    floor.erase(std::unique(floor.begin(), floor.end()), floor.end());
    const float ridge[] = {-half_x, 0, half_x};
    const float head[] = {size.y, outline.back().position.y};
    const float base[] = {bottom, 0};
    const float through[] = {-half_z, half_z};
    const float through_down[] = {half_z, -half_z};
    std::vector<float> heights = {size.y};
    for (auto point = outline.rbegin(); point != outline.rend(); ++point) {
        heights.push_back(point->position.y);
    }
    if (!on_ground) {
        heights.push_back(0);
    }

    MeshData mesh;
    const Vec3 x = {1, 0, 0};
    const Vec3 y = {0, 1, 0};
    const Vec3 z = {0, 0, 1};
    for (const float facing : {1.0f, -1.0f}) {
        append_flat(mesh, facing * x, y, ridge, head, half_z);
        append_beside_opening(mesh, outline, facing, half_x, half_z);
        append_flat(mesh, -facing * z, y, through, heights, half_x);
        if (!on_ground) {
            append_flat(mesh, facing * x, y, floor, base, half_z);
        }
    }
    append_flat(mesh, x, -z, ridge, through_down, size.y);
    if (on_ground) {
        append_flat(mesh, x, z, std::span(floor).first(2), through_down, 0);
        append_flat(mesh, x, z, std::span(floor).last(2), through_down, 0);
    } else {
        append_flat(mesh, x, z, floor, through_down, 0);
    }
    const std::vector<SweepPoint> left = half_curve(outline, true, 0);
    const std::vector<SweepPoint> right = half_curve(outline, false, left.back().length);
    append_side(mesh, left, {0, half_z}, {0, -half_z}, 0);
    append_side(mesh, right, {0, half_z}, {0, -half_z}, 0);
    if (!on_ground && bottom_half > 0) {
        append_flat(mesh, x, -z, std::span(floor).subspan(1, 2), through_down, bottom);
    }
    return mesh;
}

MeshData make_vault(const VaultShape& shape) {
    LIMN_CHECK(shape.size.x > 0 && shape.size.y > 0 && shape.thickness > 0);
    const Vec2 half = 0.5f * shape.size;
    const Vec3 along_x = {1, 0, 0};
    const Vec3 along_z = {0, 0, 1};
    MeshData mesh;
    for (const float side : {1.0f, -1.0f}) {
        for (const float turn : {1.0f, -1.0f}) {
            append_web(mesh, shape, half.x, half.y, side * along_x, turn * along_z);
            append_web(mesh, shape, half.y, half.x, side * along_z, turn * along_x);
        }
        append_vault_side(mesh, shape, half.x, half.y, side * along_x);
        append_vault_side(mesh, shape, half.y, half.x, side * along_z);
    }
    return mesh;
}

}  // namespace limn
