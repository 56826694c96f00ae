#include "render/geometry/mesh_curvature.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cmath>

namespace limn::test::mesh_curvature_test {
namespace {

/// A regular ring of `count` neighbors on a sphere of this radius, `angle` from its pole, which is
/// the vertex: in its tangent frame. Negative radius: from inside.
std::vector<Vec3> sphere_ring(int count, float radius, float angle) {
    std::vector<Vec3> ring;
    for (int i = 0; i < count; ++i) {
        const float turn = 2 * kPi * (static_cast<float>(i) + 0.3f) / static_cast<float>(count);
        const float across = std::abs(radius) * std::sin(angle);
        ring.emplace_back(
            across * std::cos(turn), across * std::sin(turn),
            -2 * radius * std::sin(angle / 2) * std::sin(angle / 2));
    }
    return ring;
}

/// A rectangle of two triangles.
MeshData rectangle(const Vec2& size, const Vec2& tiles) {
    MeshData mesh = make_square();
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        mesh.positions[i] *= 0.5f * Vec3(size, 1);
        mesh.uvs[i] *= tiles;
    }
    return mesh;
}

void check_scales(const MeshData& mesh, const Vec2& expected) {
    for (const Vec2& scale : mapping_scales(mesh)) {
        CHECK(scale.x == near(expected.x));
        CHECK(scale.y == near(expected.y));
    }
}

}  // namespace

TEST_CASE(
    "mesh curvature: the length of a tile along u and v" * technique("relief.mapping-scale")) {
    check_scales(rectangle({2, 3}, {1, 1}), {2, 3});
    check_scales(rectangle({2, 3}, {4, 4}), {0.5f, 0.75f});
    check_scales(rectangle({2, 3}, {-1, 1}), {2, 3});  // mirrored
    check_scales(rectangle({20, 30}, {1, 1}), {20, 30});
    MeshData turned = rectangle({2, 3}, {1, 1});
    for (Vec2& uv : turned.uvs) {
        uv = {uv.y, uv.x};
    }
    check_scales(turned, {3, 2});
    check_scales(rectangle({2, 3}, {0, 0}), {0, 0});  // no area in texture space
}

TEST_CASE(
    "mesh curvature: rings on spheres have 1 / (R (1 + cos angle))"
    * technique("relief.curvature-fit")) {
    const auto check = [](float radius, float angle, float expected) {
        for (const int count : {3, 5, 6, 12}) {
            const Vec2 fit = fit_quadric(sphere_ring(count, radius, angle));
            CAPTURE(count);
            CHECK(fit.x == near(expected).epsilon(2e-5));
            CHECK(fit.y == near(expected).epsilon(2e-5));
        }
    };
    check(1, 0.5f, 0.532600f);
    check(1, 0.2f, 0.505034f);
    check(1, 0.05f, 0.500313f);
    check(2, 0.5f, 0.266300f);
    check(-1, 0.5f, -0.532600f);
}

TEST_CASE(
    "mesh curvature: cylinders, saddles and planes are fitted exactly"
    * technique("relief.curvature-fit")) {
    std::vector<Vec3> cylinder;
    std::vector<Vec3> saddle;
    std::vector<Vec3> plane;
    for (const float x : {-0.2f, 0.0f, 0.2f}) {
        for (const float y : {-0.2f, 0.0f, 0.2f}) {
            if (x != 0 || y != 0) {
                cylinder.emplace_back(x, y, std::sqrt(1 - x * x) - 1);
                saddle.emplace_back(x, y, -(0.3f * x * x - 0.2f * y * y));
                plane.emplace_back(x, y, 0);
            }
        }
    }
    CHECK(fit_quadric(cylinder).x == near(0.505103));
    CHECK(fit_quadric(cylinder).y == near(0).scale(1));
    CHECK(fit_quadric(saddle).x == near(0.3));
    CHECK(fit_quadric(saddle).y == near(-0.2));
    CHECK(fit_quadric(plane) == Vec2(0));
    CHECK(fit_quadric({cylinder[0], cylinder[1]}) == Vec2(0));  // too few
}

TEST_CASE(
    "mesh curvature: fine rings keep their curvature, and four on the diagonals share it"
    * technique("relief.curvature-fit")) {
    // The determinant of a ring of six is 4.5 e^8, e its radius: no absolute threshold serves.
    CHECK(fit_quadric(sphere_ring(6, 1, 0.02f)).x == near(0.5).epsilon(1e-3));
    const float z = -0.5f * (0.01f + 0.01f);
    const Vec2 fit =
        fit_quadric({{0.1f, 0.1f, z}, {-0.1f, 0.1f, z}, {-0.1f, -0.1f, z}, {0.1f, -0.1f, z}});
    CHECK(fit.x == near(0.5));
    CHECK(fit.y == near(0.5));
}

TEST_CASE(
    "mesh curvature: a ball is convex everywhere, across the seam of its texture"
    * technique("relief.curvature-fit, relief.vertex-format")) {
    MeshData ball = make_ball(64);
    REQUIRE(ball.tangents.size() == ball.positions.size());
    int checked = 0;
    const std::vector<Vec2> curvatures = fit_curvatures(ball);
    REQUIRE(curvatures.size() == ball.positions.size());
    for (std::size_t i = 0; i < curvatures.size(); ++i) {
        if (std::abs(ball.positions[i].y) < 0.9f) {  // where quads are not slivers
            CHECK(curvatures[i].x == near(0.5).epsilon(0.01));
            CHECK(curvatures[i].y == near(0.5).epsilon(0.01));
            ++checked;
        }
    }
    CHECK(checked > 1000);
    ball.tangents.clear();
    CHECK(fit_curvatures(ball)[100] == Vec2(0));
}

TEST_CASE(
    "mesh curvature: the rim of a cap is flat, although it touches a round side"
    * technique("relief.curvature-fit")) {
    // A cap of eight sectors and a collar that goes down from its rim, with normals of their own.
    MeshData mesh;
    const auto add = [&mesh](const Vec3& position, const Vec3& normal, const Vec3& tangent) {
        mesh.positions.push_back(position);
        mesh.normals.push_back(normal);
        mesh.tangents.emplace_back(tangent, 1);
        return static_cast<std::uint32_t>(mesh.positions.size() - 1);
    };
    add({0, 0, 0}, {0, 0, 1}, {1, 0, 0});
    for (int i = 0; i < 8; ++i) {
        const float turn = 2 * kPi * static_cast<float>(i) / 8;
        const Vec3 out = {std::cos(turn), std::sin(turn), 0};
        const Vec3 along = {-out.y, out.x, 0};
        add(out, {0, 0, 1}, {1, 0, 0});
        add(out, out, along);
        add(out - Vec3(0, 0, 1), out, along);
    }
    for (std::uint32_t i = 0; i < 8; ++i) {
        const std::uint32_t a = 1 + 3 * i;
        const std::uint32_t b = 1 + 3 * ((i + 1) % 8);
        mesh.indices.insert(
            mesh.indices.end(), {0, a, b, a + 1, a + 2, b + 2, a + 1, b + 2, b + 1});
    }
    const std::vector<Vec2> curvatures = fit_curvatures(mesh);
    CHECK(curvatures[1] == Vec2(0));
    CHECK(curvatures[2].x == near(0.585786));  // the side: 1 / (R (1 + cos 45 degrees))
}

TEST_CASE("mesh curvature: quadrics by the signs of A and B" * technique("relief.quadric-class")) {
    CHECK(quadric_class({0, 0}) == QuadricClass::Plane);
    CHECK(quadric_class({0.5f, 0}) == QuadricClass::Cylinder);
    CHECK(quadric_class({0, -0.2f}) == QuadricClass::Cylinder);
    CHECK(quadric_class({0.5f, 0.5f}) == QuadricClass::Paraboloid);
    CHECK(quadric_class({-1, -2}) == QuadricClass::Paraboloid);
    CHECK(quadric_class({0.3f, -0.2f}) == QuadricClass::Saddle);
    CHECK(quadric_class({0.3f, -0.2f}, 0.25f) == QuadricClass::Cylinder);
}

}  // namespace limn::test::mesh_curvature_test
