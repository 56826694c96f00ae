#include "content/bake/relief_map.h"
#include "content/bake/thin_features.h"
#include "ecs/base/math.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

namespace limn::thin_features_test {
namespace {

/// Fixture F-thin: inside from 0.42 to 0.48, and from 0.85 on.
bool in_thin(float t) {
    return (t >= 0.42f && t < 0.48f) || t >= 0.85f;
}

/// Where a linear search in `steps` steps and a binary search end.
float search(int steps) {
    float t = 1;
    for (int i = 1; i <= steps; ++i) {
        if (in_thin(static_cast<float>(i) / static_cast<float>(steps))) {
            t = static_cast<float>(i) / static_cast<float>(steps);
            break;
        }
    }
    float step = 1 / static_cast<float>(steps);
    for (int i = 0; i < 10; ++i) {
        step *= 0.5f;
        t += in_thin(t) ? -step : step;
    }
    return t;
}

BakedMap make_pyramid(int size, float top) {
    BakedMap map = make_baked_map(size, size);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const float u = (static_cast<float>(x) + 0.5f) / static_cast<float>(size);
            const float v = (static_cast<float>(y) + 0.5f) / static_cast<float>(size);
            map.texels[map.at(x, y)].w = std::max({std::abs(2 * u - 1), std::abs(2 * v - 1), top});
        }
    }
    return map;
}

/// Walls `width` wide that stand a tile apart.
BakedMap make_walls(int size, int width) {
    BakedMap map = make_baked_map(size, size, Vec4(0, 0, 0, 1));
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < width; ++x) {
            map.texels[map.at(x + size / 2, y)].w = 0;
        }
    }
    return map;
}

}  // namespace

TEST_CASE(
    "thin features: 10 steps miss a stretch of 0.06, the recommended ones do not"
    * technique("relief.thin-features")) {
    const float shortest = shortest_stretch(in_thin);
    CHECK(std::abs(shortest - 0.06f) <= 1.0f / 256);
    CHECK(std::abs(search(10) - 0.85f) < 0.005f);
    CHECK(std::abs(search(20) - 0.42f) < 0.002f);
    CHECK(std::abs(search(40) - 0.42f) < 0.002f);
    const int steps = steps_for(shortest);
    CHECK(steps > 10);
    CHECK(std::abs(search(steps) - 0.42f) < 0.002f);
}

TEST_CASE("thin features: steps are within 8 and 256") {
    CHECK(steps_for(1) == 8);
    CHECK(steps_for(0) == 256);
    CHECK(steps_for(0.1f) == 10);
    CHECK(steps_for(0.06f) == 17);
}

TEST_CASE(
    "thin features: a multiple of the steps never ends deeper"
    * technique("relief.thin-features")) {
    for (int steps = 5; steps < 40; ++steps) {
        for (const int times : {2, 3}) {
            const auto first_inside = [](int n) {
                int i = 1;
                while (i < n && !in_thin(static_cast<float>(i) / static_cast<float>(n))) {
                    ++i;
                }
                return static_cast<float>(i) / static_cast<float>(n);
            };
            CHECK(first_inside(times * steps) <= first_inside(steps));
        }
    }
}

TEST_CASE(
    "thin features: a pyramid is thinner toward its apex" * technique("relief.thin-features")) {
    // Along u through the apex, with slope 1 per depth: inside from (1 - 2 u) / 3 to 1 - 2 u.
    float before = 1;
    for (const float u : {0.1f, 0.2f, 0.3f, 0.4f, 0.45f}) {
        const float found =
            shortest_stretch([u](float t) { return std::abs(2 * (u + t) - 1) <= t; });
        CHECK(std::abs(found - (1 - 2 * u) * 2 / 3) < 1.5f / 256);
        CHECK(found < before);
        before = found;
    }
    const ThinFeatures map = find_thin_features(make_pyramid(32, 0), true, 1);
    CHECK(map.shortest < 0.02f);
    CHECK(map.shortest <= map.typical);
    CHECK(map.steps >= 8);
    CHECK(map.steps <= 256);
}

TEST_CASE(
    "thin features: a wall is as thin as it is along the rays"
    * technique("relief.thin-features")) {
    // A ray along u that descends half of the depth over a width of the map.
    ThinFeatureRays rays = {.azimuths = 4, .elevations = 1};
    rays.lowest = std::atan(0.5f);
    for (const int width : {4, 8, 16}) {
        const ThinFeatures found = find_thin_features(make_walls(64, width), true, 1, rays);
        const float expected = 0.5f * static_cast<float>(width) / 64;
        CHECK(std::abs(found.typical - expected) < 2.5f / 256);
    }
}

TEST_CASE("thin features: flat reliefs have none") {
    for (const float depth : {0.0f, 0.5f, 1.0f}) {
        const ThinFeatures found =
            find_thin_features(make_baked_map(8, 8, Vec4(depth)), true, 0.1f);
        CHECK(found.shortest == 1);
        CHECK(found.typical == 1);
        CHECK(found.steps == 8);
    }
}

}  // namespace limn::thin_features_test
