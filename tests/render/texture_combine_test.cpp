#include "ecs/components/texture_combine.h"
#include "ecs/components/time.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace limn::test::texture_combine_test {
namespace {

constexpr int kSide = 16;
constexpr int kZoom = 4;  // pixels a texel

template <typename Texel>
ImageData painted(Texel&& texel) {
    ImageData image;
    image.name = "painted";
    image.width = image.height = kSide;
    image.format = PixelFormat::Rgba32F;
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const Vec4 color = texel(x, y);
            const auto* bytes = reinterpret_cast<const std::uint8_t*>(&color);
            image.pixels.insert(image.pixels.end(), bytes, bytes + sizeof(color));
        }
    }
    return image;
}

Vec3 water_color(int x, int y) {
    x = (x % kSide + kSide) % kSide;
    y = (y % kSide + kSide) % kSide;
    return {
        0.1f + 0.05f * static_cast<float>(x), 0.9f - 0.05f * static_cast<float>(y),
        (x + y) % 2 == 0 ? 0.2f : 0.6f};
}

constexpr Vec3 kBars = {0.7f, 0.3f, 0.1f};

Vec3 texel_at(const gpu::FloatImage& picture, int x, int y) {
    return rgb_at(picture, kZoom * x + kZoom / 2, kZoom * y + kZoom / 2);
}

/// A square that fills the image.
class Grating : public Scene {
  public:
    Grating() {
        world.insert_resource(Exposure{});
        combine.water = add(painted([](int x, int y) { return Vec4(water_color(x, y), 1); }));
        // Bars on the left, a hole on the right, half of both between.
        combine.grating = add(painted([](int x, int) {
            return Vec4(kBars, x < 5 ? 0 : x < 10 ? 0.5f : 1);
        }));
        combine.target = add(painted([](int, int) { return Vec4(0, 0, 0, 1); }));
        combine.speed = {1.0f / 8, 1.0f / 16};
        combine.gain = 1;
        Material material = {.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}};
        material.base_color_texture.image = combine.target;
        material.base_color_texture.nearest = true;
        place(add(make_square()), add(material), at({0, 0, 0}));
    }
    gpu::FloatImage at_time(double time, float alpha = 1) {
        world.insert_resource(FrameTime{.step = 1.0f / 60, .time = time});
        RenderView view = look({0, 0, 1}, {0, 0, 0}, kZoom * kSide, kZoom * kSide);
        view.alpha = alpha;
        return radiance(view);
    }

    TextureCombine combine;
};

}  // namespace

TEST_CASE_FIXTURE(
    Grating, "texture combine: two copies of water through the holes of a grating"
                 * technique("tex.combine")) {
    world.create(combine);
    // After three seconds one has moved by 6 texels along u, the other by 3 along v.
    for (const int seconds : {0, 3}) {
        const gpu::FloatImage rendered = at_time(seconds);
        float worst = 0;
        for (int y = 0; y < kSide; ++y) {
            for (int x = 0; x < kSide; ++x) {
                const Vec3 both = water_color(x + 2 * seconds, y) + water_color(x, y + seconds);
                const float open = x < 5 ? 0 : x < 10 ? 0.5f : 1;
                const Vec3 expected = both * open + kBars * (1 - open);
                worst = std::max(worst, glm::distance(texel_at(rendered, x, y), expected));
            }
        }
        CAPTURE(seconds);
        CHECK(worst < 0.01f);  // what glows is kept with 9 bits
    }
}

TEST_CASE_FIXTURE(
    Grating, "texture combine: at half gain, the sum of two is no more than one"
                 * technique("tex.combine")) {
    combine.gain = 0.5f;
    world.create(combine);
    const gpu::FloatImage rendered = at_time(0);
    for (int x = 10; x < kSide; ++x) {
        CHECK(glm::distance(texel_at(rendered, x, 4), water_color(x, 4)) < 0.01f);
    }
}

TEST_CASE_FIXTURE(
    Grating,
    "texture combine: whole copies later it is the same, to the bit" * technique("tex.combine")) {
    world.create(combine);
    const gpu::FloatImage start = at_time(0);
    CHECK(at_time(16).pixels == start.pixels);
    CHECK(at_time(16.0 * 3600).pixels == start.pixels);
    CHECK(largest_difference(at_time(4), start) > 0.1f);
}

TEST_CASE_FIXTURE(
    Grating, "texture combine: a time looks the same however many frames precede it"
                 * technique("tex.combine")) {
    combine.speed = {0.37f, 0.21f};
    world.create(combine);
    for (int i = 0; i < 8; ++i) {
        at_time(i / 60.0);
    }
    const gpu::FloatImage rendered = at_time(8 / 60.0);
    for (int i = 0; i < 4; ++i) {
        at_time(2 * i / 60.0);
    }
    CHECK(at_time(8 / 60.0).pixels == rendered.pixels);
    // And between two steps.
    CHECK(largest_difference(at_time(8.5 / 60.0, 0.5f), rendered) < 1e-4f);
}

TEST_CASE_FIXTURE(
    Grating, "texture combine: without an image, or if it reads its own target, nothing is drawn"
                 * technique("tex.combine")) {
    const Entity bad = world.create(combine);
    for (const int missing : {0, 1, 2, 3}) {
        TextureCombine& broken = world.get<TextureCombine>(bad);
        broken = combine;
        (missing == 0 ? broken.water : missing == 1 ? broken.grating : broken.target) = {77};
        if (missing == 3) {
            broken.target = broken.water;
        }
        const gpu::FloatImage rendered = at_time(0);
        CHECK(texel_at(rendered, 3, 3) == Vec3(0));
    }
}

}  // namespace limn::test::texture_combine_test
