#include "ecs/base/math.h"
#include "render/shaders/relief_search_gpu.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <utility>

// Source of the fixtures: the spec of relief mapping, "Test fixtures used by the entries".

namespace limn::test::relief_search_test {
namespace {

using layout::kReliefMiss;
using layout::relief_depth_at;
using layout::relief_light_ray;
using layout::relief_range;
using layout::relief_search;
using layout::relief_search_cones;
using layout::relief_search_linear;
using layout::relief_uv_at;
using layout::relief_visibility;
using layout::relief_way_out;
using layout::ReliefRay;

constexpr int kSteps = 10;
constexpr int kRefinements = 6;
constexpr float kLastInterval = 1.0f / 640;

/// A straight ray that travels one tile along u from the mesh to the bottom.
constexpr ReliefRay kAcross = {{0, 0}, {1, 0}, 1, 0};

/// F-const(depth).
auto flat(float depth) {
    return [depth](const Vec2&) { return Vec4(0, 0, 1, depth); };
}

/// Inside where t, the distance along kAcross, is in one of two intervals.
auto profile(float begin, float end, float second) {
    return [=](const Vec2& uv) {
        const bool inside = (uv.x >= begin && uv.x < end) || uv.x >= second;
        return Vec4(0, 0, 1, inside ? 0.0f : 2.0f);
    };
}

/// F-pyramid: depth 0 at the center of each tile, 1 at its border.
Vec4 pyramid(const Vec2& uv) {
    const Vec2 tile = glm::abs(2.0f * (uv - glm::floor(uv)) - 1.0f);
    return {0, 0, 0.5f, std::max(tile.x, tile.y)};
}

float search(const ReliefRay& ray, float depth) {
    return relief_search(ray, kSteps, kRefinements, false, flat(depth));
}

/// A ray in a relief of `depth` over a mesh of curvature `a` along it, with unit scales.
struct CurvedRay {
    ReliefRay ray;
    float range;
    bool at_bottom;
};
CurvedRay curved_ray(const Vec2& v, float a, float depth) {
    const float fall = a * v.x * v.x;
    const Vec2 range = relief_range(v.y, fall, depth);
    return {
        {{0, 0}, {v.x * range.x, 0}, v.y * range.x / depth, fall * range.x * range.x / depth},
        range.x,
        range.y > 0};
}

}  // namespace

TEST_CASE(
    "relief search: a hit is at or behind a flat bottom, by at most the last interval"
    * technique("relief.search, relief.inverse-map")) {
    for (int i = 1; i <= 100; ++i) {
        const float depth = static_cast<float>(i) / 100;
        const float error = search(kAcross, depth) - depth;
        CAPTURE(depth);
        CHECK(error >= 0);
        CHECK(error <= kLastInterval + 1e-6f);
    }
    CHECK(search(kAcross, 0.25f) == 0.25f);
    CHECK(search(kAcross, 1.0f) == 1.0f);
    CHECK(search(kAcross, 0.0f) <= kLastInterval);
}

TEST_CASE(
    "relief search: the first of three crossings is found, which bisection alone misses"
    * technique("relief.search")) {
    const auto three = profile(0.22f, 0.35f, 0.8f);
    const float first = relief_search(kAcross, kSteps, kRefinements, false, three);
    CHECK(first >= 0.22f);
    CHECK(first <= 0.22f + kLastInterval);
    CHECK(relief_search(kAcross, 1, 10, false, three) == near(0.8).epsilon(0.002));
}

TEST_CASE(
    "relief search: a face of a pyramid is hit where the ray meets it"
    * technique("relief.search")) {
    const ReliefRay ray = {{0, 0.5f}, {0.5f, 0}, 1, 0};
    const float x = relief_search(ray, kSteps, kRefinements, false, pyramid);
    CHECK(x == near(0.5).epsilon(kLastInterval));
}

TEST_CASE(
    "relief search: thin features need steps shorter than their thickness"
    * technique("relief.thin-features")) {
    const auto thin = profile(0.42f, 0.48f, 0.85f);
    CHECK(relief_search(kAcross, 10, kRefinements, false, thin) >= 0.85f);
    for (const int steps : {20, 40}) {
        const float x = relief_search(kAcross, steps, kRefinements, false, thin);
        CHECK(x >= 0.42f);
        CHECK(x < 0.4216f);
    }
}

TEST_CASE(
    "relief search: more steps by a whole factor never move the first hit deeper"
    * technique("relief.thin-features")) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int i = 0; i < 200; ++i) {
        const float begin = unit(random);
        const auto map = profile(begin, begin + 0.2f * unit(random), 0.95f);
        const float coarse = relief_search(kAcross, 8, 0, false, map);
        CHECK(relief_search(kAcross, 24, 0, false, map) <= coarse);
    }
}

TEST_CASE(
    "relief search: the linear search stops at the first sample inside"
    * technique("relief.early-out")) {
    int samples = 0;
    const auto counted = [&](const Vec2&) {
        ++samples;
        return Vec4(0, 0, 1, 0.25f);
    };
    CHECK(relief_search(kAcross, kSteps, 0, false, counted) == near(0.3));
    CHECK(samples == 3);
}

TEST_CASE(
    "relief search: a closed relief is inside between its front and its back"
    * technique("relief.double-depth, relief.cap")) {
    const auto slab = [](float front, float back) {
        return [=](const Vec2&) { return Vec4(0, 0, back, front); };
    };
    const auto hit = [&](float front, float back) {
        return relief_search(kAcross, kSteps, kRefinements, true, slab(front, back));
    };
    CHECK(hit(0.4f, 0.6f) == near(0.4).epsilon(0.005));
    CHECK(hit(0.45f, 0.55f) == near(0.45).epsilon(0.005));
    CHECK(hit(0.42f, 0.48f) == kReliefMiss);  // thinner than a step, between two samples
    CHECK(hit(1, 0) == kReliefMiss);          // an empty texel
    for (const float depth : {0.1f, 0.37f, 0.9f}) {
        CHECK(hit(depth, 1) == search(kAcross, depth));
    }
    // A ray that stays below the back surface passes behind.
    const ReliefRay below = {{0, 0}, {1, 0}, 0.2f, 0};
    const auto shifted = [](const Vec2&) { return Vec4(0, 0, -0.1f, -0.3f); };
    CHECK(relief_search(below, kSteps, kRefinements, true, shifted) == kReliefMiss);
}

TEST_CASE(
    "relief search: a secant is exact on planes, level or tilted" * technique("relief.search")) {
    CHECK(relief_search_linear(kAcross, kSteps, flat(0.77f)) == near(0.77));
    const ReliefRay ray = {{0, 0.5f}, {0.5f, 0}, 1, 0};
    CHECK(relief_search_linear(ray, kSteps, pyramid) == near(0.5));
    CHECK(relief_search_linear(kAcross, kSteps, flat(0.0f)) == near(0).scale(1));
}

TEST_CASE(
    "relief search: cones find what twenty thousand steps find" * technique("relief.search")) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int i = 0; i < 300; ++i) {
        const ReliefRay ray = {
            {unit(random), unit(random)}, {3 * unit(random) - 1.5f, 3 * unit(random) - 1.5f}, 1, 0};
        const float expected = relief_search(ray, 20000, 4, false, pyramid);
        const float found = relief_search_cones(ray, 300, 8, pyramid);
        CHECK(found == near(expected).scale(1).epsilon(0.003));
    }
}

TEST_CASE(
    "relief range: rays end on the bottom or leave through the mesh"
    * technique("relief.ray-range")) {
    const auto check = [](float down, float fall, float depth, float length, bool at_bottom) {
        const Vec2 range = relief_range(down, fall, depth);
        CAPTURE(fall);
        CAPTURE(depth);
        CHECK(range.x == near(length).epsilon(1e-5));
        CHECK((range.y > 0) == at_bottom);
        const float end = range.x * (down - fall * range.x);
        CHECK(end == near(at_bottom ? depth : 0).scale(1).epsilon(2e-6));
    };
    check(0.6f, 0.32f, 0.1f, 0.184900f, true);
    check(0.6f, 0.32f, 1, 1.875f, false);
    check(0.6f, -0.32f, 0.1f, 0.154016f, true);
    check(0.1f, 0.495f, 0.1f, 0.202020f, false);
    check(0.1f, 0.495f, 0.004f, 0.0549424f, true);
    check(0.5f, 0, 0.1f, 0.2f, true);  // a plane
}

TEST_CASE(
    "relief ray: a parabola in the space of the mesh, whose peak and end are known"
    * technique("relief.ray-curved")) {
    const float down = 0.3f;
    const float fall = 0.4f;
    const ReliefRay ray = {{0, 0}, {1, 0}, down, fall};  // depth 1, x in meters
    CHECK(relief_depth_at(ray, 0) == 0);
    CHECK(relief_depth_at(ray, down / (2 * fall)) == near(down * down / (4 * fall)));
    CHECK(relief_depth_at(ray, down / fall) == near(0).scale(1));
    const ReliefRay straight = {{0, 0}, {1, 0}, down, 0};
    CHECK(relief_depth_at(straight, 0.7f) == near(0.21));
    // Within a circle of radius R: it leaves at 2 R v / (1 - v^2), the chord at 2 R v.
    for (const float v : {0.3f, 0.1f, 0.03f}) {
        const float along = 1 - v * v;
        const Vec2 range = relief_range(v, 0.5f * along, 10);
        CHECK(range.x == near(2 * v / along));
        CHECK(range.x / (2 * v) - 1 == near(v * v / along).epsilon(1e-3));
    }
}

TEST_CASE(
    "relief on a curve: hits of convex and concave meshes are where the parabola is that deep"
    * technique("relief.silhouette")) {
    const Vec2 v = {0.8f, 0.6f};
    const auto hit = [&](float a, float depth) {
        const CurvedRay curved = curved_ray(v, a, 0.1f);
        REQUIRE(curved.at_bottom);
        return curved.range * search(curved.ray, depth);
    };
    const float step = 0.19f * kLastInterval;
    CHECK(hit(0.5f, 0.5f) == near(0.0874081).scale(1).epsilon(step));
    CHECK(hit(-0.5f, 0.5f) == near(0.0799263).scale(1).epsilon(step));
    CHECK(hit(1e-6f, 0.5f) == near(0.083333).scale(1).epsilon(step));
    // The bottom is never a hole.
    CHECK(hit(0.5f, 1) <= curved_ray(v, 0.5f, 0.1f).range);
}

TEST_CASE(
    "relief on a curve: rays that stay above the surface leave through the mesh"
    * technique("relief.silhouette")) {
    const Vec2 v = {std::sqrt(0.99f), 0.1f};
    const CurvedRay curved = curved_ray(v, 0.5f, 0.1f);
    REQUIRE_FALSE(curved.at_bottom);
    CHECK(search(curved.ray, 0.06f) == kReliefMiss);  // its peak is at 0.0505 of the depth
    const float length = curved.range * search(curved.ray, 0.04f);
    CHECK(length >= 0.0549424f);
    CHECK(length <= 0.0549424f + curved.range * kLastInterval);
}

TEST_CASE(
    "relief on a curve: the depth below a quadric is nearly that below the sphere it fits"
    * technique("relief.ray-quadric")) {
    // On a sphere of radius 1, A = B = 0.5.
    const auto check = [](float down, float t, float quadric, float sphere) {
        const ReliefRay ray = {{0, 0}, {1, 0}, down, 0.5f * (1 - down * down)};
        CHECK(relief_depth_at(ray, t) == near(quadric));
        const float across = t * std::sqrt(1 - down * down);
        const float true_depth = 1 - std::hypot(across, 1 - t * down);
        CHECK(true_depth == near(sphere).epsilon(2e-5));
        CHECK(relief_depth_at(ray, t) == near(true_depth).epsilon(0.006));
    };
    check(0.3f, 0.1f, 0.025450f, 0.025321f);
    check(0.1f, 0.05f, 0.0037625f, 0.0037571f);
    check(0.9f, 0.1f, 0.089050f, 0.088957f);
}

TEST_CASE(
    "relief on a sphere: its outline is that of the formula" * technique("relief.silhouette")) {
    // Discarded where v_z^2 < (2 h / R) / (1 + 2 h / R): the radius of the outline is R / sqrt(1 +
    // 2 h / R).
    for (const auto& [height, outline] :
         {std::pair(0.05f, 0.953463f), std::pair(0.1f, 0.912871f), std::pair(0.2f, 0.845154f)}) {
        float largest = 0;
        for (int i = 0; i < 10000; ++i) {
            const float radius = (static_cast<float>(i) + 0.5f) / 10000;
            const float down = std::sqrt(1 - radius * radius);
            const Vec2 range = relief_range(down, 0.5f * radius * radius, height);
            largest = range.y > 0 ? std::max(largest, radius) : largest;
        }
        CHECK(largest == near(outline).epsilon(2e-4));
    }
}

TEST_CASE(
    "relief search: random reliefs are hit where double precision finds the first crossing"
    * technique("relief.ray-service")) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int i = 0; i < 200; ++i) {
        const double phase = 6.28 * double(unit(random));
        const double waves = 1 + 3 * double(unit(random));
        const auto depth_of = [=](double u) {
            return 0.5 + 0.45 * std::sin(6.28318530718 * waves * u + phase);
        };
        const auto map = [&](const Vec2& uv) {
            return Vec4(0, 0, 1, static_cast<float>(depth_of(double(uv.x))));
        };
        double expected = 1;
        for (int k = 1; k <= 20000 && expected == 1; ++k) {
            const double x = k / 20000.0;
            expected = depth_of(x) <= x ? x : 1;
        }
        const float found = relief_search(kAcross, 256, 8, false, map);
        CHECK(found == near(expected).scale(1).epsilon(1e-4));
    }
}

/// From a point of a flat mesh's relief, whose depth is 1 m, toward light that travels `k` tiles
/// along u per meter of depth.
ReliefRay light_ray(const Vec2& uv, float depth, float k) {
    return relief_light_ray(uv, {-k * depth, 0}, 1, 0, relief_way_out(1, 0, depth), 1);
}

TEST_CASE(
    "relief self-shadow: the ray from the light enters at the mesh and ends at the point"
    * technique("relief.self-shadow, relief.tangent-shadow")) {
    const ReliefRay ray = light_ray({0.25f, 0.5f}, 0.5f, -1);
    CHECK(relief_uv_at(ray, 0).x == 0.75f);
    CHECK(relief_uv_at(ray, 1).x == 0.25f);
    for (const float fall : {-0.4f, 0.0f, 0.7f}) {
        const float depth = 0.13f;
        const float relief = 0.2f;
        const float up = 0.6f;
        const float length = relief_way_out(up, fall, depth);
        // Above the mesh, whose quadric falls away: the height gained is the depth of the point.
        CHECK(up * length + fall * length * length == near(depth));
        const ReliefRay curved = relief_light_ray({0, 0}, {0.1f, 0}, up, fall, length, relief);
        CAPTURE(fall);
        CHECK(relief_depth_at(curved, 0) == 0);
        CHECK(relief_depth_at(curved, 1) == near(depth / relief));
        const float half = 0.5f * length;
        CHECK(
            relief_depth_at(curved, 0.5f)
            == near((depth - up * half - fall * half * half) / relief));
    }
}

TEST_CASE(
    "relief self-shadow: a pyramid shades its far face from light flatter than its face"
    * technique("relief.self-shadow, relief.tangent-shadow")) {
    const auto visible = [](float k) {
        return relief_visibility(light_ray({0.25f, 0.5f}, 0.5f, k), 0.5f, 24, false, pyramid);
    };
    for (const float k : {-1.0f, -0.75f, -0.6f}) {
        CAPTURE(k);
        CHECK(visible(k) == 0);
    }
    for (const float k : {-0.5f, -0.4f, 0.0f, 1.0f}) {
        CAPTURE(k);
        CHECK(visible(k) == 1);
    }
}

TEST_CASE(
    "relief self-shadow: none on a flat relief, and none from a lamp at the eye"
    * technique("relief.self-shadow, relief.tangent-shadow")) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int i = 0; i < 300; ++i) {
        const float depth = unit(random);
        const float k = 8 * unit(random) - 4;
        // As deep as the search of ten steps finds it.
        const float found = std::min(depth + unit(random) * kLastInterval, 1.0f);
        CAPTURE(depth);
        CHECK(
            relief_visibility(light_ray({0, 0}, found, k), found, 1 + i % 64, false, flat(depth))
            == 1);
        const float phase = 6.28f * unit(random);
        const auto wavy = [=](const Vec2& uv) {
            return Vec4(0, 0, 1, 0.5f + 0.4f * std::sin(12.0f * uv.x + phase));
        };
        const float seen = relief_search(kAcross, 256, 8, false, wavy);
        if (seen <= 1) {
            CHECK(relief_visibility(light_ray({seen, 0}, seen, 1), seen, 256, false, wavy) == 1);
        }
    }
}

TEST_CASE(
    "relief self-shadow: light passes behind the back surface of a closed relief"
    * technique("relief.self-shadow")) {
    // A slab between depths 0.2 and 0.3; the point is at 0.8.
    const auto slab = [](const Vec2&) { return Vec4(0, 0, 0.3f, 0.2f); };
    const ReliefRay ray = light_ray({0, 0}, 0.8f, 0.5f);
    CHECK(relief_visibility(ray, 0.8f, 64, true, slab) == 0);
    const auto thin = [](const Vec2&) { return Vec4(0, 0, 0.2f, 0.2f); };
    CHECK(relief_visibility(ray, 0.8f, 64, true, thin) == 1);
    CHECK(relief_visibility(ray, 0.8f, 64, false, thin) == 0);
}

}  // namespace limn::test::relief_search_test
