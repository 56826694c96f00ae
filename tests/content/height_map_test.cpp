#include "content/bake/height_map.h"
#include "content/bake/relief_map.h"
#include "ecs/base/math.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace limn::height_map_test {
namespace {

/// The bytes of a normal in a map.
std::vector<int> bytes_of(const Vec3& normal) {
    BakedMap map = make_baked_map(1, 1, Vec4(encode_normal(normal), 1));
    const std::vector<std::uint8_t> bytes = map_bytes(map, 3);
    return {bytes.begin(), bytes.end()};
}

/// Heights f(u, v), u to the right and v up, of the centers of texels.
template <typename Function>
HeightMap heights_of_function(int width, int height, bool repeats, Function&& f) {
    HeightMap map = {.width = width, .height = height, .repeats = repeats};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            map.heights.push_back(
                f((static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                  1 - (static_cast<float>(y) + 0.5f) / static_cast<float>(height)));
        }
    }
    return map;
}

float angle_between(const Vec3& a, const Vec3& b) {
    return std::asin(std::min(glm::length(glm::cross(a, b)), 1.0f));
}

float wave(float u, float v) {
    return 0.5f + 0.25f * std::sin(2 * kPi * u) + 0.25f * std::cos(4 * kPi * v);
}

}  // namespace

TEST_CASE(
    "height map: slopes have the normals and bytes of the formula"
    * technique("bump.nm-from-height")) {
    CHECK(bytes_of(normal_of_slope(0, 0)) == std::vector<int>{128, 128, 255});
    CHECK(bytes_of(normal_of_slope(1, 0)) == std::vector<int>{37, 128, 218});
    CHECK(bytes_of(normal_of_slope(0.5f, 0)) == std::vector<int>{70, 128, 242});
    CHECK(bytes_of(normal_of_slope(0, -1)) == std::vector<int>{128, 218, 218});
    CHECK(bytes_of(normal_of_slope(1, 1)) == std::vector<int>{54, 54, 201});
}

TEST_CASE(
    "height map: a ramp has one normal everywhere, at its edges, too"
    * technique("bump.nm-from-height")) {
    const HeightMap ramp =
        heights_of_function(16, 8, false, [](float u, float v) { return 0.4f * u + 0.2f * v; });
    // v spans the image's height, half its width.
    const Vec3 expected = normal_of_slope(0.4f * 0.5f, 0.2f * 2 * 0.5f);
    for (const Vec3& n : normals_of(ramp, 0.5f)) {
        CHECK(glm::length(n - expected) < 1e-5f);
    }
}

TEST_CASE(
    "height map: a constant added to all heights changes nothing, the sign of depth x and y"
    * technique("bump.nm-from-height")) {
    HeightMap map = heights_of_function(32, 32, true, wave);
    const std::vector<Vec3> before = normals_of(map, 0.1f);
    const std::vector<Vec3> turned = normals_of(map, -0.1f);
    for (float& h : map.heights) {
        h += 0.25f;
    }
    const std::vector<Vec3> after = normals_of(map, 0.1f);
    for (std::size_t i = 0; i < before.size(); ++i) {
        CHECK(glm::length(before[i] - after[i]) < 1e-5f);
        CHECK(glm::length(turned[i] - before[i] * Vec3(-1, -1, 1)) < 1e-6f);
    }
}

TEST_CASE(
    "height map: normals are within half a degree of those of the surface that was sampled"
    * technique("bump.nm-from-height")) {
    const int size = 128;
    const float depth = 0.1f;
    const HeightMap map = heights_of_function(size, size, true, wave);
    const std::vector<Vec3> normals = normals_of(map, depth);
    float worst = 0;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const float u = (static_cast<float>(x) + 0.5f) / size;
            const float v = 1 - (static_cast<float>(y) + 0.5f) / size;
            const Vec3 expected = normal_of_slope(
                depth * 0.25f * 2 * kPi * std::cos(2 * kPi * u),
                -depth * 0.25f * 4 * kPi * std::sin(4 * kPi * v));
            worst = std::max(
                worst, angle_between(expected, normals[static_cast<std::size_t>(y * size + x)]));
        }
    }
    CHECK(degrees(worst) < 0.5f);
    CHECK(degrees(worst) > 1e-4f);
}

TEST_CASE(
    "height map: a map that repeats bends the normals at the opposite edge"
    * technique("bump.nm-from-height")) {
    HeightMap map = {.width = 8, .height = 8};
    map.heights.assign(64, 0.0f);
    map.heights[3 * 8] = 1;  // at the left edge
    const Vec3 wrapped = normals_of(map, 0.1f)[3 * 8 + 7];
    CHECK(wrapped.x < -0.1f);
    map.repeats = false;
    const Vec3 alone = normals_of(map, 0.1f)[3 * 8 + 7];
    CHECK(alone == Vec3(0, 0, 1));
    // A shift of a map that repeats shifts its normals.
    const HeightMap whole = heights_of_function(16, 16, true, wave);
    HeightMap shifted = whole;
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 16; ++x) {
            shifted.heights[static_cast<std::size_t>(y * 16 + x)] = whole.at(x + 5, y);
        }
    }
    const std::vector<Vec3> a = normals_of(whole, 0.2f);
    const std::vector<Vec3> b = normals_of(shifted, 0.2f);
    CHECK(b[4 * 16 + 14] == a[4 * 16 + 3]);
}

TEST_CASE("height map: heights of 0 and of 1 everywhere are flat, at depth 1 and 0") {
    for (const float height : {0.0f, 1.0f}) {
        HeightMap map = {.width = 4, .height = 3};
        map.heights.assign(12, height);
        for (const Vec4& texel : relief_of(map, 0.05f).texels) {
            CHECK(texel == Vec4(0.5f, 0.5f, 1, 1 - height));
        }
    }
}

TEST_CASE("height map: normalized heights are 0 to 1, constant ones are on the polygon") {
    HeightMap map = {.width = 2, .height = 2, .heights = {-3, 1, 5, 0}};
    CHECK(normalize_heights(map) == Vec2(-3, 5));
    CHECK(map.heights == std::vector<float>{0, 0.5f, 1, 0.375f});
    map.heights.assign(4, 7.0f);
    CHECK(normalize_heights(map) == Vec2(7, 7));
    CHECK(map.heights == std::vector<float>{1, 1, 1, 1});
}

TEST_CASE("height map: one texel is a map") {
    HeightMap map = {.width = 1, .height = 1, .heights = {0.3f}};
    CHECK(normals_of(map, 1)[0] == Vec3(0, 0, 1));
    map.repeats = false;
    CHECK(normals_of(map, 1)[0] == Vec3(0, 0, 1));
}

}  // namespace limn::height_map_test
