#include "content/make/patterns/masonry_patterns.h"
#include "tests/near.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

namespace limn::masonry_patterns_test {
namespace {

int channel(const ImageData& image, int x, int y, int c) {
    return image.pixels[static_cast<std::size_t>(4 * (y * image.width + x) + c)];
}

int brightness(const ImageData& image, int x, int y) {
    return channel(image, x, y, 0) + channel(image, x, y, 1) + channel(image, x, y, 2);
}

}  // namespace

TEST_CASE("masonry_patterns: a rose window is black outside its rim and at its bars") {
    const ImageData rose = make_rose_window({.image = {.size = 256}, .variation = 0}).base_color;
    int lit = 0;
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
            const float radius = glm::length(Vec2(x, y) + 0.5f - 128.0f) / 128.0f;
            if (radius > 0.97f) {
                REQUIRE(brightness(rose, x, y) == 0);
            }
            lit += brightness(rose, x, y) > 60 ? 1 : 0;
        }
    }
    CHECK(lit > 256 * 256 * 0.4);  // but most of it is glass
    CHECK(lit < 256 * 256 * 0.7);
}

TEST_CASE("masonry_patterns: a rose window without variation has the symmetry of its petals") {
    const ImageData rose =
        make_rose_window({.image = {.size = 192}, .petals = 8, .variation = 0}).base_color;
    for (int y = 0; y < 192; ++y) {
        for (int x = 0; x < 192; ++x) {
            for (int c = 0; c < 3; ++c) {
                const int here = channel(rose, x, y, c);
                CHECK(std::abs(here - channel(rose, 191 - x, y, c)) <= 2);
                CHECK(std::abs(here - channel(rose, 191 - y, x, c)) <= 2);  // a quarter turn
            }
        }
    }
}

TEST_CASE("masonry_patterns: the first petal points up, in the color of the field") {
    RoseWindowPattern pattern{.image = {.size = 256}, .variation = 0};
    pattern.field = {0, 0, 1};
    pattern.border = pattern.accent = pattern.spandrel = {1, 0, 0};
    const ImageData rose = make_rose_window(pattern).base_color;
    int blue = 0;
    for (int y = 30; y < 100; ++y) {
        blue += channel(rose, 130, y, 2) > 200 ? 1 : 0;
    }
    CHECK(blue > 5);
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
            REQUIRE((channel(rose, x, y, 0) < 10 || channel(rose, x, y, 2) < 10));
        }
    }
}

TEST_CASE("masonry_patterns: courses of ashlar are level, and their joints cover the requested "
          "fraction") {
    const AshlarPattern pattern{
        .image = {.size = 256},
        .rows = 4,
        .aspect = 2,
        .irregular = 0,
        .joint = 0.2f,
        .variation = 0,
        .color = {1, 1, 1},
        .joint_color = {0, 0, 0}};
    const ImageData wall = make_ashlar(pattern).base_color;
    int joints = 0;
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
            joints += channel(wall, x, y, 0) < 100 ? 1 : 0;
        }
    }
    // 0.2 of the height, and 0.2 / 2 of the length of what is left of it; edges are ragged.
    CHECK(joints / 65536.0 == test::near(1 - 0.8 * 0.9).epsilon(0.15));
    for (int row = 0; row < 4; ++row) {
        int dark = 0;
        for (int x = 0; x < 256; ++x) {
            dark += channel(wall, x, 64 * row, 0) < 100 ? 1 : 0;
        }
        CHECK(dark > 250);
    }
}

TEST_CASE("masonry_patterns: wear polishes ashlar where feet go") {
    const auto mean_roughness = [](float wear) {
        const ImageData orm = make_ashlar({.image = {.size = 128}, .wear = wear}).orm;
        double sum = 0;
        for (int i = 0; i < 128 * 128; ++i) {
            sum += channel(orm, i % 128, i / 128, 1) / 255.0 / (128 * 128);
        }
        return sum;
    };
    CHECK(mean_roughness(0) > 0.8);
    CHECK(mean_roughness(1) < 0.6);
}

TEST_CASE(
    "masonry_patterns: glass is colored between black lead, one pane in six in the accent color") {
    StainedGlassPattern pattern{.image = {.size = 256}, .panes = 8, .variation = 0};
    pattern.color = {0, 0, 1};
    pattern.accent = {0, 1, 0};
    pattern.border = {1, 0, 0};
    const ImageData glass = make_stained_glass(pattern).base_color;
    double share[3] = {};
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
            for (int c = 0; c < 3; ++c) {
                share[c] += channel(glass, x, y, c) > 128 ? 1.0 / 65536 : 0;
            }
        }
    }
    CHECK(share[0] == test::near(0.18 * 0.8).epsilon(0.2));
    CHECK(share[1] / (share[1] + share[2]) == test::near(1.0 / 6).epsilon(0.5));
    CHECK(share[1] + share[2] > 0.5);
}

TEST_CASE("masonry_patterns: stars are bright on dark, and as many as requested") {
    const ImageData sky = make_stars({.image = {.size = 256}, .rows = 4}).base_color;
    // A row begins with half a star or a whole gap: its bright runs are its stars.
    for (const int y : {32, 96, 160, 224}) {
        int stars = 0;
        for (int x = 0; x < 256; ++x) {
            const bool now = channel(sky, x, y, 0) > 110;
            const bool before = channel(sky, (x + 255) % 256, y, 0) > 110;
            stars += now && !before ? 1 : 0;
        }
        CHECK(stars == 4);
    }
}

}  // namespace limn::masonry_patterns_test
