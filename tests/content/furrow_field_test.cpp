#include "content/bake/furrow_field.h"
#include "content/bake/furrow_map.h"
#include "content/make/models/shapes.h"
#include "ecs/base/rng.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace limn::furrow_field_test {
namespace {

bool near_to(const Vec3& a, const Vec3& b, float tolerance = 1e-6f) {
    return glm::length(a - b) <= tolerance;
}

/// Two edits at distances 1 and 3 from the origin.
struct Pair {
    std::vector<Vec3> positions = {{1, 0, 0}, {-3, 0, 0}};
    std::vector<FurrowEdit> edits = {
        {0, {Vec3(1, 0, 0), Vec3(0, 1, 0)}, 1}, {1, {Vec3(0, 2, 0), Vec3(2, 0, 0)}, 1}};
    [[nodiscard]] FurrowVectors at_origin() const {
        return interpolate_furrow_vectors({0, 0, 0}, edits, positions, {Vec3(7), Vec3(7)});
    }
};

/// A square of two triangles that faces +z, from (x, y) = -1 to 1, with uvs.
MeshData make_square() {
    MeshData mesh;
    mesh.name = "square";
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.normals = std::vector<Vec3>(4, Vec3(0, 0, 1));
    mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    return mesh;
}

Vec3 field_in(const FurrowTriangle& triangle, int field) {
    return {triangle.field[field], 0};
}

}  // namespace

TEST_CASE(
    "furrow field: initial vectors are tangent, perpendicular and equally long"
    * technique("wrinkle.furrow.field-init")) {
    Random random(1, 2, 3, 4);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 n = random.direction();
        const FurrowVectors d = initial_furrow_vectors(n);
        CHECK(std::abs(glm::dot(d[0], n)) < 1e-6f);
        CHECK(std::abs(glm::dot(d[1], n)) < 1e-6f);
        CHECK(std::abs(glm::dot(d[0], d[1])) < 1e-6f);
        CHECK(glm::length(d[0]) == test::near(glm::length(d[1])).epsilon(1e-4));
        CHECK(glm::length(d[0]) == test::near(std::sqrt(1 - n.y * n.y)).epsilon(1e-3).scale(0.1));
    }
    const FurrowVectors front = initial_furrow_vectors({0, 0, 1});
    CHECK(front[0] == Vec3(0, 1, 0));
    CHECK(front[1] == Vec3(1, 0, 0));
    for (const float up : {1.0f, -1.0f}) {
        const FurrowVectors pole = initial_furrow_vectors({0, up, 0});
        CHECK(pole[0] == Vec3(0, 0, -1));
        CHECK(glm::length(pole[1]) == 1.0f);
    }
}

TEST_CASE(
    "furrow field: between two edits vectors are weighted by weight over distance"
    * technique("wrinkle.furrow.field-interpolate")) {
    Pair pair;
    CHECK(near_to(pair.at_origin()[0], {0.75f, 0.5f, 0}));
    CHECK(near_to(pair.at_origin()[1], {0.5f, 0.75f, 0}));
    pair.edits[1].weight = 3;
    CHECK(near_to(pair.at_origin()[0], {0.5f, 1.0f, 0}));
    const FurrowVectors before = pair.at_origin();
    for (FurrowEdit& edit : pair.edits) {
        edit.weight *= 2.5f;
    }
    CHECK(near_to(pair.at_origin()[0], before[0]));
    CHECK(near_to(pair.at_origin()[1], before[1]));
}

TEST_CASE(
    "furrow field: one edit makes a constant field, and edited vertices keep their vectors"
    * technique("wrinkle.furrow.field-interpolate")) {
    Random random(5, 0, 0, 0);
    std::vector<Vec3> positions;
    std::vector<Vec3> normals(200, Vec3(0, 0, 1));
    for (int i = 0; i < 200; ++i) {
        positions.emplace_back(random.uniform(-1, 1), random.uniform(-1, 1), 0);
    }
    const FurrowVectors set = {Vec3(0.3f, 0.4f, 0), Vec3(-1, 1, 0)};
    for (const FurrowVectors& d :
         make_furrow_field(positions, normals, std::vector{FurrowEdit{17, set, 1}})) {
        CHECK(near_to(d[0], set[0]));
        CHECK(near_to(d[1], set[1]));
    }
    std::vector<FurrowEdit> edits;
    for (std::uint32_t i = 0; i < 5; ++i) {
        edits.push_back(
            {40 * i, {Vec3(random.uniform(-1, 1), random.uniform(-1, 1), 0), Vec3(1, 0, 0)}, 1});
    }
    const auto field = make_furrow_field(positions, normals, edits);
    Vec3 low(INFINITY);
    Vec3 high(-INFINITY);
    for (const FurrowEdit& edit : edits) {
        CHECK(near_to(field[edit.vertex][0], edit.vectors[0], 1e-7f));
        low = glm::min(low, edit.vectors[0]);
        high = glm::max(high, edit.vectors[0]);
    }
    for (const FurrowVectors& d : field) {  // within the hull of the edits
        CHECK(glm::all(glm::greaterThanEqual(d[0], low - 1e-6f)));
        CHECK(glm::all(glm::lessThanEqual(d[0], high + 1e-6f)));
    }
}

TEST_CASE(
    "furrow field: without any weight the initial field stays"
    * technique("wrinkle.furrow.field-interpolate")) {
    const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}};
    const std::vector<Vec3> normals = {{0, 0, 1}, {1, 0, 0}};
    const std::vector<FurrowEdit> edits = {{0, {Vec3(2, 0, 0), Vec3(0, 2, 0)}, 0}};
    const auto field = make_furrow_field(positions, normals, edits);
    for (int i = 0; i < 2; ++i) {
        CHECK(near_to(field[i][0], initial_furrow_vectors(normals[i])[0]));
        CHECK(near_to(field[i][1], initial_furrow_vectors(normals[i])[1]));
    }
}

TEST_CASE(
    "furrow field: vectors are tangent on a ball, with the magnitude that was set"
    * technique("wrinkle.furrow.field-interpolate")) {
    const MeshData ball = make_sphere({.radius = 1, .segments = 24, .rings = 12});
    const std::vector<FurrowArrow> arrows = {
        {.at = {0, 0, 1}, .first = {0, 1.5f, 3}, .second = {0.5f, 0, 0}}};
    const auto edits = place_furrow_arrows(arrows, ball.positions, ball.normals);
    REQUIRE(edits.size() == 1);
    CHECK(near_to(ball.positions[edits[0].vertex], {0, 0, 1}, 0.01f));
    CHECK(glm::length(edits[0].vectors[0]) == test::near(2));  // clamped
    const auto field = make_furrow_field(ball.positions, ball.normals, edits);
    for (std::size_t i = 0; i < field.size(); ++i) {
        CHECK(std::abs(glm::dot(field[i][0], ball.normals[i])) < 1e-5f);
        CHECK(std::abs(glm::dot(field[i][1], ball.normals[i])) < 1e-5f);
        const float length = glm::length(field[i][1]);  // 0 where the field points outwards
        CHECK((length < 1e-3f || std::abs(length - 0.5f) < 1e-5f));
    }
}

TEST_CASE(
    "furrow map: the angle around a cylinder runs from +z over +x"
    * technique("wrinkle.furrow.map-cylinder")) {
    CHECK(cylinder_angle({1, 0, 0}) == test::near(kPi / 2));
    CHECK(cylinder_angle({-1, 5, 0}) == test::near(3 * kPi / 2));
    CHECK(cylinder_angle({0, 3, -1}) == test::near(kPi));
    CHECK(cylinder_angle({0, 3, 2}) == test::near(2 * kPi));
    CHECK(cylinder_angle({0, 1, 0}) == 0);
    for (float s = 0.01f; s < 6.28f; s += 0.1f) {
        CHECK(cylinder_angle({3 * std::sin(s), 1, 3 * std::cos(s)}) == test::near(s).epsilon(1e-3));
        CHECK(near_to(unroll_vector({std::sin(s), 0, std::cos(s)}, s), {0, 0, 1}));
    }
    CHECK(near_to(unroll_vector({0, 0, -1}, kPi / 2), {1, 0, 0}));
    CHECK(near_to(unroll_vector({1, 2, 3}, 0), {1, 2, 3}));
}

TEST_CASE(
    "furrow map: a plane viewed from the front keeps lengths and directions"
    * technique("wrinkle.furrow.map-planar")) {
    const MeshData square = make_square();
    const auto field = make_furrow_field(square.positions, square.normals, {});
    const auto map = make_furrow_map(square, field, {.projection = FurrowProjection::Planar});
    REQUIRE(map.ok());
    REQUIRE(map->triangles.size() == 2);
    CHECK(map->size == IVec2(512, 512));
    const FurrowTriangle& first = map->triangles[0];
    // 98 % of the image, with a margin of 1 % on each side; rows run downwards.
    const float side = 0.98f * 512;
    const Vec2 corner(0.01f * 512, 0.99f * 512);
    CHECK(glm::distance(first.corner[0], corner) < 1e-3f);
    CHECK(glm::distance(first.corner[0], first.corner[1]) == test::near(std::sqrt(2.0f) * side));
    CHECK(near_to(field_in(first, 0), {0, -1, 0}));
    CHECK(near_to(field_in(first, 1), {1, 0, 0}));
    CHECK(near_to(first.normal, {0, 0, 1}));
    CHECK(first.field_right[0] == Vec2(0, 0));
}

TEST_CASE(
    "furrow map: a planar map skips back faces, and areas shrink by the slope"
    * technique("wrinkle.furrow.map-planar")) {
    MeshData tilted = make_square();
    for (Vec3& p : tilted.positions) {
        p = {0.6f * p.x, p.y, 0.8f * p.x};  // its normal is (-0.8, 0, 0.6)
    }
    for (Vec3& n : tilted.normals) {
        n = {-0.8f, 0, 0.6f};
    }
    const auto field = make_furrow_field(tilted.positions, tilted.normals, {});
    const FurrowMapShape planar = {.projection = FurrowProjection::Planar, .size = 100};
    const auto map = make_furrow_map(tilted, field, planar);
    REQUIRE(map.ok());
    double area = 0;
    for (const FurrowTriangle& t : map->triangles) {
        const Vec2 ab = t.corner[1] - t.corner[0];
        const Vec2 ac = t.corner[2] - t.corner[0];
        area += 0.5 * static_cast<double>(ab.x * ac.y - ab.y * ac.x);
    }
    CHECK(area == test::near(0.6 * 98 * 98));  // |n_z| of a square with side 98 px
    std::swap(tilted.indices[1], tilted.indices[2]);
    CHECK(make_furrow_map(tilted, field, planar)->triangles.size() == 1);
    std::swap(tilted.indices[4], tilted.indices[5]);
    const auto none = make_furrow_map(tilted, field, planar);
    REQUIRE(!none.ok());
    CHECK(none.error().message.find("found no triangle") != std::string::npos);
}

TEST_CASE(
    "furrow map: a tube unrolls to a whole turn, with lengths equal along and around"
    * technique("wrinkle.furrow.map-cylinder")) {
    const MeshData tube =
        make_cylinder({.radius = 0.5f, .height = 2, .segments = 64, .caps = false});
    const auto field = make_furrow_field(tube.positions, tube.normals, {});
    const auto map =
        make_furrow_map(tube, field, {.projection = FurrowProjection::Cylinder, .size = 314});
    REQUIRE(map.ok());
    CHECK(map->wrap_s);
    CHECK(!map->wrap_t);
    CHECK(map->size.y == 200);  // 2 m high, pi around: 314 px
    for (const FurrowTriangle& t : map->triangles) {
        CHECK(std::abs(t.corner[1].x - t.corner[0].x) < 6.0f);  // none spans the seam
        CHECK(near_to(field_in(t, 0), {0, -1, 0}, 1e-5f));
        CHECK(near_to(field_in(t, 1), {1, 0, 0}, 1e-5f));
        CHECK(near_to(t.normal, {0, 0, 1}, 1e-5f));
    }
}

TEST_CASE("furrow map: texture coordinates turn vectors by the Jacobian and keep magnitudes") {
    MeshData square = make_square();
    for (Vec2& uv : square.uvs) {  // turned by 90 degrees and squeezed
        uv = {uv.y, 0.5f - 0.5f * uv.x};
    }
    const std::vector<FurrowArrow> arrows = {
        {.at = {0, 0, 0}, .first = {0, 1.5f, 0}, .second = {1, 1, 0}}};
    const auto edits = place_furrow_arrows(arrows, square.positions, square.normals);
    const auto field = make_furrow_field(square.positions, square.normals, edits);
    const auto map = make_furrow_map(square, field, {});
    REQUIRE(map.ok());
    // +y is -v of the picture, which is now -u; +x is +u, now -v at half the length.
    const FurrowTriangle& first = map->triangles[0];
    CHECK(near_to(field_in(first, 0), {-1.5f, 0, 0}, 1e-5f));
    CHECK(near_to(field_in(first, 1), std::sqrt(2.0f) * glm::normalize(Vec3(-1, -0.5f, 0)), 1e-5f));
    CHECK(first.normal == Vec3(0, 0, 1));
}

TEST_CASE("furrow map: an image that repeats is covered by texture coordinates beyond it") {
    MeshData square = make_square();
    for (Vec2& uv : square.uvs) {
        uv = uv + 2.25f;
    }
    const auto field = make_furrow_field(square.positions, square.normals, {});
    const auto map = make_furrow_map(square, field, {.size = 64, .tiles = true});
    REQUIRE(map.ok());
    double inside = 0;
    for (const FurrowTriangle& t : map->triangles) {
        for (const Vec2& corner : t.corner) {
            CHECK(corner.x > -64.1f);
            CHECK(corner.x < 128.1f);
        }
        inside += 1;
    }
    CHECK(inside >= 8);
    square.uvs[1].x = 1e9f;  // would need a billion copies
    CHECK(make_furrow_map(square, field, {.size = 64, .tiles = true})->triangles.size() < 8);
}

TEST_CASE("furrow map: a mesh that cannot be flattened is an error with a reason") {
    MeshData square = make_square();
    const auto field = make_furrow_field(square.positions, square.normals, {});
    square.uvs.clear();
    CHECK(
        make_furrow_map(square, field, {}).error().message
        == "square: found no texture coordinates, expected some");
    square.uvs = std::vector<Vec2>(4, Vec2(0.5f));
    CHECK(
        make_furrow_map(square, field, {}).error().message
        == "square: found no triangle with an area in the image, expected at least one");
    MeshData stick = make_cylinder({.radius = 0.001f, .height = 2, .segments = 8});
    stick.name = "stick";
    const auto along = make_furrow_field(stick.positions, stick.normals, {});
    const auto map =
        make_furrow_map(stick, along, {.projection = FurrowProjection::Cylinder, .size = 512});
    REQUIRE(!map.ok());
    CHECK(map.error().message.find("stick: found 2 m along y") == 0);
}

}  // namespace limn::furrow_field_test
