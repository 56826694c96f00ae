#include "content/load/obj/triangulate_polygon.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <set>
#include <vector>

namespace limn::triangulate_polygon_test {

using test::near;

namespace {

/// Twice the area of a polygon, and of its triangles with a sum of absolute values.
float triangle_area(const std::vector<Vec3>& p, const std::vector<std::uint32_t>& triangles) {
    float sum = 0;
    for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
        sum += glm::length(glm::cross(
            p[triangles[i + 1]] - p[triangles[i]], p[triangles[i + 2]] - p[triangles[i]]));
    }
    return 0.5f * sum;
}

/// The area of a polygon in the plane z = 0.
double polygon_area(const std::vector<Vec3>& p) {
    double sum = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec3& a = p[i];
        const Vec3& b = p[(i + 1) % p.size()];
        sum += static_cast<double>(a.x) * static_cast<double>(b.y)
               - static_cast<double>(b.x) * static_cast<double>(a.y);
    }
    return 0.5 * sum;
}

void check_covered_once(const std::vector<Vec3>& polygon) {
    const std::vector<std::uint32_t> triangles = triangulate_polygon(polygon);
    CHECK(triangles.size() == 3 * (polygon.size() - 2));
    CHECK(triangle_area(polygon, triangles) == near(polygon_area(polygon)).epsilon(1e-4));
}

}  // namespace

TEST_CASE("triangulate polygon: a quad is split along the diagonal that lies inside") {
    const std::vector<Vec3> convex = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    CHECK(triangulate_polygon(convex) == std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3});
    const std::vector<Vec3> dart = {{0, 0, 0}, {2, 0, 0}, {0.4f, 0.4f, 0}, {0, 2, 0}};
    CHECK(triangle_area(dart, triangulate_polygon(dart)) == near(0.8));
    const std::vector<Vec3> other = {{2, 0, 0}, {0.4f, 0.4f, 0}, {0, 2, 0}, {0, 0, 0}};
    CHECK(triangle_area(other, triangulate_polygon(other)) == near(0.8));
}

TEST_CASE("triangulate polygon: the triangles of a concave polygon cover its area once") {
    // A comb with three teeth, on a slope.
    std::vector<Vec3> comb;
    for (const Vec2 p : std::vector<Vec2>{
             {0, 0},
             {5, 0},
             {5, 3},
             {4, 3},
             {4, 1},
             {3, 1},
             {3, 3},
             {2, 3},
             {2, 1},
             {1, 1},
             {1, 3},
             {0, 3}}) {
        comb.emplace_back(p.x, 0.6f * p.y, 0.8f * p.y);
    }
    const std::vector<std::uint32_t> triangles = triangulate_polygon(comb);
    CHECK(triangles.size() == 3 * (comb.size() - 2));
    CHECK(triangle_area(comb, triangles) == near(11).epsilon(1e-5));
    CHECK(std::set<std::uint32_t>(triangles.begin(), triangles.end()).size() == comb.size());
}

TEST_CASE("triangulate polygon: a polygon without area, or that crosses itself, still has its "
          "triangles") {
    const std::vector<Vec3> point(7, Vec3(1));
    CHECK(triangulate_polygon(point).size() == 15);
    const std::vector<Vec3> bow = {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
    CHECK(triangulate_polygon(bow).size() == 6);
    CHECK(triangulate_polygon(std::vector<Vec3>(300, Vec3(1))).size() == 3 * 298);
}

TEST_CASE("triangulate polygon: stars and spirals of thousands of corners keep their outline") {
    constexpr std::size_t kCorners = 3000;
    std::vector<Vec3> star;
    std::vector<Vec3> spiral;
    for (std::size_t i = 0; i < kCorners; ++i) {
        const float angle = 2 * kPi * static_cast<float>(i) / kCorners;
        const float radius = 0.2f + std::fmod(0.618034f * static_cast<float>(i), 1.0f);
        star.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
        const bool is_outer = i < kCorners / 2;
        const float turn = 0.02f * static_cast<float>(is_outer ? i : kCorners - 1 - i);
        const float distance = turn + (is_outer ? 2.0f : 1.0f);
        spiral.emplace_back(distance * std::cos(turn), distance * std::sin(turn), 0);
    }
    check_covered_once(star);
    check_covered_once(spiral);
}

TEST_CASE("triangulate polygon: corners on straight edges and a slit to a hole are no obstacle") {
    std::vector<Vec3> square;
    for (int side = 0; side < 4; ++side) {
        const Vec2 from = std::vector<Vec2>{{0, 0}, {9, 0}, {9, 9}, {0, 9}}[side];
        const Vec2 step = std::vector<Vec2>{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}[side];
        for (int i = 0; i < 9; ++i) {
            square.emplace_back(from + static_cast<float>(i) * step, 0);
        }
    }
    check_covered_once(square);
    check_covered_once(
        {{0, 0, 0},
         {4, 0, 0},
         {4, 4, 0},
         {0, 4, 0},
         {0, 0, 0},
         {1, 1, 0},
         {1, 3, 0},
         {3, 3, 0},
         {3, 1, 0},
         {1, 1, 0}});
}

}  // namespace limn::triangulate_polygon_test
