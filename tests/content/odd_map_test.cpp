#include "content/bake/odd_map.h"
#include "content/bake/relief_map.h"
#include "content/bake/tile_surface.h"
#include "ecs/base/jobs.h"
#include "ecs/base/math.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

namespace limn::odd_map_test {

using test::near;

namespace {

template <typename Height>
TileSurface make_tile(int size, float depth, Height&& height) {
    HeightMap map = {.width = size, .height = size};
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            map.heights.push_back(height(x, y));
        }
    }
    return tile_of(map, depth);
}

BakedMap bake(const TileSurface& tile, OddOrder order = OddOrder::Directions) {
    return bake_odd(tile, TileCaster(tile), order);
}

Vec4 at(const BakedMap& map, const IVec2& position, const IVec2& direction) {
    const IVec2 texel = odd_texel(position, direction, OddOrder::Directions);
    return map.texels[map.at(texel.x, texel.y)];
}

/// Unit directions to the viewer, upwards.
std::vector<Vec3> random_directions(int count) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> place(-1, 1);
    std::vector<Vec3> directions;
    while (directions.size() < static_cast<std::size_t>(count)) {
        const Vec3 v = {place(random), place(random), std::abs(place(random))};
        if (glm::length(v) < 1 && glm::length(v) > 0.1f) {
            directions.push_back(glm::normalize(v));
        }
    }
    return directions;
}

}  // namespace

TEST_CASE("odd: directions have the angles and cells of the formula" * technique("odd.direction")) {
    const auto check = [](const Vec3& direction, const Vec2& angles, const IVec2& cells) {
        const Vec2 found = odd_angles(direction);
        CHECK(std::abs(found.x - angles.x) < 1e-5f);
        CHECK(std::abs(found.y - angles.y) < 1e-5f);
        CHECK(odd_cell(found.x + 1e-6f) == cells.x);
        CHECK(odd_cell(found.y + 1e-6f) == cells.y);
    };
    check({0, 0, 1}, {0.5f, 0.5f}, {8, 8});
    check({0.6f, 0, 0.8f}, {0.295167f, 0.5f}, {4, 8});
    check({0, 0.6f, 0.8f}, {0.5f, 0.295167f}, {8, 4});
    check({0.48f, 0.64f, 0.6f}, {0.285223f, 0.278934f}, {4, 4});
    CHECK(odd_cell(1) == 15);
    CHECK(odd_cell(0) == 0);
}

TEST_CASE(
    "odd: from a direction to angles and back is the same direction" * technique("odd.direction")) {
    for (const Vec3& direction : random_directions(500)) {
        if (std::abs(direction.y) < 0.99f) {
            CHECK(glm::length(odd_direction(odd_angles(direction)) - direction) < 3e-6f);
        }
    }
    for (const float y : {1.0f, -1.0f, 1.0001f}) {  // along the bitangent
        const Vec2 angles = odd_angles({0, y, 0});
        CHECK(angles.x == 0.5f);
        CHECK(angles.y == (y > 0 ? 0.0f : 1.0f));
    }
}

TEST_CASE(
    "odd: 1 - acos(x) / pi is acos(-x) / pi, and cells are 11.25 degrees apart"
    * technique("odd.direction")) {
    for (const Vec3& direction : random_directions(50)) {
        const Vec2 toward = odd_angles(direction);
        // From the eye to the surface, as shaders have it.
        const float along = std::clamp(-direction.y, -1.0f, 1.0f);
        CHECK(std::abs(1 - std::acos(along) / kPi - toward.y) < 1e-5f);
    }
    const Vec3 a = odd_direction({0.5f, 7.5f / 16});
    const Vec3 b = odd_direction({0.5f, 8.5f / 16});
    CHECK(std::acos(glm::dot(a, b)) * 180 / kPi == near(11.25).epsilon(1e-4));
}

TEST_CASE(
    "odd: a flat surface has its normal everywhere and the distance of the formula"
    * technique("odd.map-format, odd.bake")) {
    const TileSurface tile = make_tile(8, 0.1f, [](int, int) { return 0.0f; });
    const BakedMap map = bake(tile);
    REQUIRE(map.width == 512);
    REQUIRE(map.texels.size() == 262144);
    CHECK(map_bytes(map, 4).size() == 1048576);
    for (int b = 0; b < 16; ++b) {
        for (int a = 0; a < 16; ++a) {
            const float up = std::sin(kPi * (static_cast<float>(a) + 0.5f) / 16)
                             * std::sin(kPi * (static_cast<float>(b) + 0.5f) / 16);
            const float expected = std::min(1 / up / kOddDistance, 1.0f);
            for (const IVec2 position : {IVec2(0, 0), IVec2(13, 31), IVec2(31, 5)}) {
                const Vec4 texel = at(map, position, {a, b});
                CHECK(glm::length(Vec3(texel) - Vec3(0.5f, 0.5f, 1)) < 1e-6f);
                CHECK(std::abs(texel.w - expected) < 2e-5f);
            }
        }
    }
    CHECK(at(map, {3, 3}, {7, 8}).w * kOddDistance == near(1.009701).epsilon(1e-5));
    CHECK(at(map, {3, 3}, {8, 7}).w * kOddDistance == near(1.009701).epsilon(1e-5));
    CHECK(at(map, {3, 3}, {0, 0}).w == 1);  // 104 depths
}

TEST_CASE("odd: geometry a tile further gives the same map" * technique("odd.bake")) {
    const auto height = [](int x, int y) {
        return 0.5f + 0.5f * std::sin(2 * kPi * static_cast<float>(x + 2 * y) / 16);
    };
    const TileSurface tile = make_tile(16, 0.1f, height);
    TileSurface moved = tile;
    for (Vec3& p : moved.positions) {
        p.x += 1;
        p.y -= 1;
    }
    moved.low += Vec2(1, -1);
    const BakedMap a = bake(tile);
    const BakedMap b = bake(moved);
    std::size_t different = 0;
    for (std::size_t i = 0; i < a.texels.size(); ++i) {
        different += glm::length(a.texels[i] - b.texels[i]) > 2e-3f ? 1 : 0;
    }
    CHECK(different < a.texels.size() / 1000);  // rounding at edges of triangles
}

TEST_CASE(
    "odd: each texel is what a march over the heights finds"
    * technique("odd.bake, odd.map-format")) {
    const float depth = 0.15f;
    const TileSurface tile = make_tile(32, depth, [](int x, int y) {
        return 0.5f + 0.3f * std::sin(2 * kPi * static_cast<float>(x) / 32)
               + 0.2f * std::cos(2 * kPi * static_cast<float>(2 * y) / 32);
    });
    const BakedMap map = bake(tile);
    const auto surface = [&](double x, double y) {
        const double row = (1 - y) * 32 - 0.5;
        const double column = x * 32 - 0.5;
        const double height = 0.5 + 0.3 * std::sin(2 * 3.14159265358979 * column / 32)
                              + 0.2 * std::cos(4 * 3.14159265358979 * row / 32);
        return depth * (height - 1);
    };
    std::mt19937 random(4);
    std::uniform_int_distribution<int> position(0, 31);
    std::uniform_int_distribution<int> direction(2, 13);
    for (int i = 0; i < 300; ++i) {
        const IVec2 p = {position(random), position(random)};
        const IVec2 d = {direction(random), direction(random)};
        const Vec3 to_viewer = odd_direction((Vec2(d) + 0.5f) / 16.0f);
        const double x = (p.x + 0.5) / 32;
        const double y = 1 - (p.y + 0.5) / 32;
        double t = 0;
        while (t < 8 * depth
               && -t * to_viewer.z > surface(x - t * to_viewer.x, y - t * to_viewer.y)) {
            t += 1e-4;
        }
        CHECK(std::abs(at(map, p, d).w * 8 * depth - t) < 0.01);
    }
}

TEST_CASE("odd: both orders hold the same texels" * technique("odd.order")) {
    const TileSurface tile =
        make_tile(16, 0.1f, [](int x, int y) { return (x / 4 + y / 4) % 2 == 0 ? 1.0f : 0.0f; });
    const BakedMap directions = bake(tile, OddOrder::Directions);
    const BakedMap positions = bake(tile, OddOrder::Positions);
    CHECK(odd_reordered(directions, OddOrder::Directions).texels == positions.texels);
    CHECK(odd_reordered(positions, OddOrder::Positions).texels == directions.texels);
    CHECK(positions.texels != directions.texels);
}

TEST_CASE("odd: texture coordinates of the packed map" * technique("odd.order")) {
    CHECK(odd_coordinates({0.5f, 0}, {0.5f, 0}, OddOrder::Positions).x == near(0.515625));
    CHECK(odd_coordinates({0.25f, 0}, {0.5f, 0}, OddOrder::Directions).x == near(0.515625));
    // At the centers of cells they are those of the texels; beyond 0 .. 1 positions repeat.
    for (const OddOrder order : {OddOrder::Directions, OddOrder::Positions}) {
        for (int i = 0; i < 16; ++i) {
            const IVec2 position = {2 * i + 1, 31 - i};
            const IVec2 direction = {i, 15 - i};
            const Vec2 uv = odd_coordinates(
                (Vec2(position) + 0.5f) / 32.0f, (Vec2(direction) + 0.5f) / 16.0f, order);
            CHECK(IVec2(uv * 512.0f) == odd_texel(position, direction, order));
        }
    }
    CHECK(
        odd_coordinates({-0.75f, 2.25f}, {0.5f, 0.5f}, OddOrder::Directions)
        == odd_coordinates({0.25f, 0.25f}, {0.5f, 0.5f}, OddOrder::Directions));
}

TEST_CASE(
    "odd: from straight above, a block is an image of the tile with its normals"
    * technique("odd.order, odd.map-format")) {
    // A pyramid: four sides, one normal each.
    const TileSurface tile = make_tile(64, 0.2f, [](int x, int y) {
        const float u = std::abs(static_cast<float>(x) - 31.5f) / 32;
        const float v = std::abs(static_cast<float>(y) - 31.5f) / 32;
        return 1 - std::max(u, v);
    });
    const BakedMap map = bake(tile);
    const auto normal = [&](int x, int y) { return decode_normal(Vec3(at(map, {x, y}, {8, 8}))); };
    const float slope = 0.2f / 0.5f;
    const float length = std::sqrt(1 + slope * slope);
    CHECK(glm::length(normal(28, 16) - Vec3(slope, 0, 1) / length) < 0.02f);
    CHECK(glm::length(normal(4, 16) - Vec3(-slope, 0, 1) / length) < 0.02f);
    CHECK(glm::length(normal(16, 4) - Vec3(0, slope, 1) / length) < 0.02f);
    CHECK(glm::length(normal(16, 28) - Vec3(0, -slope, 1) / length) < 0.02f);
}

TEST_CASE("odd: the index map replaces acos" * technique("odd.index-map")) {
    const BakedMap exact = make_odd_index_map(256);
    BakedMap stored = exact;  // as a texture of bytes holds it
    const std::vector<std::uint8_t> bytes = map_bytes(exact, 4);
    for (std::size_t i = 0; i < stored.texels.size(); ++i) {
        stored.texels[i] =
            Vec4(bytes[4 * i], bytes[4 * i + 1], bytes[4 * i + 2], bytes[4 * i + 3]) / 255.0f;
        CHECK((exact.texels[i].z >= 0 && exact.texels[i].z <= 0.785f));
        CHECK((exact.texels[i].w >= 0 && exact.texels[i].w <= 0.785f));
        const Vec2 by_hand = {
            exact.texels[i].x + 0.005f * exact.texels[i].z,
            exact.texels[i].y + 0.005f * exact.texels[i].w};
        CHECK(glm::length(by_hand - decode_odd_index(exact.texels[i])) < 1e-6f);
        const Vec2 difference =
            decode_odd_index(stored.texels[i]) - decode_odd_index(exact.texels[i]);
        CHECK(std::max(std::abs(difference.x), std::abs(difference.y)) <= 2.1e-5f);
    }
    for (const Vec3& direction : random_directions(2000)) {
        if (std::abs(direction.y) > 0.8f) {
            continue;  // toward the bitangent, a turns by more than a cell within a texel
        }
        const IVec2 texel = glm::min(IVec2((Vec2(direction) * 0.5f + 0.5f) * 256.0f), IVec2(255));
        const Vec2 found = decode_odd_index(stored.texels[stored.at(texel.x, texel.y)]);
        const Vec2 expected = odd_angles(direction);
        CHECK(std::abs(odd_cell(found.x) - odd_cell(expected.x)) <= 1);
        CHECK(std::abs(odd_cell(found.y) - odd_cell(expected.y)) <= 1);
    }
}

TEST_CASE("odd: the number of threads changes nothing") {
    const TileSurface tile = make_tile(
        12, 0.1f, [](int x, int y) { return static_cast<float>((3 * x + 5 * y) % 7) / 7; });
    const int before = thread_count();
    set_thread_count(1);
    const BakedMap one = bake(tile);
    set_thread_count(4);
    const BakedMap four = bake(tile);
    set_thread_count(before);
    CHECK(one.texels == four.texels);
}

}  // namespace limn::odd_map_test
