#include "content/bake/relief_map.h"
#include "ecs/base/math.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace limn::relief_map_test {
namespace {

/// What a texture of 8 bits returns.
Vec4 through_bytes(const Vec4& value) {
    const std::vector<std::uint8_t> bytes = map_bytes(make_baked_map(1, 1, value), 4);
    return Vec4(bytes[0], bytes[1], bytes[2], bytes[3]) / 255.0f;
}

/// Unit normals over the hemisphere.
std::vector<Vec3> some_normals() {
    std::vector<Vec3> normals;
    for (int i = 0; i < 20; ++i) {
        for (int j = 0; j < 10; ++j) {
            const float a = 0.314f * static_cast<float>(i);
            const float b = 0.15f * static_cast<float>(j);
            normals.emplace_back(std::cos(a) * std::sin(b), std::sin(a) * std::sin(b), std::cos(b));
        }
    }
    return normals;
}

/// Fixture F-pyramid: depth 0 in the middle and 1 at the border, flat normals.
BakedMap make_pyramid(int size, ReliefLayout layout) {
    BakedMap map = make_baked_map(size, size);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const float u = (static_cast<float>(x) + 0.5f) / static_cast<float>(size);
            const float v = (static_cast<float>(y) + 0.5f) / static_cast<float>(size);
            const float depth = std::max(std::abs(2 * u - 1), std::abs(2 * v - 1));
            map.texels[map.at(x, y)] = encode_relief({.depth = depth, .back = 1}, layout);
        }
    }
    return map;
}

}  // namespace

TEST_CASE(
    "relief map: bytes keep depth within 1/510 and normals within 1/255"
    * technique("relief.map-format")) {
    for (const Vec3& normal : some_normals()) {
        const ReliefTexel texel = {.normal = normal, .depth = 0.5f + 0.49f * normal.x};
        const Vec4 stored = through_bytes(encode_relief(texel, ReliefLayout::Single));
        CHECK(std::abs(stored.w - texel.depth) <= 0.00196f + 1e-6f);
        for (int c = 0; c < 3; ++c) {  // before it is normalized
            CHECK(std::abs(2 * stored[c] - 1 - normal[c]) <= 1.0f / 255 + 1e-6f);
        }
        CHECK(glm::length(decode_relief(stored, ReliefLayout::Single).normal - normal) < 0.014f);
    }
}

TEST_CASE(
    "relief map: z is rebuilt from x and y, and is never negative or NaN"
    * technique("relief.map-format")) {
    for (const ReliefLayout layout : {ReliefLayout::Double, ReliefLayout::Cone}) {
        for (const Vec3& normal : some_normals()) {
            const ReliefTexel exact =
                decode_relief(encode_relief({.normal = normal}, layout), layout);
            CHECK(glm::length(exact.normal - normal) < 2e-3f);
            const ReliefTexel texel =
                decode_relief(through_bytes(encode_relief({.normal = normal}, layout)), layout);
            CHECK(texel.normal.z >= 0);
        }
        const Vec3 outside =
            decode_relief({1, 1, 0, 0}, layout).normal;  // filtered beyond the disc
        CHECK(outside.z >= 0);
        CHECK(std::abs(glm::length(outside) - 1) < 1e-5f);
    }
}

TEST_CASE(
    "relief map: a flat normal is 128, 128, 255; layouts share red, green and alpha"
    * technique("relief.map-format")) {
    const ReliefTexel texel = {.depth = 0.2f, .back = 0.8f, .cone_ratio = 0.4f};
    const std::vector<std::uint8_t> single =
        map_bytes(make_baked_map(1, 1, encode_relief(texel, ReliefLayout::Single)), 4);
    const std::vector<std::uint8_t> twice =
        map_bytes(make_baked_map(1, 1, encode_relief(texel, ReliefLayout::Double)), 4);
    const std::vector<std::uint8_t> cone =
        map_bytes(make_baked_map(1, 1, encode_relief(texel, ReliefLayout::Cone)), 4);
    CHECK(single == std::vector<std::uint8_t>{128, 128, 255, 51});
    CHECK(twice == std::vector<std::uint8_t>{128, 128, 204, 51});
    CHECK(cone == std::vector<std::uint8_t>{128, 128, 102, 51});
}

TEST_CASE("relief map: values out of range and NaN become codes") {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    const BakedMap map = make_baked_map(1, 1, {-1, 2, kNan, 0.5f});
    CHECK(map_bytes(map, 4) == std::vector<std::uint8_t>{0, 255, 0, 128});
    CHECK(map_words(map, 4) == std::vector<std::uint16_t>{0, 65535, 0, 32768});
    CHECK(map_bytes(map, 1) == std::vector<std::uint8_t>{0});
}

TEST_CASE(
    "relief map: normals of a level have unit length, its depth is the mean of four"
    * technique("relief.filter")) {
    BakedMap map = make_baked_map(16, 16);
    const std::vector<Vec3> normals = some_normals();
    for (std::size_t i = 0; i < map.texels.size(); ++i) {
        const float depth = 0.5f + 0.5f * std::sin(static_cast<float>(i * i));
        map.texels[i] = encode_relief(
            {.normal = normals[i % normals.size()], .depth = depth}, ReliefLayout::Single);
    }
    const BakedMap next = next_relief_level(map, ReliefLayout::Single);
    REQUIRE(next.width == 8);
    REQUIRE(next.height == 8);
    for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 8; ++x) {
            float sum = 0;
            for (int k = 0; k < 4; ++k) {
                sum += map.texels[map.at(2 * x + k % 2, 2 * y + k / 2)].w;
            }
            const Vec4 texel = next.texels[next.at(x, y)];
            CHECK(std::abs(texel.w - sum / 4) < 1.0f / 255);
            CHECK(std::abs(glm::length(2.0f * Vec3(texel) - 1.0f) - 1) <= 1.0f / 127);
        }
    }
}

TEST_CASE(
    "relief map: normals at 30 degrees to either side average to the one between"
    * technique("relief.filter")) {
    BakedMap map = make_baked_map(2, 1);
    map.texels[0] = encode_relief({.normal = {0.5f, 0, 0.8660254f}}, ReliefLayout::Single);
    map.texels[1] = encode_relief({.normal = {-0.5f, 0, 0.8660254f}}, ReliefLayout::Single);
    const BakedMap next = next_relief_level(map, ReliefLayout::Single);
    CHECK(glm::length(Vec3(next.texels[0]) - Vec3(0.5f, 0.5f, 1)) < 1e-6f);
}

TEST_CASE("relief map: the last level of the pyramid has depth 2/3" * technique("relief.filter")) {
    for (const ReliefLayout layout : {ReliefLayout::Single, ReliefLayout::Cone}) {
        BakedMap map = make_pyramid(128, layout);
        int levels = 0;
        while (map.width > 1) {
            map = next_relief_level(map, layout);
            ++levels;
        }
        CHECK(levels == 7);
        CHECK(std::abs(map.texels[0].w - 2.0f / 3) < 0.01f);
    }
}

TEST_CASE(
    "relief map: levels of a constant map are equal, of any size" * technique("relief.filter")) {
    const Vec4 value = encode_relief(
        {.normal = {0.6f, 0, 0.8f}, .depth = 0.3f, .back = 0.7f}, ReliefLayout::Double);
    BakedMap map = make_baked_map(13, 6, value);
    while (map.width > 1 || map.height > 1) {
        map = next_relief_level(map, ReliefLayout::Double);
        for (const Vec4& texel : map.texels) {
            CHECK(glm::length(texel - value) < 1e-5f);
        }
    }
}

TEST_CASE(
    "relief map: holes of double depth do not count in a level" * technique("relief.filter")) {
    BakedMap map = make_baked_map(2, 2, encode_relief({}, ReliefLayout::Double));  // holes
    map.texels[0] = encode_relief({.depth = 0.2f, .back = 0.6f}, ReliefLayout::Double);
    map.texels[3] = encode_relief({.depth = 0.4f, .back = 0.8f}, ReliefLayout::Double);
    const ReliefTexel covered =
        decode_relief(next_relief_level(map, ReliefLayout::Double).texels[0], ReliefLayout::Double);
    CHECK(covered.depth == test::near(0.3));
    CHECK(covered.back == test::near(0.7));
    map.texels[0] = map.texels[3] = map.texels[1];
    const Vec4 hole = next_relief_level(map, ReliefLayout::Double).texels[0];
    CHECK(hole.w == 1);
    CHECK(hole.z == 1);
}

TEST_CASE("relief map: a level has the narrowest of four cones" * technique("relief.filter")) {
    BakedMap map = make_baked_map(2, 2);
    for (std::size_t i = 0; i < 4; ++i) {
        map.texels[i] = encode_relief(
            {.depth = 0.5f, .cone_ratio = 0.9f - 0.2f * static_cast<float>(i)}, ReliefLayout::Cone);
    }
    CHECK(next_relief_level(map, ReliefLayout::Cone).texels[0].z == test::near(0.3));
}

}  // namespace limn::relief_map_test
