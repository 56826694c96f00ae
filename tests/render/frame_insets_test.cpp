#include "render/particles/frame_insets.h"
#include "render/shaders/particle_gpu.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

namespace limn::test::frame_insets_test {
namespace {

constexpr int kFrame = 48;  // pixels of a side
constexpr int kFrames = 3;  // of a side

/// Transparent.
ImageData make_book() {
    ImageData image;
    image.width = image.height = kFrames * kFrame;
    image.pixels.assign(4 * static_cast<std::size_t>(image.width * image.height), 0);
    return image;
}

void set_opaque(ImageData& image, int x, int y) {
    image.pixels[4 * static_cast<std::size_t>(y * image.width + x) + 3] = 1;
}

/// The fraction of a frame that an inset cuts off.
float inset_fraction(std::uint32_t inset) {
    return static_cast<float>(inset) / static_cast<float>(layout::kInsetSteps);
}

}  // namespace

TEST_CASE("frame insets: no visible texel is cut off, and few invisible ones are kept") {
    for (int corner = 0; corner < 40; ++corner) {
        const int left = corner % 20;
        const int top = (7 * corner) % 17;
        const int right = kFrame - 1 - (3 * corner) % 19;
        const int bottom = kFrame - 1 - (5 * corner) % 16;
        ImageData image = make_book();
        const int frame = corner % (kFrames * kFrames);
        const int first_x = frame % kFrames * kFrame;
        const int first_y = frame / kFrames * kFrame;
        set_opaque(image, first_x + left, first_y + (top + bottom) / 2);
        set_opaque(image, first_x + right, first_y + (top + bottom) / 2);
        set_opaque(image, first_x + (left + right) / 2, first_y + top);
        set_opaque(image, first_x + (left + right) / 2, first_y + bottom);
        CAPTURE(corner);
        const FrameInsets found =
            find_insets(image, kFrames, kFrames, static_cast<std::uint32_t>(frame));
        const auto fits = [](std::uint32_t inset, int transparent) {
            const float texels = inset_fraction(inset) * kFrame;
            const float filtered = static_cast<float>(transparent) - 0.5f;
            const bool keeps_what_is_visible = texels <= std::max(filtered, 0.0f);
            return keeps_what_is_visible && texels >= filtered - 1;
        };
        CHECK(fits(found.left, left));
        CHECK(fits(found.top, top));
        CHECK(fits(found.right, kFrame - 1 - right));
        CHECK(fits(found.bottom, kFrame - 1 - bottom));
    }
}

TEST_CASE("frame insets: an empty frame keeps a few texels, a full one all") {
    ImageData image = make_book();
    const FrameInsets empty = find_insets(image, kFrames, kFrames, 4);
    CHECK(inset_fraction(empty.left + empty.right) < 1);
    CHECK(inset_fraction(empty.left + empty.right) > 0.95f);
    CHECK(inset_fraction(empty.bottom + empty.top) > 0.95f);
    std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{255});
    CHECK(find_insets(image, kFrames, kFrames, 4) == FrameInsets{});
}

TEST_CASE("frame insets: no frame is read beyond the image, and none of an invalid image") {
    ImageData image = make_book();
    CHECK(find_insets(image, 5, 1, 0) == FrameInsets{});
    CHECK(find_insets(image, 0, 1, 0) == FrameInsets{});
    CHECK(find_insets(image, 1, 4096, 4095) == FrameInsets{});
    image.pixels.resize(17);
    CHECK(find_insets(image, 1, 1, 0) == FrameInsets{});
    FrameInsetTable table;
    CHECK(table.find(image, {1}, 64, 64).empty());
}

TEST_CASE("frame insets: all four are packed as digits of one float") {
    constexpr std::uint32_t kMax = layout::kInsetSteps / 2 - 1;
    const FrameInsets all = {kMax, kMax - 1, 1, kMax};
    double rest = static_cast<double>(pack_insets(all));
    for (const std::uint32_t digit : {all.left, all.bottom, all.right, all.top}) {
        CHECK(std::fmod(rest, kMax + 1.0) == digit);
        rest = std::floor(rest / (kMax + 1.0));
    }
    CHECK(rest == 0);
}

TEST_CASE("frame insets: a table recomputes the insets of an image only for other assets") {
    FrameInsetTable table;
    table.use_assets(1);
    ImageData image = make_book();
    const std::vector<float> before = table.find(image, {0}, kFrames, kFrames);
    CHECK(before.size() == kFrames * kFrames);
    std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{255});
    CHECK(table.find(image, {0}, kFrames, kFrames) == before);
    CHECK(table.find(image, {1}, kFrames, kFrames) != before);
    CHECK(table.find(image, {0}, 1, 1).size() == 1);
    table.use_assets(2);
    CHECK(table.find(image, {0}, kFrames, kFrames) != before);
}

}  // namespace limn::test::frame_insets_test
