#include "content/bake/odd_map.h"
#include "content/make/patterns/relief_patterns.h"
#include "tests/near.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

namespace limn::test::relief_patterns_test {
namespace {

Vec4 texel_at(const ImageData& image, int x, int y) {
    const std::uint8_t* const p =
        &image.pixels[static_cast<std::size_t>(4 * (y * image.width + x))];
    return Vec4(p[0], p[1], p[2], p[3]) / 255.0f;
}

}  // namespace

TEST_CASE(
    "relief patterns: depth reaches from the highest to the lowest, its slope is the normal") {
    // A ramp up to the middle and down again, half a tile deep.
    const PatternMaps maps = make_relief_maps(64, 0.5f, [](const Vec2& uv) {
        PatternTexel t;
        t.height = 1.0f - std::abs(2.0f * uv.x - 1.0f);
        return t;
    });
    REQUIRE(maps.relief.width == 64);
    CHECK(texel_at(maps.relief, 0, 5).w == near(1).epsilon(0.02));
    CHECK(texel_at(maps.relief, 31, 5).w == near(0).scale(1).epsilon(0.02));
    // Up by half a tile in half a tile: 45 degrees.
    const Vec4 rising = texel_at(maps.relief, 16, 5) * 2.0f - 1.0f;
    CHECK(rising.x == near(-std::sqrt(0.5f)).epsilon(0.01));
    CHECK(rising.y == near(0).scale(1).epsilon(0.005));
}

TEST_CASE("relief patterns: solid ones have cones, pierced ones a back and holes") {
    const PatternMaps solid = make_rosettes({.image = {.size = 64}});
    const PatternMaps pierced = make_rosettes({.image = {.size = 64}, .pierced = true});
    int holes = 0;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            CHECK(texel_at(solid.relief, x, y).z <= 0.126f);  // the widest cone
            const Vec4 texel = texel_at(pierced.relief, x, y);
            const bool is_hole = texel.z < texel.w;
            CHECK((is_hole ? texel.z == 0 && texel.w == 1 : texel.z == 1));
            holes += is_hole ? 1 : 0;
        }
    }
    CHECK(holes > 400);
    CHECK(holes < 2000);
}

TEST_CASE("relief patterns: straight down, an ODD map shows the depths of the relief map") {
    const BlocksPattern plain = {.image = {.size = 64}};
    BlocksPattern with_odd = plain;
    with_odd.odd = true;
    const ImageData relief = make_blocks(plain).relief;
    const ImageData odd = make_blocks(with_odd).relief;
    REQUIRE(odd.width == 512);
    REQUIRE(odd.pixels.size() == 512 * 512 * 4);
    double sum = 0;
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
            // Of the four directions about the normal, 8 degrees off.
            const float distance = texel_at(odd, 8 * 32 + x, 8 * 32 + y).w * kOddDistance;
            float depth = 0;
            for (int i = 0; i < 4; ++i) {
                depth += 0.25f * texel_at(relief, 2 * x + i % 2, 2 * y + i / 2).w;
            }
            sum += double(std::abs(distance - depth));
        }
    }
    CHECK(sum / (32 * 32) <= 0.06);  // a byte is 0.03; at joints 8 degrees are a quarter of a cell
}

TEST_CASE(
    "relief patterns: flutes have the normals of a ball without them, and turn about its axis") {
    const PatternMaps ball = make_flutes({.image = {.size = 64}, .flutes = 0});
    const auto normal = [&](int x, int y) {
        return glm::normalize(Vec3(texel_at(ball.normal, x, y)) * 2.0f - 1.0f);
    };
    CHECK(glm::dot(normal(32, 32), Vec3(0, 0, 1)) >= 0.998f);
    CHECK(glm::dot(normal(48, 32), Vec3(1, 0, 0)) >= 0.998f);
    CHECK(glm::dot(normal(0, 32), Vec3(0, 0, -1)) >= 0.998f);
    CHECK(glm::dot(normal(10, 0), Vec3(0, 1, 0)) >= 0.998f);
}

}  // namespace limn::test::relief_patterns_test
