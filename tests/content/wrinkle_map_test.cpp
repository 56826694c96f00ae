#include "content/bake/wrinkle_map.h"
#include "content/make/patterns/fold_pattern.h"
#include "systems/faces/wrinkle_fold.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace limn::wrinkle_map_test {

using limn::test::near;

namespace {

Vec2 slope_of(const ImageData& map, std::size_t i) {
    return Vec2(map.pixels[4 * i] - 128, map.pixels[4 * i + 1] - 128) / 127.0f;
}

float steepest(const ImageData& map) {
    float most = 0;
    for (std::size_t i = 0; i < map.pixels.size() / 4; ++i) {
        most = std::max(most, glm::dot(slope_of(map, i), slope_of(map, i)));
    }
    return most;
}

}  // namespace

TEST_CASE(
    "wrinkle map: normals beyond 0.6 come back to it, in their direction, and are counted"
    * technique("wrinkle.compression.map")) {
    ImageData map = {.name = "map", .width = 256, .height = 1, .pixels = {}};
    int expected = 0;
    for (int i = 0; i < 256; ++i) {
        const float angle = 0.31f * static_cast<float>(i);
        const float radius = static_cast<float>(i) / 256;
        const Vec2 xy = 127 * radius * Vec2(std::cos(angle), std::sin(angle));
        map.pixels.insert(
            map.pixels.end(), {static_cast<std::uint8_t>(128 + std::lround(xy.x)),
                               static_cast<std::uint8_t>(128 + std::lround(xy.y)), 200, 77});
        const Vec2 stored = slope_of(map, static_cast<std::size_t>(i));
        expected += glm::dot(stored, stored) > 0.6f ? 1 : 0;
    }
    REQUIRE(expected > 40);
    const ImageData before = map;
    CHECK(limit_wrinkle_map(map) == expected);
    for (std::size_t i = 0; i < 256; ++i) {
        const Vec2 now = slope_of(map, i);
        const Vec2 was = slope_of(before, i);
        CHECK(glm::dot(now, now) <= 0.6f);
        CHECK(map.pixels[4 * i + 3] == 77);
        if (glm::dot(was, was) <= 0.6f) {
            CHECK(now == was);
        } else {
            CHECK(glm::length(now) == near(0.774597).epsilon(0.02));
            CHECK(glm::dot(glm::normalize(now), glm::normalize(was)) > 0.9998f);
        }
    }
    CHECK(limit_wrinkle_map(map) == 0);
}

TEST_CASE(
    "wrinkle map: folds can be made as flat as the fit to the sphere needs them"
    * technique("wrinkle.compression.map")) {
    const FoldsPattern steep = {.image = {.size = 64}, .count = 4, .depth = 1};
    CHECK(steepest(make_folds(steep).normal) > 0.7f);
    FoldsPattern limited = steep;
    limited.steepest = 0.6f;
    CHECK(steepest(make_folds(limited).normal) <= 0.6f);
}

TEST_CASE("wrinkle map: slopes of a hundredth of a step of 8 bits keep their mean, flat is exact") {
    constexpr int kSize = 64;
    ImageData map;
    map.width = kSize;
    map.height = kSize;
    map.format = PixelFormat::Rgba8;
    map.pixels.resize(std::size_t{4} * kSize * kSize);
    std::vector<float> heights;
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {  // flat, up, down
            heights.push_back(y < 16 ? 0.0f : 0.0021f * static_cast<float>(x < 32 ? x : 64 - x));
        }
    }
    write_wrinkle_map(map, heights);
    const std::vector<Vec2> slopes = wrinkle_slopes(map);
    Vec2 up = {0, 0};
    Vec2 down = {0, 0};
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const Vec2 slope = slopes[static_cast<std::size_t>(y * kSize + x)];
            if (y > 0 && y < 15) {
                CHECK(slope == Vec2(0));
            } else if (y >= 18 && y < 62) {
                (x < 32 ? up : down) += slope / (44.0f * 32.0f);
            }
        }
    }
    CHECK(up.x == near(0.0021).epsilon(0.1));
    CHECK(down.x == near(-0.0021).epsilon(0.1));
}

}  // namespace limn::wrinkle_map_test
