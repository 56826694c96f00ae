#include "content/make/models/shapes.h"

#include "content/make/models/surface_grid.h"
#include "ecs/base/check.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

// Techniques: fakephong.scenes

namespace limn {

namespace {

/// A direction in the x-z plane.
struct Turn {
    float sin;
    float cos;
};

/// The azimuths of `segments` + 1 columns from -z over -x, +z and +x back to -z. The last is
/// bit-identical to the first, so that the seam is closed.
std::vector<Turn> turns(int segments) {
    LIMN_CHECK(segments >= 3);
    std::vector<Turn> all(static_cast<std::size_t>(segments) + 1);
    for (int i = 0; i <= segments; ++i) {
        const double angle =
            2.0 * 3.14159265358979323846 * (static_cast<double>(i % segments) / segments - 0.5);
        all[static_cast<std::size_t>(i)] = {
            static_cast<float>(std::sin(angle)), static_cast<float>(std::cos(angle))};
    }
    return all;
}

/// One ring of a surface of revolution.
struct LatheRing {
    float radius;
    float height;
    Vec2 normal;  ///< outwards and upwards, unit
    float v;
};

/// Lobes of a surface of revolution: the radius is multiplied by 1 + depth cos(count azimuth).
struct Lobes {
    int count = 0;
    float depth = 0;
};

/// The factor of the radius, and its derivative by the azimuth.
struct LobeSample {
    float factor = 1;
    float slope = 0;
};

/// For the columns of turns(segments); bit-identical at both ends.
LobeSample lobe_at(const Lobes& lobes, int column, int segments) {
    if (lobes.count == 0) {
        return {};
    }
    const float angle =
        2.0f * kPi * static_cast<float>(lobes.count) * part(column % segments, segments);
    return {
        1.0f + lobes.depth * std::cos(angle),
        -lobes.depth * static_cast<float>(lobes.count) * std::sin(angle)};
}

/// Revolves rings, listed from the top, around +y.
void append_lathe(
    MeshData& mesh, int segments, const std::vector<LatheRing>& rings, const Lobes& lobes = {}) {
    const std::vector<Turn> around = turns(2 * segments);
    const int rows = static_cast<int>(rings.size()) - 1;
    const GridPoles poles = {rings.front().radius == 0.0f, rings.back().radius == 0.0f};
    append_grid(mesh, segments, rows, poles, [&](int i, int j) {
        const LatheRing& ring = rings[static_cast<std::size_t>(j)];
        // At a pole, the central azimuth of the triangle that ends there.
        const int shift = ring.radius > 0 ? 0 : (j == 0 ? 1 : -1);
        const int column = std::clamp(2 * i + shift, 0, 2 * segments);
        const Turn& turn = around[static_cast<std::size_t>(column)];
        GridVertex vertex;
        vertex.uv = {part(column, 2 * segments), ring.v};
        vertex.position = {ring.radius * turn.sin, ring.height, ring.radius * turn.cos};
        vertex.normal = {ring.normal.x * turn.sin, ring.normal.y, ring.normal.x * turn.cos};
        vertex.tangent = {turn.cos, 0, -turn.sin};
        if (lobes.count > 0) {
            // With r = R(s) f(azimuth), the normal is the cross product of the two derivatives.
            const LobeSample lobe = lobe_at(lobes, column, 2 * segments);
            const Vec3 out = {turn.sin, 0, turn.cos};
            const Vec3 along = vertex.tangent;
            vertex.position = {
                ring.radius * lobe.factor * turn.sin, ring.height,
                ring.radius * lobe.factor * turn.cos};
            vertex.normal = glm::normalize(
                ring.normal.x * (lobe.factor * out - lobe.slope * along)
                + Vec3(0, ring.normal.y * square(lobe.factor), 0));
            vertex.tangent = glm::normalize(lobe.slope * out + lobe.factor * along);
        }
        return vertex;
    });
}

/// A disc or ring at `height` that faces up (facing = 1) or down (-1).
void append_disc(
    MeshData& mesh, float radius, float hole, float height, float facing, int segments,
    int divisions, const Lobes& lobes = {}) {
    const std::vector<Turn> around = turns(segments);
    append_grid(mesh, segments, divisions, {false, hole == 0.0f}, [&](int i, int j) {
        // With columns to the right and rows toward the center, the outline runs clockwise viewed
        // from the front; viewed from above, turns() runs counter-clockwise.
        const int column = facing > 0 ? segments - i : i;
        const Turn& turn = around[static_cast<std::size_t>(column)];
        const float r =
            glm::mix(radius, hole, part(j, divisions)) * lobe_at(lobes, column, segments).factor;
        GridVertex vertex;
        vertex.position = {r * turn.sin, height, r * turn.cos};
        vertex.normal = {0, facing, 0};
        vertex.tangent = {1, 0, 0};
        vertex.uv = {
            0.5f + 0.5f * vertex.position.x / radius,
            0.5f + 0.5f * facing * vertex.position.z / radius};
        return vertex;
    });
}

/// The coordinates of the grid lines of a rounded side, from -half to half. In the bevel they are
/// spaced so that normals turn by equal angles.
std::vector<float> rounded_lines(float half, float bevel, const BoxShape& shape) {
    const float inner = half - bevel;
    std::vector<float> upper;  // from the center of the edge inwards
    if (bevel > 0) {
        upper.push_back(half);
        for (int i = 1; i < shape.bevel_segments; ++i) {
            upper.push_back(
                inner + bevel * std::tan(0.25f * kPi * (1.0f - part(i, shape.bevel_segments))));
        }
    }
    std::vector<float> lines;
    for (const float x : upper) {
        lines.push_back(-x);
    }
    const int steps = inner > 0 ? shape.divisions : 0;
    for (int i = 0; i <= steps; ++i) {
        lines.push_back(steps == 0 ? 0.0f : inner * part(2 * i - steps, steps));
    }
    lines.insert(lines.end(), upper.rbegin(), upper.rend());
    return lines;
}

}  // namespace

MeshData make_sphere(const SphereShape& shape) {
    LIMN_CHECK(shape.radius > 0 && shape.rings >= 2);
    std::vector<LatheRing> rings;
    for (int j = 0; j <= shape.rings; ++j) {
        const float angle = kPi * part(j, shape.rings);
        const bool pole = j == 0 || j == shape.rings;
        const Vec2 normal = {pole ? 0.0f : std::sin(angle), std::cos(angle)};
        rings.push_back(
            {shape.radius * normal.x, shape.radius * normal.y, normal, part(j, shape.rings)});
    }
    MeshData mesh;
    append_lathe(mesh, shape.segments, rings);
    return mesh;
}

MeshData make_box(const BoxShape& shape) {
    const Vec3 half = 0.5f * shape.size;
    LIMN_CHECK(half.x > 0 && half.y > 0 && half.z > 0);
    LIMN_CHECK(shape.bevel_segments >= 1 && shape.divisions >= 1);
    const float bevel = std::clamp(shape.bevel, 0.0f, std::min({half.x, half.y, half.z}));
    const Vec3 inner = half - bevel;

    // The six sides: where the image's right and top point.
    const Vec3 sides[6][2] = {{{0, 0, -1}, {0, 1, 0}}, {{0, 0, 1}, {0, 1, 0}},
                              {{1, 0, 0}, {0, 0, -1}}, {{1, 0, 0}, {0, 0, 1}},
                              {{1, 0, 0}, {0, 1, 0}},  {{-1, 0, 0}, {0, 1, 0}}};
    MeshData mesh;
    for (const auto& side : sides) {
        const Vec3& right = side[0];
        const Vec3& up = side[1];
        const Vec3 out = glm::cross(right, up);
        const float half_right = glm::dot(glm::abs(right), half);
        const float half_up = glm::dot(glm::abs(up), half);
        const std::vector<float> columns = rounded_lines(half_right, bevel, shape);
        const std::vector<float> rows = rounded_lines(half_up, bevel, shape);
        append_grid(
            mesh, static_cast<int>(columns.size()) - 1, static_cast<int>(rows.size()) - 1, {},
            [&](int i, int j) {
                const float x = columns[static_cast<std::size_t>(i)];
                const float y = -rows[static_cast<std::size_t>(j)];
                const Vec3 on_side = out * half + right * x + up * y;
                const Vec3 core = glm::clamp(on_side, -inner, inner);
                GridVertex vertex;
                vertex.normal = bevel > 0 ? normalize_or(on_side - core, out) : out;
                vertex.position = core + bevel * vertex.normal;
                vertex.tangent =
                    glm::normalize(right - vertex.normal * glm::dot(vertex.normal, right));
                vertex.uv = shape.metric
                                ? Vec2(x, -y)
                                : Vec2(0.5f + 0.5f * x / half_right, 0.5f - 0.5f * y / half_up);
                return vertex;
            });
    }
    return mesh;
}

MeshData make_torus(const TorusShape& shape) {
    LIMN_CHECK(shape.tube > 0 && shape.sides >= 3);
    const float radius = std::max(shape.radius, shape.tube);
    const std::vector<Turn> around_tube = turns(shape.sides);
    std::vector<LatheRing> rings;
    for (int j = 0; j <= shape.sides; ++j) {
        // turns() begins at the inside of the tube (cos = -1); from there over the top outwards
        const Turn& turn = around_tube[static_cast<std::size_t>(j)];
        const Vec2 normal = {turn.cos, -turn.sin};
        rings.push_back(
            {radius + shape.tube * normal.x, shape.tube * normal.y, normal, part(j, shape.sides)});
    }
    MeshData mesh;
    append_lathe(mesh, shape.segments, rings);
    return mesh;
}

MeshData make_plane(const PlaneShape& shape) {
    LIMN_CHECK(shape.size.x > 0 && shape.size.y > 0 && shape.divisions >= 1);
    MeshData mesh;
    append_grid(mesh, shape.divisions, shape.divisions, {}, [&](int i, int j) {
        const Vec2 uv = {part(i, shape.divisions), part(j, shape.divisions)};
        const Vec2 position = (uv - 0.5f) * shape.size;
        return GridVertex{
            {position.x, 0, position.y}, {0, 1, 0}, {1, 0, 0}, shape.metric ? position : uv};
    });
    return mesh;
}

MeshData make_dodecahedron(const DodecahedronShape& shape) {
    LIMN_CHECK(shape.radius > 0 && shape.faces >= 1 && shape.faces <= 12);
    // Corners: a cube and three rectangles; faces: the five corners nearest to each axis of the
    // icosahedron, sorted around it.
    const float golden = 0.5f * (1 + std::sqrt(5.0f));
    std::vector<Vec3> corners;
    std::vector<Vec3> axes;
    for (const float a : {-1.0f, 1.0f}) {
        for (const float b : {-1.0f, 1.0f}) {
            for (const float c : {-1.0f, 1.0f}) {
                corners.emplace_back(a, b, c);
            }
            const float x = a / golden;
            const float y = b * golden;
            corners.insert(corners.end(), {{0, x, y}, {x, y, 0}, {y, 0, x}});
            axes.insert(axes.end(), {{0, a * golden, b}, {a * golden, b, 0}, {b, 0, a * golden}});
        }
    }
    std::stable_sort(
        axes.begin(), axes.end(), [](const Vec3& a, const Vec3& b) { return a.z > b.z; });
    axes.resize(static_cast<std::size_t>(shape.faces));
    MeshData mesh;
    for (const Vec3& corner : corners) {
        const Vec3 n = glm::normalize(corner);
        mesh.positions.push_back(shape.radius * n);
        mesh.normals.push_back(n);
        const Vec3 along = glm::cross(std::abs(n.y) < 0.99f ? Vec3(0, 1, 0) : Vec3(0, 0, 1), n);
        mesh.tangents.emplace_back(glm::normalize(along), 1);
        mesh.uvs.emplace_back(0.5f + std::atan2(n.x, n.z) / (2 * kPi), 0.5f - std::asin(n.y) / kPi);
        grow(mesh.bounds, mesh.positions.back());
    }
    for (const Vec3& axis : axes) {
        const Vec3 n = glm::normalize(axis);
        std::vector<std::pair<float, std::uint32_t>> around;
        Vec3 first(0);
        for (std::uint32_t i = 0; i < mesh.normals.size(); ++i) {
            const float along = glm::dot(n, mesh.normals[i]);
            if (along > 0.7f) {
                const Vec3 p = mesh.normals[i] - along * n;
                first = around.empty() ? p : first;
                around.emplace_back(
                    std::atan2(glm::dot(glm::cross(n, first), p), glm::dot(first, p)), i);
            }
        }
        std::sort(around.begin(), around.end());
        for (std::size_t k = 2; k < around.size(); ++k) {
            mesh.indices.insert(
                mesh.indices.end(), {around[0].second, around[k - 1].second, around[k].second});
        }
    }
    return mesh;
}

MeshData make_triangle(const TriangleShape& shape) {
    LIMN_CHECK(shape.radius > 0 && shape.divisions >= 1);
    const float half_side = std::sqrt(0.75f);
    MeshData mesh;
    for (int j = 0; j <= shape.divisions; ++j) {
        for (int i = 0; i <= j; ++i) {
            const float down = part(j, shape.divisions);
            const float right = part(2 * i - j, shape.divisions);
            mesh.positions.push_back(shape.radius * Vec3(right * half_side, 1 - 1.5f * down, 0));
            mesh.normals.emplace_back(0, 0, 1);
            mesh.tangents.emplace_back(1, 0, 0, 1);
            mesh.uvs.emplace_back(0.5f + 0.5f * right, down);
            grow(mesh.bounds, mesh.positions.back());
        }
    }
    const auto vertex = [](int i, int j) {
        return static_cast<std::uint32_t>(j * (j + 1) / 2 + i);
    };
    for (int j = 0; j < shape.divisions; ++j) {
        for (int i = 0; i <= j; ++i) {
            mesh.indices.insert(
                mesh.indices.end(), {vertex(i, j), vertex(i, j + 1), vertex(i + 1, j + 1)});
            if (i < j) {
                mesh.indices.insert(
                    mesh.indices.end(), {vertex(i, j), vertex(i + 1, j + 1), vertex(i + 1, j)});
            }
        }
    }
    return mesh;
}

MeshData make_cylinder(const CylinderShape& shape) {
    return make_cone(
        {.radius = shape.radius,
         .top_radius = shape.radius,
         .height = shape.height,
         .segments = shape.segments,
         .divisions = shape.divisions,
         .caps = shape.caps});
}

MeshData make_cone(const ConeShape& shape) {
    LIMN_CHECK(
        shape.radius > 0 && shape.top_radius >= 0 && shape.height > 0 && shape.divisions >= 1);
    const Vec2 normal = glm::normalize(Vec2(shape.height, shape.radius - shape.top_radius));
    std::vector<LatheRing> rings;
    for (int j = 0; j <= shape.divisions; ++j) {
        const float v = part(j, shape.divisions);
        rings.push_back(
            {glm::mix(shape.top_radius, shape.radius, v), shape.height * (0.5f - v), normal, v});
    }
    MeshData mesh;
    append_lathe(mesh, shape.segments, rings);
    if (shape.caps && shape.top_radius > 0) {
        append_disc(mesh, shape.top_radius, 0, 0.5f * shape.height, 1, shape.segments, 1);
    }
    if (shape.caps) {
        append_disc(mesh, shape.radius, 0, -0.5f * shape.height, -1, shape.segments, 1);
    }
    return mesh;
}

MeshData make_disc(const DiscShape& shape) {
    LIMN_CHECK(shape.radius > 0 && shape.divisions >= 1);
    const float hole = std::clamp(shape.inner_radius, 0.0f, 0.999f * shape.radius);
    MeshData mesh;
    append_disc(mesh, shape.radius, hole, 0, 1, shape.segments, shape.divisions);
    return mesh;
}

MeshData make_lathe(const LatheShape& shape) {
    std::vector<Vec2> points;  // from the top, without repeated points
    for (auto p = shape.profile.rbegin(); p != shape.profile.rend(); ++p) {
        const Vec2 point = {std::max(p->x, 0.0f), p->y};
        if (points.empty() || point != points.back()) {
            points.push_back(point);
        }
    }
    if (points.size() < 2) {
        points = {{0.0f, 1.0f}, {0.5f, 0.0f}};
    }
    const Lobes lobes = {shape.lobes, std::clamp(shape.lobe_depth, 0.0f, 0.5f)};
    const std::size_t last = points.size() - 1;
    const auto edge_normal = [&](std::size_t i) {  // of the part from point i to the next
        const Vec2 down = glm::normalize(points[i + 1] - points[i]);
        return Vec2(-down.y, down.x);
    };
    float length = 0;
    for (std::size_t i = 0; i < last; ++i) {
        length += glm::distance(points[i], points[i + 1]);
    }

    MeshData mesh;
    std::vector<LatheRing> run;
    float arc_length = 0;
    for (std::size_t i = 0; i <= last; ++i) {
        arc_length += i > 0 ? glm::distance(points[i - 1], points[i]) : 0.0f;
        const float v = arc_length / length;
        const Vec2 before = edge_normal(i > 0 ? i - 1 : 0);
        const Vec2 after = edge_normal(std::min(i, last - 1));
        const bool is_edge = i > 0 && i < last && glm::dot(before, after) < std::cos(shape.crease);
        const Vec2 smooth = is_edge ? before : glm::normalize(before + after);
        run.push_back({points[i].x, points[i].y, smooth, v});
        if (i == last || is_edge) {
            append_lathe(mesh, shape.segments, run, lobes);
            run = {{points[i].x, points[i].y, after, v}};
        }
    }
    // The columns of a lathe are every second one of twice as many turns, so caps match exactly.
    if (shape.caps && points.front().x > 0) {
        append_disc(mesh, points.front().x, 0, points.front().y, 1, shape.segments, 1, lobes);
    }
    if (shape.caps && points.back().x > 0) {
        append_disc(mesh, points.back().x, 0, points.back().y, -1, shape.segments, 1, lobes);
    }
    return mesh;
}

}  // namespace limn
