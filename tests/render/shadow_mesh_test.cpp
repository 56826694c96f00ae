#include "bench/oracles/shadow_volume_oracle.h"
#include "content/make/models/shapes.h"
#include "content/make/models/teapot.h"
#include "ecs/base/rng.h"
#include "ecs/components/surface.h"
#include "render/shaders/shadow_volume_gpu.h"
#include "render/shadow/shadow_mesh.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <map>
#include <random>

// The laws of shadow volumes, without a GPU: what they are made of, whether they close, and that
// counting them agrees with rays (shadow.volume-count, -closed-mesh, -vol-per-edge,
// -vol-per-triangle, -vol-extrude, -silhouette, -extrusion-distance).

namespace limn::shadow_mesh_test {
namespace {

using oracle::DTriangle;
using oracle::DVec3;

/// F-cube: side 1 about the origin, 8 vertices, 12 triangles.
MeshData make_cube(float half = 0.5f) {
    MeshData mesh;
    mesh.name = "cube";
    for (int i = 0; i < 8; ++i) {
        mesh.positions.emplace_back(
            (i & 1) != 0 ? half : -half, (i & 2) != 0 ? half : -half, (i & 4) != 0 ? half : -half);
    }
    mesh.indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                    2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    return mesh;
}

std::vector<DTriangle> triangles_of(const ShadowMesh& mesh) {
    std::vector<DTriangle> triangles;
    for (const auto& t : mesh.triangles) {
        triangles.push_back({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]});
    }
    return triangles;
}

enum class Extrude { ByFace, ByFlag, AsPrinted };

/// What the vertex shader makes of a geometry, in double precision. Prisms of triangles that do not
/// face the light collapse.
std::vector<DTriangle> extruded(
    const VolumeGeometry& geometry, Extrude how, const DVec3& light, double distance, double bias) {
    std::vector<DVec3> moved;
    for (const VolumeVertex& v : geometry.vertices) {
        const bool lit = faces_light(v.plane, Vec4(Vec3(light), 1));
        const DVec3 p = Vec3(v.corner);
        const bool far = how == Extrude::ByFlag   ? v.corner.w > 0.5f
                         : how == Extrude::ByFace ? !lit
                                                  : lit;
        moved.push_back(
            how == Extrude::ByFlag && !lit ? DVec3(0)
                                           : oracle::extrude(p, light, far ? distance : bias));
    }
    std::vector<DTriangle> triangles;
    for (std::size_t i = 0; i < geometry.indices.size(); i += 3) {
        triangles.push_back(
            {moved[geometry.indices[i]], moved[geometry.indices[i + 1]],
             moved[geometry.indices[i + 2]]});
    }
    return triangles;
}

std::vector<DTriangle> without_slivers(const std::vector<DTriangle>& triangles) {
    std::vector<DTriangle> spread;
    for (const DTriangle& t : triangles) {
        if (oracle::count_nondegenerate(std::span(&t, 1)) == 1) {
            spread.push_back(t);
        }
    }
    return spread;
}

class Points {
  public:
    DVec3 within(double half) {
        std::uniform_real_distribution<double> axis(-half, half);
        const double x = axis(random_);
        const double y = axis(random_);
        return {x, y, axis(random_)};
    }

  private:
    std::mt19937_64 random_{4711};
};

bool inside_cube(const DVec3& p, double half = 0.5) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < half;
}

}  // namespace

TEST_CASE(
    "shadow_mesh: the cube is closed and has 18 edges; removing a triangle opens 3"
    * technique("shadow.closed-mesh")) {
    MeshData cube = make_cube();
    const ShadowMesh whole = make_shadow_mesh(cube);
    CHECK(is_closed(whole.report));
    CHECK(whole.edges.size() == 18);
    CHECK(describe(whole.report) == "closed");

    cube.indices.resize(cube.indices.size() - 3);
    const ShadowMesh open = make_shadow_mesh(cube);
    CHECK_FALSE(is_closed(open.report));
    CHECK(open.report.open_edges == 3);
    CHECK(open.edges.empty());
    CHECK(describe(open.report) == "3 open edges");
}

TEST_CASE("shadow_mesh: seams of texture coordinates are not edges of the solid") {
    MeshData cube = make_cube();
    MeshData apart;
    for (const std::uint32_t index : cube.indices) {
        apart.indices.push_back(static_cast<std::uint32_t>(apart.positions.size()));
        // Less than the tolerance off, as rounding leaves them.
        const float nudge = 5e-7f * static_cast<float>(apart.positions.size() % 3);
        apart.positions.push_back(cube.positions[index] + Vec3(nudge, 0, 0));
    }
    const ShadowMesh welded = make_shadow_mesh(apart);
    CHECK(welded.positions.size() == 8);
    CHECK(welded.edges.size() == 18);

    for (std::size_t i = 0; i < apart.positions.size(); ++i) {
        apart.positions[i] += Vec3(1e-4f * static_cast<float>(i % 3), 0, 0);
    }
    CHECK_FALSE(is_closed(make_shadow_mesh(apart).report));
}

TEST_CASE("shadow_mesh: duplicate, crowded, inside-out and collapsed triangles are distinguished") {
    MeshData cube = make_cube();
    cube.indices.insert(cube.indices.end(), {0, 2, 3});
    ManifoldReport report = make_shadow_mesh(cube).report;
    CHECK(report.duplicated == 1);
    CHECK(report.crowded_edges == 3);
    CHECK_FALSE(is_closed(report));

    cube = make_cube();
    std::swap(cube.indices[0], cube.indices[1]);
    report = make_shadow_mesh(cube).report;
    CHECK(report.inconsistent_edges == 3);
    CHECK(report.open_edges == 0);
    CHECK_FALSE(is_closed(report));

    cube = make_cube();
    cube.indices.insert(cube.indices.end(), {1, 1, 2});
    report = make_shadow_mesh(cube).report;
    CHECK(report.removed == 1);
    CHECK(is_closed(report));
}

TEST_CASE("shadow_mesh: invalid meshes are open and never crash") {
    CHECK_FALSE(is_closed(make_shadow_mesh(MeshData{}).report));
    CHECK(describe(make_shadow_mesh(MeshData{}).report) == "no triangles");
    MeshData cube = make_cube();
    cube.positions[3] = Vec3(NAN, INFINITY, 0);
    CHECK_FALSE(is_closed(make_shadow_mesh(cube).report));
    cube = make_cube();
    cube.indices[5] = 1000;
    CHECK(make_shadow_mesh(cube).report.open_edges == 3);
}

TEST_CASE("shadow_mesh: the teapot of separate patches is open" * technique("shadow.closed-mesh")) {
    const ShadowMesh teapot = make_shadow_mesh(make_teapot({}));
    CHECK(teapot.report.open_edges > 0);
}

TEST_CASE("shadow_mesh: in an edge's quad the first triangle runs against the edge") {
    const ShadowMesh cube = make_shadow_mesh(make_cube());
    for (const ShadowEdge& edge : cube.edges) {
        const auto runs = [&](std::uint32_t triangle, std::uint32_t from, std::uint32_t to) {
            const auto& t = cube.triangles[triangle];
            return (t[0] == from && t[1] == to) || (t[1] == from && t[2] == to)
                   || (t[2] == from && t[0] == to);
        };
        CHECK(runs(edge.along, edge.begin, edge.end));
        CHECK(runs(edge.against, edge.end, edge.begin));
    }
}

TEST_CASE(
    "shadow_mesh: an edge volume is closed, faces outward and has 8/2 n triangles"
    * technique("shadow.vol-per-edge")) {
    const ShadowMesh cube = make_shadow_mesh(make_cube());
    const VolumeGeometry geometry = make_edge_volume(cube);
    CHECK(geometry.indices.size() == 3 * 4 * 12);
    CHECK(geometry.cap_indices == 3 * 12);
    Points points;
    for (int i = 0; i < 50; ++i) {
        const DVec3 light = 20.0 * glm::normalize(points.within(1));
        const std::vector<DTriangle> volume = extruded(geometry, Extrude::ByFace, light, 40, 0.01);
        CHECK(oracle::open_directed_edges(volume) == 0);
        CHECK(oracle::signed_volume(volume) > 0);
    }
}

TEST_CASE(
    "shadow_mesh: a cube lit from above opens 4 edges, 20 triangles; from a corner 6, 24"
    * technique("shadow.vol-per-edge")) {
    const ShadowMesh cube = make_shadow_mesh(make_cube());
    const VolumeGeometry geometry = make_edge_volume(cube);
    const auto triangles = [&](const DVec3& light) {
        return oracle::count_nondegenerate(extruded(geometry, Extrude::ByFace, light, 40, 0.1));
    };
    CHECK(triangles({0, 10, 0}) == 20);
    CHECK(triangles({10, 10, 10}) == 24);
    CHECK(find_silhouette(cube, {0, 10, 0, 1}).size() == 4);
    CHECK(find_silhouette(cube, {10, 10, 10, 1}).size() == 6);
    CHECK(find_silhouette(cube, {10, 10, 0, 1}).size() == 6);
}

TEST_CASE(
    "shadow_mesh: quads of edges inside the lit or the dark part have no area"
    * technique("shadow.vol-per-edge")) {
    const ShadowMesh cube = make_shadow_mesh(make_cube());
    VolumeGeometry geometry = make_edge_volume(cube);
    geometry.indices.erase(
        geometry.indices.begin(), geometry.indices.begin() + geometry.cap_indices);
    const Vec4 light = {3, 10, 2, 1};
    const std::vector<DTriangle> sides =
        extruded(geometry, Extrude::ByFace, DVec3(Vec3(light)), 40, 0.1);
    for (std::size_t i = 0; i < cube.edges.size(); ++i) {
        const ShadowEdge& edge = cube.edges[i];
        const bool opens = faces_light(cube.planes[edge.along], light)
                           != faces_light(cube.planes[edge.against], light);
        CHECK(oracle::count_nondegenerate(std::span(sides).subspan(2 * i, 2)) == (opens ? 2 : 0));
    }
}

TEST_CASE(
    "shadow_mesh: the sign printed in the book turns the volume inside out"
    * technique("shadow.vol-per-edge")) {
    const VolumeGeometry geometry = make_edge_volume(make_shadow_mesh(make_cube()));
    const DVec3 light = {3, 10, 2};
    CHECK(
        oracle::signed_volume(extruded(geometry, Extrude::AsPrinted, light, 40, 0))
        == test::near(-521.62).epsilon(1e-5));
    CHECK(oracle::signed_volume(extruded(geometry, Extrude::ByFace, light, 40, 0)) > 0);
}

TEST_CASE(
    "shadow_mesh: with swapped normals an edge's quad leaves the surface open"
    * technique("shadow.vol-per-edge")) {
    ShadowMesh cube = make_shadow_mesh(make_cube());
    for (ShadowEdge& edge : cube.edges) {
        std::swap(edge.along, edge.against);
    }
    const auto volume = extruded(make_edge_volume(cube), Extrude::ByFace, DVec3(3, 10, 2), 40, 0.1);
    CHECK(oracle::open_directed_edges(volume) > 0);
}

TEST_CASE(
    "shadow_mesh: a prism has 2 caps, 3 quads, 6 vertices and 12 edges, and is closed"
    * technique("shadow.vol-per-triangle, shadow.volume-count")) {
    MeshData mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.indices = {0, 1, 2};
    const VolumeGeometry geometry = make_triangle_volume(make_shadow_mesh(mesh));
    // An open mesh: once for either side; only one of them faces a light.
    REQUIRE(geometry.indices.size() == 48);
    const std::vector<DTriangle> prism =
        without_slivers(extruded(geometry, Extrude::ByFlag, DVec3(0.3, 0.2, 4), 10, 0.1));
    CHECK(prism.size() == 2 + 3 * 2);
    CHECK(oracle::open_directed_edges(prism) == 0);
    CHECK(oracle::signed_volume(prism) > 0);
    std::map<std::array<double, 3>, int> vertices;
    for (const DTriangle& t : prism) {
        for (const DVec3& p : t) {
            ++vertices[{p.x, p.y, p.z}];
        }
    }
    const std::size_t edges = 3 * prism.size() / 2;
    CHECK(vertices.size() == 6);
    CHECK(edges == 12);
    CHECK(vertices.size() + prism.size() == edges + 2);
    CHECK(
        oracle::signed_volume(extruded(geometry, Extrude::ByFlag, DVec3(0.3, 0.2, -4), 10, 0.1))
        > 0);
}

TEST_CASE(
    "shadow_mesh: a cube's prisms are 16 triangles lit from above, 48 from a corner"
    * technique("shadow.vol-per-triangle")) {
    const VolumeGeometry geometry = make_triangle_volume(make_shadow_mesh(make_cube()));
    CHECK(geometry.indices.size() == 12 * 24);
    const auto triangles = [&](const DVec3& light) {
        return oracle::count_nondegenerate(extruded(geometry, Extrude::ByFlag, light, 40, 0.1));
    };
    CHECK(triangles({0, 10, 0}) == 16);
    CHECK(triangles({10, 10, 10}) == 48);
}

TEST_CASE(
    "shadow_mesh: prisms of an open mesh are closed where an edge volume would leak"
    * technique("shadow.closed-mesh")) {
    MeshData cube = make_cube();
    cube.indices.resize(cube.indices.size() - 3);
    ShadowMesh open = make_shadow_mesh(cube);
    const DVec3 light = {3, 10, 2};
    CHECK(
        oracle::open_directed_edges(
            extruded(make_triangle_volume(open), Extrude::ByFlag, light, 40, 0.1))
        == 0);

    // The edges it would have as a closed mesh, less those of the missing triangle.
    const ShadowMesh closed = make_shadow_mesh(make_cube());
    for (const ShadowEdge& edge : closed.edges) {
        if (edge.along < open.triangles.size() && edge.against < open.triangles.size()) {
            open.edges.push_back(edge);
        }
    }
    CHECK(
        oracle::open_directed_edges(
            extruded(make_edge_volume(open), Extrude::ByFace, light, 40, 0.1))
        > 0);
}

TEST_CASE(
    "shadow_volume: counting agrees with ray casts at 4000 points around a cube"
    * technique("shadow.volume-count")) {
    const ShadowMesh cube = make_shadow_mesh(make_cube());
    const DVec3 light = {3, 10, 2};
    const std::vector<DTriangle> mesh = triangles_of(cube);
    const std::vector<DTriangle> by_edge =
        extruded(make_edge_volume(cube), Extrude::ByFace, light, 40, 0);
    const std::vector<DTriangle> by_triangle =
        extruded(make_triangle_volume(cube), Extrude::ByFlag, light, 40, 0);
    Points points;
    const DVec3 eye = {-7.1, 6.3, 8.2};
    int shadowed = 0;
    for (int i = 0; i < 4000; ++i) {
        const DVec3 p = points.within(6);
        const bool dark = inside_cube(p) || oracle::segment_hits(mesh, p, light);
        shadowed += dark ? 1 : 0;
        REQUIRE((oracle::z_fail_count(by_edge, eye, p) != 0) == dark);
        REQUIRE((oracle::z_fail_count(by_triangle, eye, p) != 0) == dark);
    }
    CHECK(shadowed > 10);
}

TEST_CASE(
    "shadow_volume: z-fail counts exactly z-pass plus the volumes around the eye"
    * technique("shadow.volume-count")) {
    const ShadowMesh cube = make_shadow_mesh(make_cube());
    std::vector<DTriangle> volumes;
    for (const DVec3& light : {DVec3(3, 10, 2), DVec3(-4, 9, 1), DVec3(0.4, 8, -3)}) {
        const auto one = extruded(make_edge_volume(cube), Extrude::ByFace, light, 40, 0.01);
        volumes.insert(volumes.end(), one.begin(), one.end());
    }
    Points points;
    int within = 0;
    for (int i = 0; i < 2000; ++i) {
        const DVec3 eye = points.within(2) - DVec3(0, 2, 0);
        const DVec3 p = points.within(8);
        const int containing = oracle::winding_number(volumes, eye);
        within += containing > 0 ? 1 : 0;
        REQUIRE(
            oracle::z_fail_count(volumes, eye, p)
            == oracle::z_pass_count(volumes, eye, p) + containing);
        REQUIRE(oracle::z_fail_count(volumes, eye, p) == oracle::winding_number(volumes, p));
    }
    CHECK(within > 100);
}

TEST_CASE(
    "shadow_volume: inside k nested volumes the count is k, outside all of them 0"
    * technique("shadow.volume-count")) {
    std::vector<DTriangle> volumes;
    const DVec3 light = {0, 10, 0};
    for (const float half : {0.2f, 0.4f, 0.6f, 0.8f}) {
        const auto one = extruded(
            make_edge_volume(make_shadow_mesh(make_cube(half))), Extrude::ByFace, light, 40, 0);
        volumes.insert(volumes.end(), one.begin(), one.end());
    }
    const DVec3 eye = {9.3, 1.7, 0.4};
    for (int k = 0; k <= 4; ++k) {
        // Between the walls of the k-th and the next, as the light spreads them at y = -1.
        const double x = (0.9 - 0.2 * k) * 1.1;
        CHECK(oracle::z_fail_count(volumes, eye, {x, -1, 0.013}) == k);
        CHECK(oracle::z_pass_count(volumes, eye, {x, -1, 0.013}) == k);
    }
}

TEST_CASE(
    "silhouette: on closed meshes it consists of loops, on convex ones of a single loop"
    * technique("shadow.silhouette")) {
    Points points;
    const MeshData torus = make_torus({});
    for (const MeshData& mesh : {make_cube(), make_sphere({.radius = 1}), torus}) {
        const ShadowMesh shadow = make_shadow_mesh(mesh);
        REQUIRE(is_closed(shadow.report));
        for (int i = 0; i < 10; ++i) {
            const DVec3 direction = glm::normalize(points.within(1));
            const Vec4 light = {Vec3(9.0 * direction), i % 2 == 0 ? 1.0f : 0.0f};
            std::map<std::uint32_t, int> balance;
            std::map<std::uint32_t, std::uint32_t> next;
            const std::vector<SilhouetteEdge> silhouette = find_silhouette(shadow, light);
            REQUIRE(!silhouette.empty());
            for (const SilhouetteEdge& edge : silhouette) {
                ++balance[edge.begin];
                --balance[edge.end];
                next[edge.begin] = edge.end;
            }
            for (const auto& [vertex, sum] : balance) {
                CHECK(sum == 0);
            }
            if (mesh.indices.size() == torus.indices.size()) {
                continue;  // one loop or two
            }
            std::size_t steps = 0;
            std::uint32_t at = silhouette.front().begin;
            do {
                at = next.at(at);
                ++steps;
            } while (at != silhouette.front().begin && steps <= silhouette.size());
            CHECK(steps == silhouette.size());
        }
    }
}

TEST_CASE(
    "silhouette: it runs counter-clockwise around the lit part, viewed from the light"
    * technique("shadow.silhouette")) {
    const ShadowMesh cube = make_shadow_mesh(make_cube());
    float area = 0;  // of its projection to the ground, viewed from above
    for (const SilhouetteEdge& edge : find_silhouette(cube, {0, 10, 0, 1})) {
        const Vec3& a = cube.positions[edge.begin];
        const Vec3& b = cube.positions[edge.end];
        area += 0.5f * (a.z * b.x - a.x * b.z);
    }
    CHECK(area == test::near(1));
}

TEST_CASE(
    "silhouette: for a light inside a closed convex mesh it is empty"
    * technique("shadow.silhouette")) {
    const ShadowMesh cube = make_shadow_mesh(make_cube());
    CHECK(find_silhouette(cube, {0.1f, 0.2f, -0.1f, 1}).empty());
}

TEST_CASE(
    "extrusion: far corners move away from the light by the distance, near ones by the bias"
    * technique("shadow.vol-extrude")) {
    using layout::shift_from_light;
    const Vec4 light = {0, 10, 0, 1};
    const auto check = [](const Vec3& found, const Vec3& expected) {
        CHECK(glm::distance(found, expected) < 1e-4f);
    };
    check(shift_from_light({0, 0, 0}, light, 100), {0, -100, 0});
    check(shift_from_light({0, 0, 0}, light, 0.1f), {0, -0.1f, 0});
    check(shift_from_light({3, 6, 0}, light, 100), {63, -74, 0});
    check(shift_from_light({3, 6, 0}, light, 0.1f), {3.06f, 5.92f, 0});
    Points points;
    for (int i = 0; i < 200; ++i) {
        const Vec3 p = points.within(5);
        const Vec3 moved = shift_from_light(p, light, 7);
        const Vec3 l = Vec3(light);
        CHECK(glm::length(glm::cross(p - l, moved - l)) < 1e-3f);
        CHECK(glm::distance(moved, l) == test::near(glm::distance(p, l) + 7).epsilon(1e-5));
        check(shift_from_light(p, {0, 1, 0, 0}, 2), p - Vec3(0, 2, 0));
    }
    // A corner in the light itself goes somewhere.
    CHECK(std::isfinite(shift_from_light({0, 10, 0}, light, 7).y));
}

TEST_CASE(
    "extrusion: to infinity a corner becomes the direction away from the light"
    * technique("shadow.vol-extrude")) {
    using namespace layout;
    const Vec4 infinite = {kExtrudeInfinite, 0, 0, 0};
    CHECK(extrude_corner({3, 6, 0}, {0, 10, 0, 1}, infinite, 1) == Vec4(3, -4, 0, 0));
    CHECK(extrude_corner({3, 6, 0}, {0, 1, 0, 0}, infinite, 1) == Vec4(0, -1, 0, 0));
}

TEST_CASE(
    "extrusion: by radius the cap cuts into the light's sphere, by plane it touches it"
    * technique("shadow.extrusion-distance")) {
    using namespace layout;
    const Vec4 light = {0, 0, 0, 1};
    const Vec3 a = {-1, -1, 0};
    const Vec3 b = {1, -1, 0};
    const auto cap_distance = [&](const Vec4& extrusion) {
        const Vec4 far_a = extrude_corner(a, light, extrusion, 1);
        const Vec4 far_b = extrude_corner(b, light, extrusion, 1);
        CHECK(far_a.w == 1);
        return 0.5f * glm::length(Vec3(far_a) + Vec3(far_b));
    };
    // The interval 7.0711 .. 10 below the light is wrongly lit.
    CHECK(cap_distance({kExtrudeRadius, 10, 0, 0}) == test::near(10 * std::cos(kPi / 4)));
    CHECK(cap_distance({kExtrudePlane, 10, 0, 0}) == test::near(10));
    CHECK(
        glm::distance(
            Vec3(extrude_corner(a, light, {kExtrudePlane, 10, 0, 0}, 1)), Vec3(-10, -10, 0))
        < 1e-4f);
    // A constant distance leaks below R / cos(theta) - d and not above.
    const float least = 10 / std::cos(kPi / 4) - std::sqrt(2.0f);
    CHECK(least == test::near(12.728).epsilon(1e-4));
    CHECK(cap_distance({kExtrudeConstant, least - 0.01f, 0, 0}) < 10);
    CHECK(cap_distance({kExtrudeConstant, least + 0.01f, 0, 0}) > 10);
    // A plane through the light cannot be pushed out: infinite; one beyond the radius stays.
    CHECK(extrude_corner(a, light, {kExtrudePlane, 10, 0, 0}, 0).w == 0);
    CHECK(Vec3(extrude_corner(a, light, {kExtrudePlane, 10, 0, 0}, 12)) == a);
}

}  // namespace limn::shadow_mesh_test
