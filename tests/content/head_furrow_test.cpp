#include "content/make/head/head_furrow_pattern.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cstddef>
#include <cstdint>

namespace limn::head_furrow_test {
namespace {

constexpr int kSize = 192;

PatternMaps made(HeadFurrowMap map) {
    return make_head_furrows({.image = {.size = kSize}, .map = map, .scale = 2, .coarse = 3});
}

/// Texels whose first normal is not flat.
std::size_t count_raised(const ImageData& normal, int first_row, int end_row, std::size_t channel) {
    std::size_t count = 0;
    for (std::size_t i = 4 * static_cast<std::size_t>(first_row * kSize);
         i < 4 * static_cast<std::size_t>(end_row * kSize); i += 4) {
        count += normal.pixels[i + channel] != 128 || normal.pixels[i + channel + 1] != 128 ? 1 : 0;
    }
    return count;
}

TEST_CASE("head furrows: fine ones are everywhere on the head, coarse ones where it folds alone") {
    const PatternMaps fine = made(HeadFurrowMap::Fine);
    const PatternMaps coarse = made(HeadFurrowMap::Compressed);
    // The neck has furrows but no folds.
    const int neck = kSize * 95 / 100;
    CHECK(count_raised(fine.normal, neck, kSize, 0) > 100);
    CHECK(count_raised(coarse.normal, neck, kSize, 0) == 0);
    CHECK(count_raised(coarse.normal, kSize / 5, kSize / 2, 0) > 300);
}

TEST_CASE(
    "head furrows: layers are both coarse maps, the furrows along the folds first"
    * technique("skin.pipeline")) {
    const PatternMaps layers = made(HeadFurrowMap::Layers);
    const PatternMaps compressed = made(HeadFurrowMap::Compressed);
    const PatternMaps stretched = made(HeadFurrowMap::Stretched);
    bool differ = false;
    for (std::size_t i = 0; i < layers.normal.pixels.size(); i += 4) {
        const std::uint8_t* const texel = &layers.normal.pixels[i];
        CHECK_UNARY(texel[0] == compressed.normal.pixels[i]);
        CHECK_UNARY(texel[1] == compressed.normal.pixels[i + 1]);
        CHECK_UNARY(texel[2] == stretched.normal.pixels[i]);
        CHECK_UNARY(texel[3] == stretched.normal.pixels[i + 1]);
        differ = differ || texel[0] != texel[2];
    }
    CHECK(differ);
}

TEST_CASE(
    "head furrows: furrows along the folds of the forehead tilt its normals up and down"
    * technique("skin.pipeline")) {
    const PatternMaps along = made(HeadFurrowMap::Compressed);
    const PatternMaps across = made(HeadFurrowMap::Stretched);
    const auto tilt = [](const ImageData& normal) {  // squares of x and y in the forehead
        Vec2 sum = {0, 0};
        for (int y = kSize * 26 / 100; y < kSize * 31 / 100; ++y) {
            for (int x = kSize * 44 / 100; x < kSize * 56 / 100; ++x) {
                const std::uint8_t* const texel =
                    &normal.pixels[4 * static_cast<std::size_t>(y * kSize + x)];
                const Vec2 n = Vec2(texel[0], texel[1]) - 128.0f;
                sum += n * n;
            }
        }
        return sum;
    };
    const Vec2 horizontal = tilt(along.normal);
    CHECK(horizontal.y > 3 * horizontal.x);
    const Vec2 vertical = tilt(across.normal);
    CHECK(vertical.x > 3 * vertical.y);
}

TEST_CASE("head furrows: no normal is beyond the limit of wrinkle maps, and unit ones have z") {
    const PatternMaps deep = make_head_furrows(
        {.image = {.size = kSize},
         .map = HeadFurrowMap::Compressed,
         .scale = 4,
         .coarse = 8,
         .depth = 4});
    std::size_t limited = 0;
    for (std::size_t i = 0; i < deep.normal.pixels.size(); i += 4) {
        const std::uint8_t* const texel = &deep.normal.pixels[i];
        const Vec3 n = (Vec3(texel[0], texel[1], texel[2]) - 128.0f) / 127.0f;
        CHECK_UNARY(n.x * n.x + n.y * n.y < 0.615f);
        CHECK_UNARY(glm::length(n) > 0.98f);
        limited += n.x * n.x + n.y * n.y > 0.55f ? 1 : 0;
    }
    CHECK(limited > 10);
}

}  // namespace
}  // namespace limn::head_furrow_test
