#include "bench/oracles/tone_oracle.h"
#include "render/gpu/readback.h"
#include "render/lens/tone_mapper.h"
#include "tests/near.h"
#include "tests/render/render_fixture.h"
#include "tests/technique.h"

#include <algorithm>
#include <cmath>
#include <vector>

// The local operator: laws of the double-precision one, then the GPU's distance from it.

namespace limn::test::dodge_burn_test {
namespace {

constexpr int kWidth = 160;
constexpr int kHeight = 96;

/// Luminances after exposure, rows from top to bottom.
using Picture = std::vector<double>;

template <typename Function>
Picture make_picture(Function&& value) {
    Picture picture;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            picture.push_back(value(x, y));
        }
    }
    return picture;
}

/// A bright disc of radius 12 in the center of a dark ground.
Picture make_spot(double bright = 20, double dark = 0.1) {
    return make_picture([=](int x, int y) {
        return std::hypot(x - kWidth / 2 + 0.5, y - kHeight / 2 + 0.5) < 12 ? bright : dark;
    });
}

/// A dim room with a pattern on its walls, and a window on a bright view with one of its own.
Picture make_room() {
    return make_picture([](int x, int y) {
        const bool window = x > 95 && x < 140 && y > 20 && y < 70;
        const double pattern = 1 + 0.3 * std::sin(0.6 * x) * std::cos(0.35 * y);
        return (window ? 30.0 : 0.15 + 0.002 * x) * pattern;
    });
}

/// At the center of a pixel, sampled bilinearly in an image of `step` pixels per texel.
double read_between(const gpu::FloatImage& image, int channel, int x, int y, int step) {
    const double at_x = std::clamp((x + 0.5) / step - 0.5, 0.0, image.width - 1.0);
    const double at_y = std::clamp((y + 0.5) / step - 0.5, 0.0, image.height - 1.0);
    const int left = static_cast<int>(at_x);
    const int top = static_cast<int>(at_y);
    const int right = std::min(left + 1, image.width - 1);
    const int bottom = std::min(top + 1, image.height - 1);
    return std::lerp(
        std::lerp(image.at(left, top, channel), image.at(right, top, channel), at_x - left),
        std::lerp(image.at(left, bottom, channel), image.at(right, bottom, channel), at_x - left),
        at_y - top);
}

std::size_t index(int x, int y) {
    return static_cast<std::size_t>(y) * kWidth + x;
}

struct DodgeBurn : RenderTest {
    gpu::Texture upload(const Picture& picture) {
        std::vector<float> values;
        for (int y = kHeight; y-- > 0;) {  // OpenGL's first row is the bottom one
            for (int x = 0; x < kWidth; ++x) {
                values.insert(values.end(), 3, static_cast<float>(picture[index(x, y)]));
                values.push_back(1);
            }
        }
        gpu::Texture texture("picture", {.format = GL_RGBA32F, .width = kWidth, .height = kHeight});
        texture.upload<float>(values, GL_RGBA, GL_FLOAT);
        return texture;
    }
    /// Display luminance of every pixel, to half a code.
    Picture show(const Picture& picture) {
        const gpu::Texture texture = upload(picture);
        const Exposure exposure = {
            .curve = ToneCurve::Local,
            .encoding = DisplayEncoding::Power,
            .gamma = 1,
            .dither = false};
        graph.begin_frame();
        const TextureId display =
            apply_tone_mapper(graph, tone_mapper, exposure, {}, graph.import("picture", texture));
        graph.keep(display);
        graph.execute();
        const gpu::ByteImage bytes = gpu::read_bytes(*graph.texture(display));
        return make_picture([&](int x, int y) { return bytes.at(x, y, 0) / 255.0; });
    }

    FrameGraph graph{device()};
    ToneMapper tone_mapper = *create_tone_mapper(device());
};

}  // namespace

TEST_CASE("hdr: a uniform image is mapped by the global curve" * technique("hdr.dodge-burn")) {
    for (const double l : {0.02, 0.18, 3.0}) {
        const oracle::DodgeBurn local =
            oracle::dodge_burn(Picture(kWidth * kHeight, l), kWidth, kHeight);
        CHECK(*std::min_element(local.scale.begin(), local.scale.end()) == 8);
        CHECK(local.display[index(40, 40)] == test::near(oracle::compress(l)).epsilon(1e-12));
    }
    // Contrast that is small at every scale does not make a region.
    const Picture faint = make_picture([](int x, int) { return x < kWidth / 2 ? 0.2 : 0.205; });
    const oracle::DodgeBurn local = oracle::dodge_burn(faint, kWidth, kHeight);
    CHECK(*std::min_element(local.scale.begin(), local.scale.end()) == 8);
}

TEST_CASE(
    "hdr: even regions are small near an edge and large far from it"
    * technique("hdr.dodge-burn")) {
    const oracle::DodgeBurn local = oracle::dodge_burn(make_spot(), kWidth, kHeight);
    const int center_row = kHeight / 2;
    const int edge = local.scale[index(kWidth / 2 + 13, center_row)];
    const int near_by = local.scale[index(kWidth / 2 + 24, center_row)];
    const int far_away = local.scale[index(kWidth - 1, 0)];
    CHECK(edge < near_by);
    CHECK(near_by < far_away);
    CHECK(far_away == 8);
}

TEST_CASE(
    "hdr: relative to the global curve, local contrast is preserved or raised"
    * technique("hdr.dodge-burn")) {
    const Picture room = make_room();
    const oracle::DodgeBurn local = oracle::dodge_burn(room, kWidth, kHeight);
    for (std::size_t i = 0; i < room.size(); ++i) {
        const double global = oracle::compress(room[i]);
        if (local.surround[i] > room[i] - 1) {
            CHECK(local.display[i] < 1);
        }
        if (room[i] > local.surround[i]) {
            CHECK(local.display[i] > global);
        }
        if (room[i] < local.surround[i]) {
            CHECK(local.display[i] < global);
        }
    }
}

TEST_CASE_FIXTURE(
    DodgeBurn, "hdr: the GPU's blurs match the oracle's Gaussians" * technique("hdr.dodge-burn")) {
    const Picture room = make_room();
    const gpu::Texture texture = upload(room);
    graph.begin_frame();
    const LocalLuminance blurred =
        blur_luminance(graph, tone_mapper.local, graph.import("picture", texture));
    for (const TextureId id : {blurred.fine, blurred.medium, blurred.coarse}) {
        graph.keep(id);
    }
    graph.execute();
    const gpu::FloatImage levels[] = {
        gpu::read_floats(*graph.texture(blurred.fine)),
        gpu::read_floats(*graph.texture(blurred.medium)),
        gpu::read_floats(*graph.texture(blurred.coarse))};
    // Largest and mean relative error: of the shrunken levels, that of reading between texels.
    constexpr double kLargest[] = {1e-5, 1e-5, 1e-5, 5e-4, 0.21, 0.05, 0.04, 0.03, 0.215, 0.14};
    constexpr double kMean[] = {1e-6,   1e-6,   1e-6,  1e-5,   0.0067,
                                0.0031, 0.0014, 0.002, 0.0059, 0.0058};
    constexpr int kSteps[] = {1, 2, 4};
    for (int scale = 0; scale < 10; ++scale) {
        const int level = scale / 4;
        const int step = kSteps[level];
        const gpu::FloatImage& image = levels[level];
        const Picture want = oracle::gaussian_response(room, kWidth, kHeight, scale);
        double largest = 0;
        double sum = 0;
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                const double got = read_between(image, scale % 4, x, y, step);
                const double there = want[index(x, y)];
                const double error = std::abs(got - there) / (0.1 + there);
                largest = std::max(largest, error);
                sum += error;
            }
        }
        CAPTURE(scale);
        CHECK(largest < kLargest[scale]);
        CHECK(sum / (kWidth * kHeight) < kMean[scale]);
    }
}

TEST_CASE_FIXTURE(
    DodgeBurn, "hdr: dodge and burn on the GPU matches the oracle" * technique("hdr.dodge-burn")) {
    for (const Picture& picture :
         {make_spot(), make_spot(1.2, 0.3), make_room(), Picture(kWidth * kHeight, 0.4)}) {
        const Picture got = show(picture);
        const oracle::DodgeBurn want = oracle::dodge_burn(picture, kWidth, kHeight);
        double sum = 0;
        int far_off = 0;
        for (std::size_t i = 0; i < got.size(); ++i) {
            const double error = std::abs(got[i] - std::min(want.display[i], 1.0));
            sum += error;
            far_off += error > 2.5 / 255 ? 1 : 0;
        }
        const double pixels = kWidth * kHeight;
        CHECK(sum / pixels < 1.0 / 255);
        CHECK(far_off / pixels < 0.02);  // a scale more or less, where the activity is at its limit
    }
}

TEST_CASE_FIXTURE(DodgeBurn, "hdr: a uniform image gets the global curve on the GPU too") {
    for (const double l : {0.02, 0.18, 3.0}) {
        const Picture got = show(Picture(kWidth * kHeight, l));
        CHECK(std::abs(got[index(3, 3)] - oracle::compress(l)) <= 0.51 / 255);
        CHECK(
            *std::min_element(got.begin(), got.end()) == *std::max_element(got.begin(), got.end()));
    }
}

TEST_CASE_FIXTURE(DodgeBurn, "hdr: a NaN pixel affects only itself") {
    Picture picture(kWidth * kHeight, 0.4);
    picture[index(80, 48)] = std::nan("");
    picture[index(20, 20)] = INFINITY;
    const Picture got = show(picture);
    CHECK(got[index(80, 48)] == 0);
    CHECK(got[index(20, 20)] == 1);
    CHECK(std::abs(got[index(140, 80)] - oracle::compress(0.4)) <= 0.51 / 255);
}

}  // namespace limn::test::dodge_burn_test
