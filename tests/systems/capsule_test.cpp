// Nearest points of segments and triangles against dense samples, and capsules that leave
// triangles.

#include "ecs/base/rng.h"
#include "systems/characters/capsule.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>

namespace limn::capsule_test {

using namespace limn::test;

namespace {

Vec3 any_point(Random& random, float size = 1) {
    return Vec3{
        random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

TriangleCorners any_triangle(Random& random) {
    TriangleCorners triangle{};
    for (Vec3& corner : triangle) {
        corner = any_point(random);
    }
    return triangle;
}

/// The least distance of a point to a grid of points of the triangle.
double sampled_distance(const TriangleCorners& t, const Vec3& point) {
    double least = std::numeric_limits<double>::infinity();
    constexpr int kGrid = 60;
    for (int i = 0; i <= kGrid; ++i) {
        for (int k = 0; i + k <= kGrid; ++k) {
            const float u = float(i) / kGrid;
            const float v = float(k) / kGrid;
            const Vec3 at = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
            least = std::min(least, double(glm::distance(at, point)));
        }
    }
    return least;
}

double distance_to(const TriangleCorners& t, const Capsule& capsule) {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= 400; ++i) {
        const Vec3 at = glm::mix(capsule.low, capsule.high, float(i) / 400);
        least = std::min(least, double(glm::distance(nearest_on_triangle(t, at), at)));
    }
    return least;
}

}  // namespace

TEST_CASE("capsule: the nearest point of a triangle is no farther than any other") {
    Random random(12, 0, 0, 0);
    for (int i = 0; i < 400; ++i) {
        const TriangleCorners triangle = any_triangle(random);
        const Vec3 point = any_point(random, 2);
        const double found = glm::distance(nearest_on_triangle(triangle, point), point);
        const double sampled = sampled_distance(triangle, point);
        CHECK(found <= sampled + 1e-5);
        CHECK(found >= sampled - 0.05);  // the point is on the triangle, whose grid is that coarse
    }
}

TEST_CASE("capsule: the nearest points of two segments, also of parallel ones and of points") {
    Random random(34, 0, 0, 0);
    for (int i = 0; i < 400; ++i) {
        const Vec3 a0 = any_point(random);
        const Vec3 a1 = i % 7 == 0 ? a0 : any_point(random);
        const Vec3 b0 = any_point(random);
        const Vec3 b1 = i % 5 == 0 ? b0 + (a1 - a0) : i % 11 == 0 ? b0 : any_point(random);
        const NearestPoints found = nearest_of_segments(a0, a1, b0, b1);
        double least = std::numeric_limits<double>::infinity();
        for (int u = 0; u <= 60; ++u) {
            for (int v = 0; v <= 60; ++v) {
                const Vec3 a = glm::mix(a0, a1, float(u) / 60);
                const Vec3 b = glm::mix(b0, b1, float(v) / 60);
                least = std::min(least, double(glm::distance(a, b)));
            }
        }
        CHECK(double(found.distance) <= least + 1e-5);
        CHECK(double(found.distance) >= least - 0.06);
        CHECK(double(glm::distance(found.a, found.b)) == near(double(found.distance)).scale(1));
    }
}

TEST_CASE("capsule: moved by the depth of its contact it only touches the triangle") {
    Random random(56, 0, 0, 0);
    int contacts = 0;
    int crossings = 0;
    for (int i = 0; i < 2000; ++i) {
        const TriangleCorners triangle = any_triangle(random);
        Capsule capsule = {any_point(random), any_point(random), random.uniform(0.05f, 0.4f)};
        const double before = distance_to(triangle, capsule);
        const auto contact = touch_triangle(capsule, triangle);
        if (!contact) {
            CHECK(before >= double(capsule.radius) - 1e-4);
            continue;
        }
        ++contacts;
        crossings += before < 2e-3 ? 1 : 0;
        CHECK(double(glm::length(contact->normal)) == near(1).epsilon(1e-4));
        capsule.low += contact->depth * contact->normal;
        capsule.high += contact->depth * contact->normal;
        CHECK(distance_to(triangle, capsule) >= double(capsule.radius) - 2e-3);
    }
    CHECK(contacts > 500);
    CHECK(crossings > 50);
}

TEST_CASE("capsule: triangles without area push from where they are, or not at all") {
    const Capsule ball = {{0, 0.1f, 0}, {0, 0.1f, 0}, 0.3f};
    const TriangleCorners point = {Vec3(0), Vec3(0), Vec3(0)};
    const auto contact = touch_triangle(ball, point);
    REQUIRE(contact.has_value());
    CHECK(contact->normal.y == near(1).epsilon(1e-6));
    CHECK(contact->depth == near(0.2).epsilon(1e-5));
    CHECK_FALSE(touch_triangle({Vec3(0), Vec3(0), 0.3f}, point).has_value());
    const float nan = std::numeric_limits<float>::quiet_NaN();
    CHECK_FALSE(touch_triangle({Vec3(nan), Vec3(nan), 0.3f}, point).has_value());
}

}  // namespace limn::capsule_test
