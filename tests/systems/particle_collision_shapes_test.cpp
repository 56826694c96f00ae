#include "ecs/base/rng.h"
#include "systems/particles/collider.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace limn::particle_collision_shapes_test {

using namespace limn::test;

namespace {

using Dvec3 = glm::dvec3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vec3 random_vector(Random& random, float size) {
    return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

/// A collider beside an independent measure of how far outside a position is.
struct Shape {
    std::string name;
    Collider collider;
    float radius;
    std::function<double(const Dvec3&)> outside;
};

constexpr int kPoints = 9;
constexpr float kCell = 0.5f;

const std::vector<float>& hills() {
    static const std::vector<float> heights = [] {
        std::vector<float> made;
        Random random(1, 2, 3, 4);
        for (int i = 0; i < kPoints * kPoints; ++i) {
            made.push_back(random.uniform(-1.0f, 0.5f));
        }
        return made;
    }();
    return heights;
}

HeightCollider hilly_field() {
    return {
        .origin = {-2, 0.1f, -2},
        .cell = {kCell, kCell},
        .width = kPoints,
        .depth = kPoints,
        .heights = hills()};
}

double above_hills(const Dvec3& p) {
    const double x = (p.x + 2) / double{kCell};
    const double z = (p.z + 2) / double{kCell};
    if (x < 0 || z < 0 || x > kPoints - 1 || z > kPoints - 1) {
        return kInfinity;
    }
    const int i = std::min(static_cast<int>(x), kPoints - 2);
    const int j = std::min(static_cast<int>(z), kPoints - 2);
    double surface = double{0.1f};
    for (int corner = 0; corner < 4; ++corner) {
        const int di = corner & 1;
        const int dj = corner >> 1;
        const double weight = (di != 0 ? x - i : 1 - x + i) * (dj != 0 ? z - j : 1 - z + j);
        surface += weight * double{hills()[static_cast<std::size_t>((j + dj) * kPoints + i + di)]};
    }
    return p.y - surface;
}

std::vector<Shape> make_shapes() {
    const Vec3 normal(1, 2, -0.5f);
    const Vec3 center(0.2f, -0.1f, 0.3f);
    const Mat4 box_pose =
        glm::translate(Mat4(1), center) * glm::rotate(Mat4(1), 0.8f, glm::normalize(Vec3(1, 1, 0)));
    const glm::dmat4 box_from_world = glm::inverse(glm::dmat4(box_pose));
    const Vec3 half(0.9f, 0.3f, 0.6f);
    std::vector<Shape> shapes;
    for (const float radius : {0.0f, 0.2f}) {
        const double r = double{radius};
        shapes.push_back(
            {"plane", PlaneCollider{.normal = normal, .offset = 0.3f}, radius, [=](const Dvec3& p) {
                 return glm::dot(glm::normalize(Dvec3(normal)), p) - double{0.3f} - r;
             }});
        shapes.push_back(
            {"sphere", SphereCollider{.center = center, .radius = 0.8f}, radius,
             [=](const Dvec3& p) { return glm::length(p - Dvec3(center)) - double{0.8f} - r; }});
        shapes.push_back(
            {"hollow", SphereCollider{.center = center, .radius = 1.5f, .inverted = true}, radius,
             [=](const Dvec3& p) { return double{1.5f} - r - glm::length(p - Dvec3(center)); }});
        shapes.push_back(
            {"box", BoxCollider{.world_from_box = to_affine(box_pose), .half = half}, radius,
             [=](const Dvec3& p) {
                 const Dvec3 local =
                     glm::abs(box_from_world * glm::dvec4(p, 1)) - glm::dvec4(half, 0);
                 return std::max({local.x, local.y, local.z}) - r;
             }});
    }
    shapes.push_back({"height field", hilly_field(), 0, above_hills});
    return shapes;
}

}  // namespace

TEST_CASE(
    "particle collision: the first contact is where dense samples of the path turn negative") {
    constexpr int kSamples = 500;
    Random random(2, 2, 2, 2);
    for (const Shape& shape : make_shapes()) {
        CAPTURE(shape.name);
        CAPTURE(shape.radius);
        int contacts = 0;
        for (int n = 0; n < 1000; ++n) {
            const Vec3 from = random_vector(random, 2);
            const Vec3 to = random_vector(random, 2);
            const auto at = [&](double fraction) {
                return shape.outside(Dvec3(from) + fraction * (Dvec3(to) - Dvec3(from)));
            };
            const std::optional<Contact> found =
                first_contact(shape.collider, from, to, shape.radius);
            if (at(0) <= 0) {
                CHECK(!found);
                continue;
            }
            const double fraction = found ? double{found->fraction} : 1.0;
            contacts += found ? 1 : 0;
            bool clear = true;
            for (int i = 0; i <= kSamples && i < fraction * kSamples - 1e-3; ++i) {
                clear = clear && at(i / double{kSamples}) > -1e-6;
            }
            CHECK(clear);
            if (found) {
                CHECK(std::abs(shape.outside(Dvec3(found->point))) < 2e-6);
                CHECK(glm::dot(found->normal, to - from) < 1e-5f);
                CHECK(double{glm::length(found->normal)} == near(1));
                // The normal is the gradient, wherever there is one.
                const double step = 1e-3;
                const double change =
                    shape.outside(Dvec3(found->point) + step * Dvec3(found->normal));
                if (shape.name != "height field") {
                    CHECK(change == near(step).epsilon(0.01));
                }
            }
        }
        CHECK(contacts > 100);
    }
}

TEST_CASE(
    "particle collision: one push moves a particle outside, by the shortest distance"
    * technique("particle.constraints")) {
    Random random(3, 3, 3, 3);
    for (const Shape& shape : make_shapes()) {
        CAPTURE(shape.name);
        int inside = 0;
        for (int n = 0; n < 3000; ++n) {
            const Vec3 from = random_vector(random, 1.9f);
            const double before = shape.outside(Dvec3(from));
            const Vec3 to = push_out(shape.collider, from, shape.radius);
            if (before >= 0) {
                CHECK(to == from);
                continue;
            }
            ++inside;
            CHECK(std::abs(shape.outside(Dvec3(to))) < 2e-6);
            CHECK(push_out(shape.collider, to, shape.radius) == to);
            CHECK(double{glm::distance(from, to)} == near(-before).scale(1).epsilon(2e-6));
        }
        CHECK(inside > 50);
    }
}

TEST_CASE(
    "particle collision: the examples of sphere, floor and terrain constraints"
    * technique("particle.constraints")) {
    const Collider sphere = SphereCollider{.radius = 2};
    CHECK(push_out(sphere, {0.5f, 0, 0}) == Vec3(2, 0, 0));
    CHECK(push_out(sphere, Vec3(0)) == Vec3(0, 2, 0));  // up from the center
    CHECK(push_out(sphere, {0, 0, 3}) == Vec3(0, 0, 3));
    CHECK(push_out(PlaneCollider{}, {1, -3, 0}) == Vec3(1, 0, 0));
    const std::vector<float> level(4, 0.5f);
    const Collider terrain =
        HeightCollider{.origin = {0, 1, 0}, .width = 2, .depth = 2, .heights = level};
    CHECK(push_out(terrain, {0.3f, -7, 0.6f}) == Vec3(0.3f, 1.5f, 0.6f));
    CHECK(push_out(terrain, {0.3f, 2, 0.6f}) == Vec3(0.3f, 2, 0.6f));
    CHECK(push_out(terrain, {-0.3f, -7, 0.6f}) == Vec3(-0.3f, -7, 0.6f));  // beyond its edge
}

TEST_CASE(
    "particle collision: a sphere pushes along the ray from its center"
    * technique("particle.constraints")) {
    Random random(4, 4, 4, 4);
    const Vec3 center(1, 2, 3);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 delta = random_vector(random, 0.5f);
        const Vec3 out = push_out(SphereCollider{.center = center, .radius = 2}, center + delta);
        CHECK(double{glm::length(glm::cross(out - center, glm::normalize(delta)))} < 1e-5);
        CHECK(glm::dot(out - center, delta) > 0);
    }
}

TEST_CASE(
    "particle collision: a flat height field has the normal up, a slope of 1 leans by 45 degrees") {
    const float heights[] = {0, 0, 0, 0};
    const float slope[] = {0, 1, 0, 1};
    const Vec3 from(0.4f, 3, 0.6f);
    const Vec3 to(0.4f, -3, 0.6f);
    const auto flat =
        first_contact(HeightCollider{.width = 2, .depth = 2, .heights = heights}, from, to);
    const auto tilted =
        first_contact(HeightCollider{.width = 2, .depth = 2, .heights = slope}, from, to);
    REQUIRE(flat);
    CHECK(flat->normal == Vec3(0, 1, 0));
    REQUIRE(tilted);
    CHECK(double{tilted->normal.x} == near(-std::sqrt(0.5)));
    CHECK(double{tilted->normal.y} == near(std::sqrt(0.5)));
    CHECK(tilted->normal.z == 0);
    CHECK(double{tilted->point.y} == near(0.4));
}

TEST_CASE(
    "particle collision: the normal of a height field is that of its central differences"
    * technique("particle.heightfield-collision")) {
    Random random(5, 5, 5, 5);
    for (int n = 0; n < 2000; ++n) {
        const Vec3 from(random.uniform(-1.9f, 1.9f), 2, random.uniform(-1.9f, 1.9f));
        const auto found = first_contact(hilly_field(), from, from - Vec3(0, 4, 0));
        REQUIRE(found);
        const double h = 1e-4;
        const Dvec3 p(found->point);
        const double cell_x = std::fmod(p.x + 2, 0.5);
        const double cell_z = std::fmod(p.z + 2, 0.5);
        if (std::min(cell_x, cell_z) < h || std::max(cell_x, cell_z) > 0.5 - h) {
            continue;  // a crease
        }
        const Dvec3 slope(
            above_hills(p + Dvec3(h, 0, 0)) - above_hills(p - Dvec3(h, 0, 0)), 2 * h,
            above_hills(p + Dvec3(0, 0, h)) - above_hills(p - Dvec3(0, 0, h)));
        const Dvec3 expected = glm::normalize(slope);
        CHECK(glm::distance(expected, Dvec3(found->normal)) < 1e-5);
    }
}

TEST_CASE("particle collision: a mesh is met from both sides, at the first of its triangles") {
    // Two sheets one behind the other, y = 0 and y = -0.001.
    const Vec3 positions[] = {{-5, 0, -5},       {5, 0, -5},       {0, 0, 5},
                              {-5, -0.001f, -5}, {5, -0.001f, -5}, {0, -0.001f, 5}};
    const std::uint32_t indices[] = {0, 1, 2, 3, 4, 5};
    const MeshBvh bvh = build_mesh_bvh(positions, indices);
    const MeshCollider mesh = {.bvh = &bvh};
    const auto down = first_contact(mesh, {0, 1, 0}, {0, -1, 0});
    REQUIRE(down);
    CHECK(double{down->fraction} == near(0.5));
    CHECK(down->normal == Vec3(0, 1, 0));
    const auto up = first_contact(mesh, {0, -1, 0}, {0, 1, 0});
    REQUIRE(up);
    CHECK(double{up->fraction} == near(0.4995));
    CHECK(up->normal == Vec3(0, -1, 0));
    CHECK(!first_contact(mesh, {9, 1, 0}, {9, -1, 0}));
    CHECK(!first_contact(MeshCollider{}, {0, 1, 0}, {0, -1, 0}));
    CHECK(push_out(mesh, {0, -0.0005f, 0}) == Vec3(0, -0.0005f, 0));
}

TEST_CASE(
    "particle collision: a ball touches a mesh a radius away from the plane, up to 75 degrees") {
    const Vec3 positions[] = {{-50, 0, -50}, {50, 0, -50}, {0, 0, 50}};
    const std::uint32_t indices[] = {0, 1, 2};
    const MeshBvh bvh = build_mesh_bvh(positions, indices);
    const float radius = 0.1f;
    Random random(6, 6, 6, 6);
    for (int n = 0; n < 1000; ++n) {
        const float lean = random.uniform(0.0f, 1.3f);
        const float around = random.uniform(0.0f, 6.28f);
        const float side = n % 2 == 0 ? 1.0f : -1.0f;
        const Vec3 path = random.uniform(0.2f, 3.0f)
                          * Vec3(
                              std::sin(lean) * std::cos(around), -side * std::cos(lean),
                              std::sin(lean) * std::sin(around));
        const Vec3 from(0, side * (radius + random.uniform(0.0f, 0.5f)), 0);
        const auto found = first_contact(MeshCollider{.bvh = &bvh}, from, from + path, radius);
        const bool reaches = std::abs(from.y) - std::abs(path.y) < radius;
        CHECK(found.has_value() == reaches);
        if (found) {
            CHECK(double{found->point.y} == near(double{side * radius}).epsilon(1e-4));
            CHECK(found->normal == Vec3(0, side, 0));
        }
    }
}

TEST_CASE("particle collision: a ball nearer to a mesh than its radius touches at once") {
    const Vec3 positions[] = {{-5, 0, -5}, {5, 0, -5}, {0, 0, 5}};
    const std::uint32_t indices[] = {0, 1, 2};
    const MeshBvh bvh = build_mesh_bvh(positions, indices);
    const auto found = first_contact(MeshCollider{.bvh = &bvh}, {0, 0.2f, 0}, {0, -1, 0}, 0.5f);
    REQUIRE(found);
    CHECK(found->fraction == 0);
    CHECK(found->point == Vec3(0, 0.5f, 0));
    CHECK(!first_contact(MeshCollider{.bvh = &bvh}, {0, 0.2f, 0}, {0, 1, 0}, 0.5f));
}

TEST_CASE("particle collision: paths without length or that are not finite hit nothing") {
    const Collider plane = PlaneCollider{};
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    CHECK(!first_contact(plane, {0, 0, 0}, {0, 0, 0}));
    CHECK(!first_contact(plane, {0, nan, 0}, {0, -1, 0}));
    CHECK(!first_contact(plane, {0, 1, 0}, {0, -infinity, 0}));
    CHECK(!find_escape(plane, {0, nan, 0}, 0));
}

TEST_CASE("particle collision: a tangent on the wall of a hollow leaves it at once") {
    const Collider hollow = SphereCollider{.radius = 1, .inverted = true};
    const auto found = first_contact(hollow, {1, 0, 0}, {1, 1, 0});
    REQUIRE(found);
    CHECK(found->fraction == 0);
    CHECK(found->normal == Vec3(-1, 0, 0));
}

}  // namespace limn::particle_collision_shapes_test
