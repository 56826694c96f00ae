#include "content/make/patterns/puff_pattern.h"
#include "tests/near.h"
#include "tests/support.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace limn::test::puff_pattern_test {
namespace {

enum Side { Right, Above, Behind, Left, Below, Front };

/// One frame, without lumps: a ball whose density rises over its rim.
PatternMaps make_plain_ball(float density) {
    return make_puff(
        {.image = {.size = 64}, .frames = 1, .lumps = 0, .density = density, .fray = 0});
}

float channel(const ImageData& image, int x, int y, int c) {
    const auto at = static_cast<std::size_t>(4 * (y * image.width + x) + c);
    return static_cast<float>(image.pixels[at]) / 255;
}
float light(const PatternMaps& maps, int x, int y, Side side) {
    return side < Left ? channel(maps.positive_light, x, y, side)
                       : channel(maps.negative_light, x, y, side - Left);
}

}  // namespace

TEST_CASE("puff pattern: its images are linear, opacity is that of the shape, nothing glows") {
    const PatternMaps maps = make_puff({.image = {.size = 128}});
    CHECK(maps.base_color.srgb);
    CHECK_FALSE(maps.positive_light.srgb);
    CHECK_FALSE(maps.negative_light.srgb);
    for (int y = 0; y < 128; ++y) {
        for (int x = 0; x < 128; ++x) {
            REQUIRE(channel(maps.positive_light, x, y, 3) == channel(maps.base_color, x, y, 3));
            REQUIRE(channel(maps.negative_light, x, y, 3) == 0);
        }
    }
}

TEST_CASE("puff pattern: the opacity of a sphere follows from its optical depth") {
    for (const float density : {0.4f, 0.8f, 1.6f}) {
        CAPTURE(density);
        // 0.62 in radius, less half of the rim of 0.24, on both sides of the middle.
        const float depth = density * 2 * (0.62f - 0.12f);
        CHECK(
            channel(make_plain_ball(density).base_color, 32, 32, 3)
            == near(1 - std::exp(-depth)).scale(1).epsilon(0.01));
    }
}

TEST_CASE("puff pattern: light from the front and from behind is the integral along the view") {
    const float density = 2.5f;
    const double depth = density * 2 * (0.62 - 0.12);
    double front = 0;
    double behind = 0;
    for (int order = 0; order < 4; ++order) {
        const double share = std::pow(0.75, order);
        const double e = std::pow(0.3, order);
        front += share * (1 - std::exp(-(1 + e) * depth)) / (1 + e);
        behind += share * std::exp(-e * depth)
                  * (order == 0 ? depth : (1 - std::exp(-(1 - e) * depth)) / (1 - e));
    }
    const PatternMaps maps = make_plain_ball(density);
    CHECK(
        light(maps, 32, 32, Behind) / light(maps, 32, 32, Front)
        == near(behind / front).epsilon(0.03));
}

TEST_CASE("puff pattern: a sphere is lit alike from all sides, up to rotation") {
    const PatternMaps maps = make_plain_ball(6);
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            CAPTURE(x);
            CAPTURE(y);
            const float right = light(maps, x, y, Right);
            const float slack = 1.01f / 255;
            CHECK(std::abs(right - light(maps, 63 - x, y, Left)) < slack);
            CHECK(std::abs(right - light(maps, y, 63 - x, Above)) < slack);
            CHECK(std::abs(right - light(maps, y, x, Below)) < slack);
        }
    }
    CHECK(light(maps, 48, 32, Right) > 1.5f * light(maps, 16, 32, Right));
}

TEST_CASE("puff pattern: under uniform light no pixel is brighter than white") {
    for (const int seed : {1, 2, 3}) {
        const PatternMaps maps = make_puff({.image = {.size = 256, .seed = seed}});
        float brightest = 0;
        for (int y = 0; y < 256; ++y) {
            for (int x = 0; x < 256; ++x) {
                if (channel(maps.base_color, x, y, 3) > 0.55f) {
                    float sum = 0;
                    for (const Side side : {Right, Above, Behind, Left, Below, Front}) {
                        sum += light(maps, x, y, side);
                    }
                    brightest = std::max(brightest, sum * 2 / 3);
                }
            }
        }
        CHECK(brightest < 1.01f);
        CHECK(brightest > 0.9f);
    }
}

TEST_CASE("puff pattern: with fray the last frame covers less") {
    const auto mean_opacity = [](float fray) {
        const PatternMaps maps = make_puff({.image = {.size = 256}, .fray = fray});
        double sum = 0;
        for (int y = 192; y < 256; ++y) {
            for (int x = 192; x < 256; ++x) {
                sum += static_cast<double>(channel(maps.base_color, x, y, 3));
            }
        }
        return sum / (64 * 64);
    };
    CHECK(mean_opacity(1) < 0.9 * mean_opacity(0));
}

}  // namespace limn::test::puff_pattern_test
