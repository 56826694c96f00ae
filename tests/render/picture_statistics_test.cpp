#include "bench/oracles/tone_oracle.h"
#include "ecs/base/rng.h"
#include "render/frame_clock.h"
#include "render/lens/tone_mapper.h"
#include "render/shaders/tone_gpu.h"
#include "tests/near.h"
#include "tests/render/render_fixture.h"
#include "tests/technique.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

// The statistics of images on the GPU against the double-precision oracle.

namespace limn::test::picture_statistics_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Statistics : RenderTest {

    /// `width` times as many rows as there are pixels for; bottom row first, which no sum minds.
    layout::ImageStatistics
    measure(const std::vector<Vec3>& pixels, int width, const MeasureRequest& request = {}) {
        const int height = static_cast<int>(pixels.size()) / width;
        gpu::Texture picture("picture", {.format = GL_RGBA32F, .width = width, .height = height});
        picture.upload<Vec3>(pixels, GL_RGB, GL_FLOAT);
        graph.begin_frame();
        static_cast<void>(measure_image(graph, pass, graph.import("picture", picture), request));
        graph.execute();
        return pass.measure.read_value<layout::ImageStatistics>(0);
    }
    /// Rows of `width`; the first `surfaces` pixels show a surface.
    layout::ImageStatistics
    measure_surfaces(const std::vector<Vec3>& pixels, std::size_t surfaces) {
        std::vector<float> depths(pixels.size());
        std::fill_n(depths.begin(), surfaces, 0.01f);
        gpu::Texture depth("depth", {.format = GL_R32F, .width = 8, .height = 8});
        depth.upload<float>(depths, GL_RED, GL_FLOAT);
        gpu::Texture picture("picture", {.format = GL_RGBA32F, .width = 8, .height = 8});
        picture.upload<Vec3>(pixels, GL_RGB, GL_FLOAT);
        graph.begin_frame();
        static_cast<void>(measure_image(
            graph, pass, graph.import("picture", picture),
            {.depth = graph.import("depth", depth)}));
        graph.execute();
        return pass.measure.read_value<layout::ImageStatistics>(0);
    }
    layout::ImageStatistics even(const Vec3& color, const MeasureRequest& request = {}) {
        return measure(std::vector<Vec3>(64, color), 8, request);
    }

    FrameGraph graph{device()};
    StatisticsPass pass = *create_statistics_pass(device());
};

/// An image of 14 stops in no pattern.
std::vector<Vec3> make_noise(int count, float scale = 1.0f) {
    Random rng(7, 0, 0, 0);
    std::vector<Vec3> pixels;
    for (int i = 0; i < count; ++i) {
        const float level = std::exp2(14.0f * rng.uniform() - 7.0f);
        pixels.push_back(scale * level * Vec3(rng.uniform(), rng.uniform(), 0.2f + rng.uniform()));
    }
    return pixels;
}

oracle::ImageStatistics expected_statistics(const std::vector<Vec3>& pixels) {
    std::vector<glm::dvec3> exact;
    for (const Vec3& pixel : pixels) {
        exact.emplace_back(pixel);
    }
    return oracle::measure_image(exact);
}

double ratio(float a, float b) {
    return static_cast<double>(a) / b;
}

}  // namespace

TEST_CASE("picture statistics: metered for surfaces, the background hardly counts") {
    Statistics statistics;
    std::vector<Vec3> pixels(64, Vec3(900));
    std::fill_n(pixels.begin(), 16, Vec3(0.18f));
    const auto log_of = [](double light) { return std::log2(light + 1e-4); };
    const double expected =
        std::exp2((16 * 256 * log_of(0.18) + 48 * log_of(900)) / (16 * 256 + 48));
    CHECK(statistics.measure_surfaces(pixels, 16).luminance.x == near(expected));
    CHECK(expected < 0.2);
    // Where there is nothing else, it is what is metered.
    const double whole = std::exp2((16 * log_of(0.18) + 48 * log_of(900)) / 64);
    CHECK(statistics.measure_surfaces(pixels, 0).luminance.x == near(whole));
    CHECK(statistics.measure_surfaces(pixels, 64).luminance.x == near(whole));
}

TEST_CASE_FIXTURE(
    Statistics, "hdr: statistics on the GPU are those of the oracle to a thousandth"
                    * technique("hdr.log-average")) {
    for (const IVec2 size : {IVec2(1, 1), IVec2(64, 64), IVec2(65, 63), IVec2(317, 181)}) {
        const std::vector<Vec3> pixels = make_noise(size.x * size.y);
        const oracle::ImageStatistics want = expected_statistics(pixels);
        const layout::ImageStatistics got = measure(pixels, size.x);
        CAPTURE(size.x);
        CHECK(got.luminance.x == test::near(want.log_average).epsilon(1e-3));
        for (int c = 0; c < 3; ++c) {
            CHECK(got.mean_scale[c] == test::near(want.mean[c]).epsilon(1e-5));
        }
        CHECK(got.luminance.z == test::near(want.least).epsilon(1e-6));
        CHECK(got.luminance.w == test::near(want.largest).epsilon(1e-6));
        CHECK(got.pixels.x == pixels.size());
        CHECK(got.pixels.y == 0);
        CHECK(got.mean_scale.w == 1);
    }
}

TEST_CASE_FIXTURE(
    Statistics, "hdr: the log-average of one color is its luminance, of black delta"
                    * technique("hdr.log-average, hdr.luminance")) {
    CHECK(even({1, 0.5f, 0.25f}).luminance.x == test::near(0.62 + 1e-4).epsilon(1e-5));
    CHECK(even(Vec3(0)).luminance.x == test::near(1e-4).epsilon(1e-4));
    const std::vector<Vec3> two = {Vec3(1), Vec3(100), Vec3(1), Vec3(100)};
    CHECK(measure(two, 2).luminance.x == test::near(10).epsilon(1e-3));
}

TEST_CASE_FIXTURE(
    Statistics, "hdr: the range of 0.01 and 1000 is 1e5, in any unit, and 1 in the dark"
                    * technique("hdr.dynamic-range")) {
    for (const float unit : {1.0f, 0.125f, 37.0f}) {
        const std::vector<Vec3> two = {Vec3(0.01f * unit), Vec3(1000 * unit)};
        const layout::ImageStatistics got = measure(two, 2, {.histogram = true});
        CHECK(ratio(got.luminance.w, got.luminance.z) == test::near(1e5).epsilon(1e-5));
        CHECK(ratio(got.clipped.y, got.clipped.x) == test::near(1e5).epsilon(1e-5));
    }
    const std::vector<Vec3> lit = {Vec3(0), Vec3(0.5f), Vec3(2), Vec3(0)};
    CHECK(measure(lit, 2).luminance.z == test::near(0.5));  // black has no ratio
    const layout::ImageStatistics black = even(Vec3(0), {.histogram = true});
    CHECK(black.luminance.z == 0);
    CHECK(black.luminance.w == 0);
}

TEST_CASE_FIXTURE(
    Statistics, "hdr: the clipped range is the oracle's to the width of a bin, twice too"
                    * technique("hdr.dynamic-range")) {
    const std::vector<Vec3> pixels = make_noise(300 * 100);
    const oracle::ImageStatistics want = expected_statistics(pixels);
    const double bin = std::exp2(1.1 / layout::kBinsPerStop);
    for (int again = 0; again < 2; ++again) {  // the histogram is empty again
        const layout::ImageStatistics got = measure(pixels, 300, {.histogram = true});
        CHECK(got.clipped.x <= want.clipped_min_luminance);
        CHECK(got.clipped.x >= want.clipped_min_luminance / bin);
        CHECK(got.clipped.y >= want.clipped_max_luminance);
        CHECK(got.clipped.y <= want.clipped_max_luminance * bin);
        CHECK(got.luminance.z < want.clipped_min_luminance / bin);  // it does leave something out
        CHECK(got.luminance.w > want.clipped_max_luminance * bin);
    }
    std::vector<Vec3> spike(10000, Vec3(1));
    spike[5000] = Vec3(1e4f);
    const layout::ImageStatistics got = measure(spike, 100, {.histogram = true});
    CHECK(ratio(got.clipped.y, got.clipped.x) <= bin);
}

TEST_CASE_FIXTURE(
    Statistics,
    "hdr: NaN and infinity are counted and change nothing else" * technique("hdr.dynamic-range")) {
    const std::vector<Vec3> good = make_noise(90);
    std::vector<Vec3> bad = good;
    bad.insert(bad.begin() + 30, {Vec3(kNan, 1, 1), Vec3(1, kInfinity, 1), Vec3(1, 1, -kInfinity)});
    bad.insert(bad.end(), 3, Vec3(kNan));
    const layout::ImageStatistics got = measure(bad, 8);
    const oracle::ImageStatistics want = expected_statistics(good);
    CHECK(got.pixels.x == 90);
    CHECK(got.pixels.y == 6);
    CHECK(got.luminance.x == test::near(want.log_average).epsilon(1e-3));
    CHECK(got.luminance.w == test::near(want.largest).epsilon(1e-6));
    CHECK(got.mean_scale.x == test::near(want.mean.x).epsilon(1e-5));

    const layout::ImageStatistics nothing = even(Vec3(kNan), {.key = 0.18f});
    CHECK(nothing.pixels.x == 0);
    CHECK(nothing.luminance.x == test::near(1e-4));
    CHECK(std::isfinite(nothing.mean_scale.w));
}

TEST_CASE_FIXTURE(Statistics, "hdr: light below 0 counts as none, above the largest half as that") {
    CHECK(even({-5, -1, -2}).luminance.w == 0);
    CHECK(even(Vec3(1e20f)).luminance.w == test::near(65504));
    CHECK(even({-5, 0.5f, -2}).mean_scale.x == 0);
}

TEST_CASE_FIXTURE(
    Statistics,
    "hdr: equal images have equal statistics, to the last bit" * technique("hdr.log-average")) {
    const std::vector<Vec3> pixels = make_noise(640 * 90);
    const layout::ImageStatistics first = measure(pixels, 640);
    for (int i = 0; i < 3; ++i) {
        const layout::ImageStatistics again = measure(pixels, 640);
        CHECK(std::memcmp(&again, &first, sizeof(first)) == 0);
    }
}

TEST_CASE_FIXTURE(
    Statistics, "hdr: metering brings the log-average to the key in any unit of light"
                    * technique("hdr.key-scale")) {
    for (const float unit : {1.0f, 1000.0f}) {
        const std::vector<Vec3> pixels = make_noise(64 * 64, unit);
        const layout::ImageStatistics got = measure(pixels, 64, {.key = 0.18f});
        CHECK(got.mean_scale.w * got.luminance.x == test::near(0.18).epsilon(1e-5));
        CHECK(
            unit * got.mean_scale.w * expected_statistics(make_noise(64 * 64)).log_average
            == test::near(0.18).epsilon(0.02));  // the added kLogDelta is of one unit
    }
    const std::vector<Vec3> two = {Vec3(1), Vec3(100)};
    CHECK(measure(two, 2, {.key = 0.18f}).mean_scale.w == test::near(0.018).epsilon(1e-3));
    // In the dark the key is delta, and no further than it may adapt.
    CHECK(even(Vec3(0), {.key = 0.18f}).mean_scale.w == test::near(1800).epsilon(1e-3));
    CHECK(
        even(Vec3(0), {.key = 0.18f, .adaptation_range = {0.01f, 10}}).mean_scale.w
        == test::near(18).epsilon(1e-3));
    CHECK(
        even(Vec3(100), {.key = 0.18f, .adaptation_range = {0.01f, 10}}).mean_scale.w
        == test::near(0.018).epsilon(1e-3));
}

TEST_CASE_FIXTURE(
    Statistics, "hdr: the eye is at home in its first frame, then goes the share it is given") {
    CHECK(even(Vec3(2), {.key = 0.18f, .blend = 0.25f}).luminance.y == test::near(2.0001));
    CHECK(even(Vec3(10), {.key = 0.18f, .blend = 0.25f}).luminance.y == test::near(4.0001));
    const layout::ImageStatistics again = even(Vec3(10), {.key = 0.18f, .blend = 0.25f});
    CHECK(again.luminance.y == test::near(5.5001));
    CHECK(again.mean_scale.w == test::near(0.18 / 5.5001));
    CHECK(even(Vec3(10), {.key = 0.18f, .blend = 0}).luminance.y == again.luminance.y);
    const layout::ImageStatistics home = even(Vec3(0.1f), {.key = 0.18f, .blend = 1});
    CHECK(home.luminance.y == home.luminance.x);
}

TEST_CASE("hdr: only cuts restart the frame clock") {
    FrameClock clock;
    const Affine here;
    Affine near_by = here;
    near_by.row[0].w = 1;
    Affine far_away = here;
    far_away.row[0].w = 12;
    Affine turned = here;  // by 90 degrees about y
    turned.row[0] = {0, 0, 1, 0};
    turned.row[2] = {-1, 0, 0, 0};
    CHECK_FALSE(seconds_since_last(clock, 1, 5.0, here).has_value());
    CHECK(seconds_since_last(clock, 1, 5.1, near_by).value() == test::near(0.1));
    CHECK(seconds_since_last(clock, 1, 5.1, near_by).value() == 0);
    CHECK_FALSE(seconds_since_last(clock, 2, 5.2, near_by).has_value());    // another world
    CHECK_FALSE(seconds_since_last(clock, 2, 5.1, near_by).has_value());    // earlier
    CHECK_FALSE(seconds_since_last(clock, 2, 7.0, near_by).has_value());    // much later
    CHECK_FALSE(seconds_since_last(clock, 2, 7.01, far_away).has_value());  // elsewhere
    CHECK_FALSE(seconds_since_last(clock, 2, 7.02, turned).has_value());
    CHECK_FALSE(seconds_since_last(clock, 2, 7.03, here).has_value());
    CHECK(seconds_since_last(clock, 2, 7.05, here).value() == test::near(0.02));
}

}  // namespace limn::test::picture_statistics_test
