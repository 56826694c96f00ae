#include "content/bake/tangents.h"
#include "ecs/components/surface.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <vector>

namespace limn::tangents_test {
namespace {

const Vec3 kUnitTriangle[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

bool near(const Vec3& a, const Vec3& b, float tolerance = 1e-6f) {
    return glm::length(a - b) <= tolerance;
}

float degrees_between(const Vec3& a, const Vec3& b) {
    return degrees(
        std::acos(std::clamp(glm::dot(glm::normalize(a), glm::normalize(b)), -1.0f, 1.0f)));
}

/// A cube with eight shared vertices; bit f of `diagonals` chooses how face f is cut.
MeshData make_cube(unsigned diagonals) {
    constexpr std::uint32_t kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                            {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    MeshData cube;
    for (int i = 0; i < 8; ++i) {
        cube.positions.emplace_back(i & 1, (i >> 1) & 1, (i >> 2) & 1);
    }
    for (unsigned f = 0; f < 6; ++f) {
        const std::uint32_t* q = kFaces[f];
        const auto cut = (diagonals >> f) & 1u ? std::vector{q[0], q[1], q[3], q[1], q[2], q[3]}
                                               : std::vector{q[0], q[1], q[2], q[0], q[2], q[3]};
        cube.indices.insert(cube.indices.end(), cut.begin(), cut.end());
    }
    return cube;
}

/// The unit square in z = 0, uv = position, v flipped: (0, 0) is the upper left corner of the
/// image.
MeshData make_square() {
    MeshData square;
    square.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    square.normals.assign(4, Vec3(0, 0, 1));
    square.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    square.indices = {0, 1, 2, 0, 2, 3};
    return square;
}

/// A sphere with uv = (longitude / 2 pi, latitude from the north pole / pi).
MeshData make_sphere(int columns, int rows) {
    MeshData sphere;
    for (int row = 0; row <= rows; ++row) {
        for (int column = 0; column <= columns; ++column) {
            const Vec2 uv(float(column) / float(columns), float(row) / float(rows));
            const float longitude = 2 * kPi * uv.x;
            const float polar = kPi * uv.y;
            sphere.positions.emplace_back(
                std::sin(polar) * std::sin(longitude), std::cos(polar),
                std::sin(polar) * std::cos(longitude));
            sphere.normals.push_back(sphere.positions.back());
            sphere.uvs.push_back(uv);
        }
    }
    const auto at = [columns](int row, int column) {
        return static_cast<std::uint32_t>(row * (columns + 1) + column);
    };
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            for (const std::uint32_t index :
                 {at(row, column), at(row + 1, column), at(row + 1, column + 1), at(row, column),
                  at(row + 1, column + 1), at(row, column + 1)}) {
                sphere.indices.push_back(index);
            }
        }
    }
    return sphere;
}

/// The normal every corner of the mesh sees, in the order of the index buffer.
std::vector<Vec3> corner_normals(const MeshData& mesh) {
    std::vector<Vec3> normals;
    for (const std::uint32_t index : mesh.indices) {
        normals.push_back(mesh.normals[index]);
    }
    return normals;
}

}  // namespace

TEST_CASE(
    "tangents: the frame of a triangle is the gradient of position along u and v"
    * technique("bump.tangent-triangle")) {
    SUBCASE("uv equal to the position") {
        const TriangleFrame frame = triangle_frame(kUnitTriangle, {{0, 0}, {1, 0}, {0, 1}});
        CHECK(near(frame.tangent, {1, 0, 0}));
        CHECK(near(frame.bitangent, {0, 1, 0}));
        CHECK(near(glm::cross(frame.bitangent, frame.tangent), {0, 0, -1}));
        CHECK(frame.determinant > 0);
    }
    SUBCASE("a shape for which the printed sums are 26.565 and 45 degrees off") {
        const TriangleFrame frame =
            triangle_frame({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {{0, 0}, {1, 0}, {1, 1}});
        CHECK(near(frame.tangent, {1, 0, 0}));
        CHECK(near(frame.bitangent, {0, 1, 0}));
        CHECK(degrees_between({2, 1, 0}, frame.tangent) == test::near(26.565).epsilon(1e-4));
        CHECK(degrees_between({1, 1, 0}, frame.bitangent) == test::near(45.0).epsilon(1e-4));
    }
    SUBCASE("lengths are meters a unit of u and v") {
        const TriangleFrame frame =
            triangle_frame({{0, 0, 0}, {2, 0, 0}, {0, 3, 0}}, {{0, 0}, {0.5f, 0}, {0, 0.25f}});
        CHECK(near(frame.tangent, {4, 0, 0}));
        CHECK(near(frame.bitangent, {0, 12, 0}));
    }
    SUBCASE("mirrored u") {
        const TriangleFrame frame = triangle_frame(kUnitTriangle, {{0, 0}, {-1, 0}, {0, 1}});
        CHECK(near(frame.tangent, {-1, 0, 0}));
        CHECK(frame.determinant < 0);
    }
}

TEST_CASE(
    "tangents: a frame does not move with the triangle and turns with it"
    * technique("bump.tangent-triangle")) {
    const Vec2 uv[3] = {{0.1f, 0.2f}, {0.7f, 0.3f}, {0.4f, 0.9f}};
    const Vec3 p[3] = {{0.3f, 0, 1}, {1, 0.5f, 0.2f}, {0, 1, 0.4f}};
    const TriangleFrame frame = triangle_frame(p, uv);
    const Vec3 shift(10, -20, 30);
    const TriangleFrame moved = triangle_frame({p[0] + shift, p[1] + shift, p[2] + shift}, uv);
    CHECK(near(moved.tangent, frame.tangent, 1e-4f));
    CHECK(near(moved.bitangent, frame.bitangent, 1e-4f));

    const Quat turn = glm::normalize(Quat(0.7f, 0.2f, -0.5f, 0.4f));
    const TriangleFrame turned = triangle_frame({turn * p[0], turn * p[1], turn * p[2]}, uv);
    CHECK(near(turned.tangent, turn * frame.tangent, 1e-5f));
    CHECK(near(turned.bitangent, turn * frame.bitangent, 1e-5f));
}

TEST_CASE("tangents: a triangle whose uvs span no area has no frame") {
    for (const TriangleFrame& frame :
         {triangle_frame(kUnitTriangle, {{0, 0}, {0, 0}, {0, 0}}),
          triangle_frame(kUnitTriangle, {{0, 0}, {0.1f, 0.1f}, {0.7f, 0.7f}})}) {
        CHECK(frame.determinant == 0);
        CHECK(frame.tangent == Vec3(0));
    }
}

TEST_CASE(
    "tangents: the normals of a cube's corners do not depend on how its faces are cut"
    * technique("bump.tangent-vertex")) {
    for (unsigned diagonals = 0; diagonals < 64; ++diagonals) {
        MeshData cube = make_cube(diagonals);
        generate_normals(cube);
        REQUIRE(cube.positions.size() == 8);
        for (std::size_t v = 0; v < 8; ++v) {
            const Vec3 outwards = glm::normalize(cube.positions[v] - Vec3(0.5f));
            CHECK(near(cube.normals[v], outwards));
        }
    }
}

TEST_CASE("tangents: equal weights, which we do not use, would be up to 19.47 degrees off") {
    // One, two and one triangle on the three faces of a corner; then two, two and one.
    CHECK(degrees_between({1, 2, 1}, {1, 1, 1}) == test::near(19.47).epsilon(1e-3));
    CHECK(degrees_between({2, 2, 1}, {1, 1, 1}) == test::near(15.79).epsilon(1e-3));
}

TEST_CASE("tangents: below its crease angle a cube stays flat, with four vertices a face") {
    MeshData cube = make_cube(0b010110);
    generate_normals(cube, radians(50));
    CHECK(cube.positions.size() == 24);
    for (std::size_t t = 0; t < 12; ++t) {
        const std::uint32_t* v = &cube.indices[3 * t];
        const Vec3 face = glm::normalize(glm::cross(
            cube.positions[v[1]] - cube.positions[v[0]],
            cube.positions[v[2]] - cube.positions[v[0]]));
        for (int k = 0; k < 3; ++k) {
            CHECK(near(cube.normals[v[k]], face));
        }
    }
}

TEST_CASE("tangents: triangles that share no vertices are smoothed where they touch") {
    MeshData soup = make_cube(0);
    const std::vector<Vec3> points = soup.positions;
    soup.positions.clear();
    for (std::uint32_t& index : soup.indices) {
        soup.positions.push_back(points[index]);
        index = static_cast<std::uint32_t>(soup.positions.size() - 1);
    }
    generate_normals(soup);
    for (std::size_t v = 0; v < soup.positions.size(); ++v) {
        CHECK(near(soup.normals[v], glm::normalize(soup.positions[v] - Vec3(0.5f))));
    }
}

TEST_CASE(
    "tangents: the order of the triangles does not matter" * technique("bump.tangent-vertex")) {
    MeshData forward = make_sphere(12, 7);
    MeshData backward = forward;
    std::reverse(
        backward.indices.begin(), backward.indices.end());  // also turns every triangle over
    for (std::size_t t = 0; t < backward.indices.size(); t += 3) {
        std::swap(backward.indices[t], backward.indices[t + 2]);
    }
    generate_normals(forward);
    generate_normals(backward);
    generate_tangents(forward);
    generate_tangents(backward);
    REQUIRE(forward.positions.size() == backward.positions.size());
    for (std::size_t v = 0; v < forward.positions.size(); ++v) {
        CHECK(near(forward.normals[v], backward.normals[v]));
        CHECK(near(Vec3(forward.tangents[v]), Vec3(backward.tangents[v])));
        CHECK(forward.tangents[v].w == backward.tangents[v].w);
    }
}

TEST_CASE(
    "tangents: every frame is orthonormal, even without usable uvs"
    * technique("bump.tangent-vertex")) {
    for (const bool degenerate : {false, true}) {
        MeshData mesh = make_sphere(16, 9);
        if (degenerate) {
            mesh.uvs.assign(mesh.uvs.size(), Vec2(0.5f));
        }
        generate_tangents(mesh);
        REQUIRE(mesh.tangents.size() == mesh.positions.size());
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            const Vec3 t(mesh.tangents[v]);
            CHECK(std::abs(glm::length(t) - 1) <= 1e-6f);
            CHECK(std::abs(glm::dot(t, mesh.normals[v])) <= 1e-6f);
            CHECK(std::abs(mesh.tangents[v].w) == 1.0f);
        }
    }
}

TEST_CASE("tangents: on a globe they point east" * technique("bump.tangent-vertex")) {
    constexpr int kColumns = 64;
    MeshData globe = make_sphere(kColumns, 32);
    generate_tangents(globe);
    for (std::size_t v = 0; v < globe.positions.size(); ++v) {
        const Vec3& p = globe.positions[v];
        if (std::abs(p.y) < 0.95f) {
            const Vec3 east = glm::normalize(Vec3(p.z, 0, -p.x));
            CHECK(degrees_between(Vec3(globe.tangents[v]), east) <= 360.0f / kColumns);
            const Vec3 bitangent =
                globe.tangents[v].w * glm::cross(globe.normals[v], Vec3(globe.tangents[v]));
            CHECK(bitangent.y > 0);  // north: against v, which grows downwards
        }
    }
}

TEST_CASE("tangents: the bitangent points against v, and mirroring u turns w") {
    MeshData square = make_square();
    generate_tangents(square);
    for (const Vec4& tangent : square.tangents) {
        CHECK(near(Vec3(tangent), {1, 0, 0}));
        CHECK(tangent.w == 1.0f);
    }
    for (Vec2& uv : square.uvs) {
        uv.x = -uv.x;
    }
    generate_tangents(square);
    for (const Vec4& tangent : square.tangents) {
        CHECK(near(Vec3(tangent), {-1, 0, 0}));
        CHECK(tangent.w == -1.0f);
    }
}

TEST_CASE(
    "tangents: a vertex between mirrored halves is split, not averaged away"
    * technique("bump.tangent-vertex")) {
    // Two squares side by side that share the edge x = 0, u = |x|: a face textured by one half.
    MeshData face;
    face.positions = {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {-1, 1, 0}, {0, 1, 0}, {1, 1, 0}};
    face.normals.assign(6, Vec3(0, 0, 1));
    face.uvs = {{1, 1}, {0, 1}, {1, 1}, {1, 0}, {0, 0}, {1, 0}};
    face.indices = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4};
    generate_tangents(face);
    CHECK(face.positions.size() == 8);
    for (std::size_t corner = 0; corner < face.indices.size(); ++corner) {
        const Vec4& tangent = face.tangents[face.indices[corner]];
        const float side = corner < 6 ? -1.0f : 1.0f;
        CHECK(near(Vec3(tangent), {side, 0, 0}));
        CHECK(tangent.w == side);
    }
}

TEST_CASE("tangents: a split vertex keeps all that was known of it") {
    MeshData cube = make_cube(0);
    for (const Vec3& p : cube.positions) {
        cube.uvs.emplace_back(p.x, p.y);
        cube.colors.emplace_back(p, 1.0f);
    }
    generate_normals(cube, 0.0f);
    REQUIRE(cube.colors.size() == cube.positions.size());
    REQUIRE(cube.uvs.size() == cube.positions.size());
    CHECK(cube.uvs1.empty());
    for (std::size_t v = 0; v < cube.positions.size(); ++v) {
        CHECK(Vec3(cube.colors[v]) == cube.positions[v]);
        CHECK(cube.uvs[v] == Vec2(cube.positions[v]));
    }
}

TEST_CASE("tangents: a degenerate triangle changes no normal") {
    MeshData plain = make_square();
    MeshData spoiled = plain;
    spoiled.indices.insert(spoiled.indices.end(), {0, 0, 2, 1, 1, 1});
    generate_normals(plain);
    generate_normals(spoiled);
    const std::vector<Vec3> expected = corner_normals(plain);
    const std::vector<Vec3> found = corner_normals(spoiled);
    for (std::size_t corner = 0; corner < expected.size(); ++corner) {
        CHECK(near(found[corner], expected[corner]));
    }
}

TEST_CASE("tangents: a fan of 200,000 triangles about one point takes no quadratic time") {
    MeshData fan;
    fan.positions.emplace_back(0, 0, 0);
    constexpr std::uint32_t kBlades = 200'000;
    for (std::uint32_t i = 0; i <= kBlades; ++i) {
        const float angle = 2 * kPi * float(i) / float(kBlades);
        fan.positions.emplace_back(std::cos(angle), std::sin(angle), 0.1f * float(i % 2));
    }
    for (std::uint32_t i = 0; i < kBlades; ++i) {
        fan.indices.insert(fan.indices.end(), {0, i + 1, i + 2});
    }
    generate_normals(fan, radians(30));  // the CTest time limit is the check
    CHECK(near(fan.normals[0], {0, 0, 1}, 1e-2f));
}

}  // namespace limn::tangents_test
