#include "content/make/models/loft.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace limn::loft_test {
namespace {

/// Points all around and within a box.
std::vector<Vec3> grid_points(const Vec3& low, const Vec3& high, int count) {
    std::vector<Vec3> points;
    for (int i = 0; i < count * count * count; ++i) {
        const Vec3 at(
            static_cast<float>(i % count), static_cast<float>((i / count) % count),
            static_cast<float>(i / (count * count)));
        points.push_back(glm::mix(low, high, (at + 0.37f) / static_cast<float>(count)));
    }
    return points;
}

LoftStation round_station(const Vec3& center, float radius) {
    return {center, radius, radius, radius, radius};
}

TEST_CASE("loft: round sections of one radius along a line are a capsule") {
    const Vec3 begin = {0.3f, -1.2f, 0.4f};
    const Vec3 end = {1.1f, 2.5f, -0.6f};
    constexpr float kRadius = 0.7f;
    std::vector<LoftStation> stations;
    for (int i = 0; i < 4; ++i) {
        stations.push_back(round_station(glm::mix(begin, end, static_cast<float>(i) / 3), kRadius));
    }
    const Loft loft = make_loft({.stations = stations, .first_cap = kRadius, .last_cap = kRadius});
    float worst = 0;
    for (const Vec3& p : grid_points(Vec3(-2), Vec3(3), 14)) {
        const Vec3 axis = end - begin;
        const float t = std::clamp(glm::dot(p - begin, axis) / glm::dot(axis, axis), 0.0f, 1.0f);
        const float exact = glm::distance(p, begin + t * axis) - kRadius;
        worst = std::max(worst, std::abs(loft_distance(loft, p) - exact));
    }
    CHECK(worst < 1e-4f);
}

TEST_CASE("loft: radii that grow along a line are a cone, whose distance is that across its axis") {
    constexpr float kSlope = 0.2f;  // of the radius along y
    std::vector<LoftStation> stations;
    for (int i = 0; i <= 6; ++i) {
        const float y = static_cast<float>(i);
        stations.push_back(round_station({0, y, 0}, 0.5f + kSlope * y));
    }
    const Loft loft = make_loft({.stations = stations});
    float worst = 0;
    for (const Vec3& p : grid_points({-3, 1.2f, -3}, {3, 4.8f, 3}, 12)) {
        const float across = std::hypot(p.x, p.z) - (0.5f + kSlope * p.y);
        worst = std::max(worst, std::abs(loft_distance(loft, p) - across));
    }
    CHECK(worst < 1e-4f);
}

/// Distance to the ellipse with these radii, by trying all of its points.
float ellipse_distance(const Vec2& p, const Vec2& radii) {
    float nearest = 1e9f;
    for (int i = 0; i < 4000; ++i) {
        const float angle = 2 * kPi * static_cast<float>(i) / 4000;
        nearest =
            std::min(nearest, glm::distance(p, radii * Vec2(std::cos(angle), std::sin(angle))));
    }
    const Vec2 scaled = p / radii;
    return glm::dot(scaled, scaled) < 1 ? -nearest : nearest;
}

TEST_CASE(
    "loft: a section is four quarters of ellipses, and the distance near it is that to them") {
    // Along y with up = z, right is +x.
    const LoftStation station = {{0, 0, 0}, 1.6f, 0.9f, 1.1f, 0.6f};
    std::vector<LoftStation> stations;
    for (int i = 0; i < 5; ++i) {
        stations.push_back(station);
        stations.back().center.y = static_cast<float>(i);
    }
    const Loft loft = make_loft({.stations = stations});
    float off_surface = 0;
    float off_near = 0;
    for (int i = 0; i < 64; ++i) {
        const float angle = 2 * kPi * (static_cast<float>(i) + 0.5f) / 64;
        const Vec2 direction = {std::cos(angle), std::sin(angle)};
        const Vec2 radii = {
            direction.x > 0 ? station.right : station.left,
            direction.y > 0 ? station.up : station.down};
        const Vec2 on = radii * direction;
        const auto at = [&](const Vec2& q) { return loft_distance(loft, {q.x, 2.1f, q.y}); };
        off_surface = std::max(off_surface, std::abs(at(on)));
        for (const float scale : {0.97f, 1.03f}) {
            const float exact = ellipse_distance(scale * on, radii);
            off_near = std::max(off_near, std::abs(at(scale * on) / exact - 1));
        }
    }
    CHECK(off_surface < 1e-4f);
    CHECK(off_near < 0.05f);
}

TEST_CASE("loft: stations along an arc are part of a torus") {
    constexpr float kRing = 3;
    constexpr float kTube = 0.6f;
    std::vector<LoftStation> stations;
    for (int i = 0; i <= 12; ++i) {
        const float angle = kPi * static_cast<float>(i) / 12;
        stations.push_back(round_station(kRing * Vec3(std::cos(angle), std::sin(angle), 0), kTube));
    }
    const Loft loft = make_loft({.stations = stations});
    float worst = 0;
    for (const Vec3& p : grid_points({-4, 1.2f, -1}, {4, 4, 1}, 16)) {
        const float ring = std::hypot(p.x, p.y) - kRing;
        const float exact = std::hypot(ring, p.z) - kTube;
        if (std::abs(ring) < 1) {
            worst = std::max(worst, std::abs(loft_distance(loft, p) - exact));
        }
    }
    CHECK(worst < 0.01f * kTube);  // chords of an arc, eight between two stations
}

TEST_CASE("loft: far away, the distance to a ball around it is no more than that to itself") {
    std::vector<LoftStation> stations;
    for (int i = 0; i < 3; ++i) {
        stations.push_back(round_station({2.0f * static_cast<float>(i), 0, 0}, 0.5f));
    }
    const Loft loft = make_loft({.stations = stations, .first_cap = 0.5f, .last_cap = 0.5f});
    bool bounded = true;
    float least = 1e9f;
    for (const Vec3& p : grid_points(Vec3(-20), Vec3(24), 12)) {
        const float exact = glm::distance(p, {std::clamp(p.x, 0.0f, 4.0f), 0, 0}) - 0.5f;
        const float distance = loft_distance(loft, p);
        bounded = bounded && distance <= exact + 1e-4f;
        least = std::min(least, exact > 5 ? distance : 1e9f);
    }
    CHECK(bounded);
    CHECK(least > 1);  // no blend reaches as far
}

}  // namespace
}  // namespace limn::loft_test
