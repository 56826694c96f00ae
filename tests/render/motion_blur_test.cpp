#include "bench/oracles/motion_blur_oracle.h"
#include "ecs/components/rendering.h"
#include "render/graph/frame_graph.h"
#include "tests/near.h"
#include "tests/render/shutter_fixture.h"
#include "tests/technique.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limn::test::motion_blur_test {
namespace {

bool all_finite(const gpu::FloatImage& image) {
    return std::all_of(
        image.pixels.begin(), image.pixels.end(), [](float v) { return std::isfinite(v); });
}

bool has_pass(std::string_view name) {
    return frame_graph(shared_renderer()).was_run(name);
}

}  // namespace

TEST_CASE("motion blur: the oracle's box and bar agree with each other") {
    std::vector<double> row(40, 0.0);
    std::fill(row.begin() + 12, row.begin() + 25, 1.0);
    for (const double motion : {0.0, 0.5, 3.0, 7.0, 20.0}) {
        const std::vector<double> filtered = oracle::box_filter(row, motion);
        double sum = 0;
        for (int x = 0; x < 40; ++x) {
            CAPTURE(x);
            CHECK(filtered[x] == test::near(oracle::bar_coverage(x + 0.5, 12, 25, motion)));
            sum += filtered[x];
        }
        CHECK(sum == test::near(13));
    }
    CHECK(oracle::exposure_sample_time(0, 2, 180) == test::near(-0.125));
    CHECK(oracle::exposure_sample_time(1, 2, 180) == test::near(0.125));
}

TEST_CASE_FIXTURE(
    Shutter, "motion blur: a shutter of 0 adds no pass, and the image is bit-identical") {
    bar(unlit({1, 0.5f, 0.2f}), 20, 40, 12);
    const gpu::FloatImage plain = picture();
    open(0);
    CHECK(picture().pixels == plain.pixels);
    CHECK_FALSE(has_pass("motion blur"));
    open(180);
    CHECK(picture().pixels != plain.pixels);
    CHECK(has_pass("motion blur"));
}

TEST_CASE_FIXTURE(
    Shutter, "motion blur: where nothing moves, the image is bit-identical"
                 * technique("post.motion-blur-reconstruct")) {
    bar(unlit({1, 0.5f, 0.2f}), 20, 40, 0);
    bar(unlit({0.1f, 0.7f, 0.2f}), 10, 30, 0, -0.5f);
    world.insert_resource(Environment{});
    open(360);
    CHECK(picture().pixels == sharp().pixels);
    // Nor far from what does.
    bar(unlit({1, 1, 1}), 50, 56, 4);
    const gpu::FloatImage blurred = picture();
    const gpu::FloatImage still = sharp();
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < 16; ++x) {
            CHECK(rgb_at(blurred, x, y) == rgb_at(still, x, y));
        }
    }
}

TEST_CASE_FIXTURE(Shutter, "motion blur: an image of one color keeps it with any motion") {
    const Vec3 color = {0.3f, 0.6f, 0.9f};
    world.insert_resource(Environment{.sky = SkyKind::Uniform, .zenith = color});
    const MaterialId same = unlit(color);
    bar(same, 10, 30, 9);
    bar(same, 25, 50, -14, -0.5f);
    bar(same, 5, 60, 3, -1);
    open(360, 16);
    const gpu::FloatImage blurred = picture();
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            CHECK(glm::distance(rgb_at(blurred, x, y), color) < 2e-3f);  // as albedo is stored
        }
    }
}

TEST_CASE_FIXTURE(
    Shutter,
    "motion blur: a moving plane is box filtered" * technique("post.motion-blur-reconstruct")) {
    // Bars of many widths side by side that all move alike.
    float begin = -40;
    for (int i = 0; begin < 110; ++i) {
        const float width = static_cast<float>(1 + (i * 7) % 11);
        const float gray = static_cast<float>((i * 37) % 17) / 16;
        bar(unlit({gray, 1 - gray, 0.5f}), begin, begin + width, 20);
        begin += width;
    }
    for (const float shutter : {90.0f, 180.0f, 270.0f}) {
        open(shutter);
        const gpu::FloatImage blurred = picture();
        const gpu::FloatImage plain = sharp();
        for (const int channel : {0, 1}) {
            const std::vector<double> want =
                oracle::box_filter(row_of(plain, 32, channel), 20.0 * shutter / 360);
            const std::vector<double> found = row_of(blurred, 32, channel);
            for (int x = 10; x < 54; ++x) {
                CAPTURE(x);
                CHECK(found[x] == test::near(want[x]).epsilon(2e-3));
            }
        }
    }
}

TEST_CASE_FIXTURE(
    Shutter,
    "motion blur: a bar in front of the sky covers each pixel for its part of the exposure") {
    bar(unlit({1, 1, 1}), 22, 42, 16);
    for (const float shutter : {180.0f, 360.0f}) {
        open(shutter);
        const gpu::FloatImage blurred = picture();
        const double motion = 16.0 * shutter / 360;
        for (int x = 0; x < kSize; ++x) {
            CAPTURE(x);
            const double want = oracle::bar_coverage(x + 0.5, 22, 42, motion);
            CHECK(std::abs(blurred.at(x, 32, 0) - want) < 0.07);
        }
        // Half of the smear lies outside the silhouette, on either side alike.
        CHECK(blurred.at(22 - 1, 32, 0) > 0.3);
        CHECK(blurred.at(42, 32, 0) > 0.3);
        CHECK(blurred.at(22 - static_cast<int>(motion / 2) - 1, 32, 0) == 0.0f);
        CHECK(blurred.at(42 + static_cast<int>(motion / 2), 32, 0) == 0.0f);
        CHECK(sum_of(blurred, 0) == test::near(sum_of(sharp(), 0)).epsilon(0.02));
    }
}

TEST_CASE_FIXTURE(
    Shutter, "motion blur: behind a moving bar the background reappears"
                 * technique("post.motion-blur-reconstruct")) {
    const Vec3 front = {0.9f, 0.1f, 0.1f};
    const Vec3 back = {0.1f, 0.5f, 0.9f};
    bar(unlit(back), -10, 80, 0, -1);
    bar(unlit(front), 20, 44, 12);
    open(360);
    const gpu::FloatImage blurred = picture();
    for (int x = 0; x < kSize; ++x) {
        CAPTURE(x);
        const auto coverage = static_cast<float>(oracle::bar_coverage(x + 0.5, 20, 44, 12));
        const Vec3 want = coverage * front + (1 - coverage) * back;
        CHECK(glm::distance(rgb_at(blurred, x, 32), want) < 0.09f);
    }
}

TEST_CASE_FIXTURE(
    Shutter, "motion blur: a static object in front of a moving one neither changes nor bleeds") {
    bar(unlit({0.1f, 0.2f, 0.7f}), -60, 120, 18, -2);
    bar(unlit({0.9f, 0.8f, 0.1f}), 28, 36, 0);
    open(360);
    const gpu::FloatImage blurred = picture();
    CHECK(largest_difference(blurred, sharp()) < 1e-5f);
}

TEST_CASE_FIXTURE(
    Shutter, "motion blur: objects at different depths with equal motion stay one layer") {
    bar(unlit({0, 0, 1}), -60, 120, 10, -1);
    bar(unlit({1, 0, 0}), 24, 40, 10);
    open(360);
    const gpu::FloatImage blurred = picture();
    const std::vector<double> want = oracle::box_filter(row_of(sharp(), 32, 0), 10);
    for (int x = 0; x < kSize; ++x) {
        CAPTURE(x);
        CHECK(blurred.at(x, 32, 0) == test::near(want[x]).epsilon(2e-3));
    }
}

TEST_CASE_FIXTURE(
    Shutter, "motion blur: of two crossing objects, each blurs along its own motion"
                 * technique("post.motion-blur-reconstruct")) {
    // Squares of 12 px side by side; the left one goes 16 px to the right, the other 12 px up.
    const auto move = [&](const Vec2& center, const Vec2& motion) {
        const auto pose = [](const Vec2& pixel) {
            return affine_from(
                Vec3((pixel - 0.5f * kSize) / kPerMeter, 0), {1, 0, 0, 0},
                {6 / kPerMeter, 6 / kPerMeter, 1});
        };
        const Entity entity = place(square, unlit({1, 1, 1}), pose(center));
        world.get<PreviousWorldTransform>(entity).world = pose(center - motion);
    };
    move({20, 32}, {16, 0});
    move({46, 32}, {0, 12});
    open(360);
    const gpu::FloatImage blurred = picture();
    for (int y = 16; y < 48; ++y) {
        CAPTURE(y);
        const double want = oracle::bar_coverage(y + 0.5, 26, 38, 12);
        CHECK(std::abs(blurred.at(46, y, 0) - want) < 0.12);
    }
    for (int x = 4; x < 36; ++x) {
        CAPTURE(x);
        const double want = oracle::bar_coverage(x + 0.5, 14, 26, 16);
        CHECK(std::abs(blurred.at(x, 32, 0) - want) < 0.12);
    }
}

TEST_CASE_FIXTURE(Shutter, "motion blur: the sky blurs when the camera turns") {
    world.insert_resource(Environment{
        .sky = SkyKind::Gradient,
        .zenith = {0, 0, 4},
        .horizon = {1, 1, 0},
        .ground = {0.5f, 0, 0}});
    // About x: the horizon runs through the image.
    const auto pose = [](double moment) {
        return affine_from(
            {0, 0, 0}, glm::angleAxis(0.2f * static_cast<float>(moment), Vec3(1, 0, 0)), Vec3(1));
    };
    const auto view = [&](double moment) {
        return make_render_view(
            {.fov_y = radians(90.0f)}, pose(moment), pose(moment - 1),
            {.width = kSize, .height = kSize});
    };
    oracle::MeanImage mean;
    for (int i = 0; i < 64; ++i) {
        mean.add(radiance(view(oracle::exposure_sample_time(i, 64, 360))));
    }
    const gpu::FloatImage truth = mean.mean();
    const gpu::FloatImage plain = radiance(view(0));
    open(360);
    const gpu::FloatImage blurred = radiance(view(0));
    const auto error = [&](const gpu::FloatImage& image) {
        double sum = 0;
        for (int y = 8; y < kSize - 8; ++y) {
            sum += std::abs(image.at(32, y, 2) - truth.at(32, y, 2));
        }
        return sum;
    };
    CHECK(error(plain) > 1);
    CHECK(error(blurred) < 0.25 * error(plain));
}

TEST_CASE_FIXTURE(Shutter, "motion blur: no blur is longer than the maximum") {
    bar(unlit({1, 1, 1}), 30, 34, 400);
    open(360, 64, 0.25f);
    const gpu::FloatImage blurred = picture();
    for (int x = 0; x < kSize; ++x) {
        CAPTURE(x);
        if (x < 30 - 8 || x >= 34 + 8) {
            CHECK(blurred.at(x, 32, 0) == 0.0f);
        }
    }
    CHECK(blurred.at(24, 32, 0) > 0.1f);
    CHECK(sum_of(blurred, 0) == test::near(sum_of(sharp(), 0)).epsilon(0.05));
}

TEST_CASE_FIXTURE(Shutter, "motion blur: NaN motion is no motion") {
    const Entity broken = bar(unlit({1, 0.5f, 0.25f}), 20, 44, 0);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float bad : {nan, std::numeric_limits<float>::infinity(), 1e30f}) {
        world.get<PreviousWorldTransform>(broken).world.row[0] = {bad, bad, bad, bad};
        open(360);
        CHECK(all_finite(picture()));
    }
    world.get<PreviousWorldTransform>(broken).world.row[0] = {nan, nan, nan, nan};
    CHECK(picture().pixels == sharp().pixels);
}

TEST_CASE_FIXTURE(Shutter, "motion blur: a point that was behind the camera blurs within bounds") {
    const Entity flown = bar(unlit({1, 1, 1}), 20, 44, 0);
    world.get<PreviousWorldTransform>(flown).world = at({0, 0, 3});
    world.insert_resource(Environment{});
    open(1440, 16);
    CHECK(all_finite(picture()));
}

TEST_CASE_FIXTURE(Shutter, "motion blur: it works in an image 16384 pixels wide") {
    bar(unlit({1, 1, 1}), -60, 120, 30);
    open(360, 16);
    const gpu::FloatImage wide = radiance(front(16384, 4));
    CHECK(wide.width == 16384);
    CHECK(all_finite(wide));
    CHECK(wide.at(8192, 2, 0) == test::near(1));
}

TEST_CASE_FIXTURE(Shutter, "motion blur: the same frame twice is bit-identical") {
    bar(unlit({1, 0.4f, 0.1f}), 20, 40, 21);
    bar(unlit({0.2f, 0.4f, 1}), 30, 60, -17, -1);
    open(360, 6);
    const gpu::FloatImage once = picture();
    CHECK(picture().pixels == once.pixels);
}

TEST_CASE_FIXTURE(Shutter, "motion blur: forward-shaded surfaces blur alike") {
    bar(unlit({1, 0.4f, 0.1f}), 20, 40, 14);
    bar(unlit({0.2f, 0.4f, 1}), 30, 60, -9, -1);
    open(360);
    const gpu::FloatImage deferred = picture();
    for (const LightMethod method : {LightMethod::ObjectMajor, LightMethod::LightMajor}) {
        world.insert_resource(Rendering{.lights = method});
        CHECK(largest_difference(picture(), deferred) < 2e-3f);  // as albedo is stored
    }
}

}  // namespace limn::test::motion_blur_test
