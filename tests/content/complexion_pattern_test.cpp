#include "content/make/head/complexion_pattern.h"
#include "content/make/head/head_layout.h"
#include "content/make/patterns/pattern_maps.h"
#include "ecs/base/math.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace limn::complexion_pattern_test {
namespace {

constexpr int kSize = 512;

struct Skin {
    float age = 0;
    float freckles = 0;
    float beard = 0;
    float unevenness = 1;
};

ImageData skin(const Skin& skin) {
    return make_complexion({.image = {.size = kSize},
                            .unevenness = skin.unevenness,
                            .age = skin.age,
                            .freckles = skin.freckles,
                            .beard = skin.beard})
        .base_color;
}

/// sRGB, of a pixel.
IVec3 texel(const ImageData& image, int x, int y) {
    const auto i = static_cast<std::size_t>(4 * (y * image.width + x));
    return {image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]};
}

/// A box in columns and rows of the head, on its left half.
struct Box {
    Vec2 low, high;
};
constexpr Box kForehead = {{2, 11}, {18, 20}};
constexpr Box kTemple = {{18, 18}, {26, 30}};
constexpr Box kCheek = {{8, 35}, {14, 42}};
constexpr Box kChin = {{-6, 57}, {6, 62}};
constexpr Box kLips = {{-8, 48}, {8, 52}};
constexpr Box kLids = {{7, 26}, {14, 32}};

int column_of(float x) {
    return static_cast<int>((x / kHeadColumns + 0.5f) * kSize);
}

int row_of(float y) {
    return static_cast<int>((y + 13) / (kHeadRows + 13) * kSize);
}

/// Mean and spread of a channel in a box, and the share of texels that are much darker than that.
struct Tone {
    double mean = 0;
    double deviation = 0;
    double spots = 0;
};

Tone tone_of(const ImageData& image, const Box& box, int channel = 0) {
    Tone tone;
    for (int pass = 0; pass < 3; ++pass) {
        double sum = 0;
        double count = 0;
        for (int y = row_of(box.low.y); y < row_of(box.high.y); ++y) {
            for (int x = column_of(box.low.x); x < column_of(box.high.x); ++x) {
                const double value = texel(image, x, y)[channel];
                sum += pass == 0   ? value
                       : pass == 1 ? square(value - tone.mean)
                                   : (value < tone.mean - 14 ? 1 : 0);
                ++count;
            }
        }
        (pass == 0 ? tone.mean : pass == 1 ? tone.deviation : tone.spots) = sum / count;
    }
    tone.deviation = std::sqrt(tone.deviation);
    return tone;
}

TEST_CASE("complexion: pigments take the least of red, and little of the light") {
    const ImageData image = skin({.age = 0.2f});
    for (int y = 0; y < kSize; y += 3) {
        for (int x = 0; x < kSize; x += 3) {
            const IVec3 c = texel(image, x, y);
            CHECK(c.x >= std::max(c.y, c.z));
            CHECK(c.x > 215);
            CHECK(c.y > 180);
        }
    }
    // Blood of 0.25 more and melanin of 0.02 more, in sRGB.
    const double linear = std::exp(-0.25 * 0.53 - 0.03 * 1.73);
    const double srgb = 255 * (1.055 * std::pow(linear, 1 / 2.4) - 0.055);
    CHECK(std::abs(tone_of(image, kCheek, 1).mean - srgb) < 5);
    CHECK(std::abs(tone_of(skin({.age = 1}), kCheek, 1).mean - srgb) < 9);
}

TEST_CASE("complexion: even without unevenness, uneven in proportion to it") {
    const auto deviation = [](float unevenness) {
        return tone_of(skin({.unevenness = unevenness}), kCheek, 1).deviation;
    };
    CHECK(deviation(0) < 0.5);
    CHECK(deviation(1) > 1.5);
    CHECK(deviation(2) > 1.6 * deviation(1));
    CHECK(deviation(2) < 2.4 * deviation(1));
}

TEST_CASE("complexion: old skin has spots where the sun shines on it, young skin none") {
    const ImageData young = skin({.age = 0.2f});
    const ImageData middle = skin({.age = 0.6f});
    const ImageData old = skin({.age = 1});
    for (const Box& box : {kForehead, kTemple}) {
        CHECK(tone_of(young, box).spots == 0);
        CHECK(tone_of(old, box).spots > 0.01);
        CHECK(tone_of(old, box).spots < 0.15);
    }
    CHECK(tone_of(middle, kForehead).spots < tone_of(old, kForehead).spots);
    CHECK(tone_of(old, kLips).spots == 0);
    CHECK(tone_of(old, kLids).spots == 0);
    CHECK(tone_of(old, kCheek, 1).deviation > 1.3 * tone_of(young, kCheek, 1).deviation);
}

TEST_CASE("complexion: freckles are on nose and cheeks") {
    const ImageData image = skin({.freckles = 1});
    CHECK(tone_of(image, kCheek).spots > 0.01);
    CHECK(tone_of(image, kCheek).spots < 0.2);
    CHECK(tone_of(image, kChin).spots == 0);
    CHECK(tone_of(image, kForehead).spots == 0);
    CHECK(tone_of(skin({}), kCheek).spots == 0);
}

TEST_CASE("complexion: stubble darkens the chin, not the forehead nor the lips") {
    const ImageData shaved = skin({});
    const ImageData bearded = skin({.beard = 1});
    CHECK(tone_of(bearded, kChin).mean < tone_of(shaved, kChin).mean - 20);
    CHECK(tone_of(bearded, kForehead).mean == tone_of(shaved, kForehead).mean);
    CHECK(tone_of(bearded, kLips).mean > tone_of(shaved, kLips).mean - 4);
    // Bluer: it takes less of blue than of red.
    const double red = tone_of(bearded, kChin, 0).mean / tone_of(shaved, kChin, 0).mean;
    const double blue = tone_of(bearded, kChin, 2).mean / tone_of(shaved, kChin, 2).mean;
    CHECK(blue > red + 0.005);
}

/// Root mean square of the slopes in a box, of texels of 0.6 mm.
double steepness(float age, const Box& box) {
    const ImageData normal = make_complexion({.image = {.size = kSize}, .age = age}).normal;
    double sum = 0;
    double count = 0;
    for (int y = row_of(box.low.y); y < row_of(box.high.y); ++y) {
        for (int x = column_of(box.low.x); x < column_of(box.high.x); ++x) {
            const Vec3 n = (Vec3(texel(normal, x, y)) - 128.0f) / 127.0f;
            sum += static_cast<double>((n.x * n.x + n.y * n.y) / (n.z * n.z));
            ++count;
        }
    }
    return std::sqrt(sum / count);
}

TEST_CASE(
    "complexion: skin is bumpy enough to break up highlights, more when old, hardly on lips") {
    const double cheek = steepness(0, kCheek);
    CHECK(cheek > 0.02);
    CHECK(cheek < 0.1);
    CHECK(steepness(1, kCheek) > 1.4 * cheek);
    CHECK(steepness(1, kCheek) < 0.25);
    CHECK(steepness(0, kLips) < 0.5 * cheek);
}

TEST_CASE("complexion: both sides of the texture seam agree") {
    const ImageData image = skin({.age = 1, .freckles = 1, .beard = 1});
    double across = 0;
    double inside = 0;
    for (int y = 0; y < kSize; ++y) {
        across += std::abs(texel(image, 0, y).y - texel(image, kSize - 1, y).y);
        inside += std::abs(texel(image, 1, y).y - texel(image, 0, y).y);
    }
    CHECK(across < 1.3 * inside + kSize);
}

}  // namespace
}  // namespace limn::complexion_pattern_test
