#include "content/app/commands/exposure_samples.h"
#include "tests/app/read_image.h"
#include "tests/app/run_program.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace limn::render_sampled_test {

using test::Picture;
using test::read_image;
using test::run_limn;
using test::TemporaryFolder;

namespace {

constexpr int kWidth = 96;
constexpr int kHeight = 54;

/// A bright unlit square on black before a camera at z = 2 whose image is 2 m high at z = 0:
/// 27 px a meter.
std::string
level(const std::string& resources, const std::string& square, const std::string& camera) {
    return R"json({
      "resources": {"environment": {"sky": "uniform", "zenith": [0, 0, 0]})json"
           + resources + R"json(},
      "meshes": {"square": {"make": "box", "size": [0.5, 0.5, 0.001]}},
      "materials": {"white": {"shading": "unlit", "base_color": [1, 1, 1, 1]}},
      "entities": [
        {"name": "square", "mesh_instance": {"mesh": "square", "material": "white"})json"
           + square + R"json(},
        {"name": "view", "transform": {"position": [0, 0, 2]},
         "camera": {"fov_y": 0.9272952})json"
           + camera + R"json(}
      ]
    })json";
}

Picture render(
    const TemporaryFolder& folder, const std::string& text, const std::vector<std::string>& more) {
    test::write_text(folder.file("a.level.json"), text);
    std::vector<std::string> words = {"render", "a.level.json", "-o", "a.exr", "--size", "96x54"};
    words.insert(words.end(), more.begin(), more.end());
    const auto run = run_limn(folder, words);
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
    Picture picture = read_image(folder.file("a.exr"));
    REQUIRE(picture.whole);
    return picture;
}

double red(const Picture& picture, int x, int y) {
    const std::size_t stride = picture.channels.size();
    const auto at = static_cast<std::size_t>(y * picture.width + x) * stride;
    return static_cast<double>(picture.values[at + static_cast<std::size_t>(picture.channel("R"))]);
}

double sum(const Picture& picture) {
    double total = 0;
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            total += red(picture, x, y);
        }
    }
    return total;
}

}  // namespace

TEST_CASE(
    "exposure samples: times are equally spaced around the center, a single one is at the center") {
    for (const int count : {2, 7, 64}) {
        double sum = 0;
        for (int i = 0; i < count; ++i) {
            const double moment = exposure_sample(i, count).time;
            CHECK(moment == test::near((i + 0.5) / count - 0.5));
            sum += moment;
        }
        CHECK(sum == test::near(0).scale(1).epsilon(1e-9));
    }
    const ExposureSample one = exposure_sample(0, 1);
    CHECK(one.time == 0);
    CHECK(one.jitter == Vec2(0));
    CHECK(one.square == Vec2(0.5f));
}

TEST_CASE(
    "exposure samples: every part of the exposure covers pixel and lens evenly"
    * technique("post.distributed-sampling")) {
    // Of 256 samples every quarter of the time has about 16 in each of the 4 quarters of any two
    // of the other numbers.
    constexpr int kCount = 256;
    for (int quarter = 0; quarter < 4; ++quarter) {
        int boxes[3][4] = {};
        for (int i = quarter * kCount / 4; i < (quarter + 1) * kCount / 4; ++i) {
            const ExposureSample sample = exposure_sample(i, kCount);
            const auto half = [](float x) { return x < 0.5f ? 0 : 1; };
            const Vec2 pixel = sample.jitter + 0.5f;
            CHECK((pixel.x >= 0 && pixel.x < 1 && pixel.y >= 0 && pixel.y < 1));
            CHECK((sample.square.x >= 0 && sample.square.x < 1));
            CHECK((sample.square.y >= 0 && sample.square.y < 1));
            ++boxes[0][2 * half(pixel.x) + half(pixel.y)];
            ++boxes[1][2 * half(sample.square.x) + half(sample.square.y)];
            ++boxes[2][2 * half(pixel.x) + half(sample.square.y)];
        }
        for (const auto& pair : boxes) {
            for (const int found : pair) {
                CHECK(found >= 12);
                CHECK(found <= 20);
            }
        }
    }
}

TEST_CASE(
    "render sampled: a moving edge becomes a ramp as long as its path while the shutter is open") {
    // At 0 it moves at 2.4 m/s: 64.8 px/s through the image, 180 degrees at 2 images a second
    // are a quarter of a second or 16.2 px, less than its 13.5 px of width and more.
    const TemporaryFolder folder;
    const std::string text = level(
        R"json(, "motion_blur": {"shutter": 180}, "frame_time": {"step": 0.005})json",
        R"json(, "transform": {"position": [0, 0, 0]},
           "sway": {"amplitude": [24, 0, 0], "frequency": [0.1, 1, 1], "phase": [0, 0, 0]})json",
        "");
    // The center of the path is at 1 s: 24 sin(0.1) = 2.396 m, so the camera looks there.
    const Picture blurred = render(
        folder, text,
        {"--frames", "2:2", "--fps", "2", "--spp", "256", "--set",
         "view.transform.position=[2.396,0,2]"});
    const Picture still = render(
        folder, text,
        {"--frames", "2:2", "--fps", "2", "--spp", "256", "--set", "motion_blur.shutter=0", "--set",
         "view.transform.position=[2.396,0,2]"});
    const double path = 24 * 0.1 * std::cos(0.1) * 0.25 * 27;  // [px]
    const double width = 0.5 * 27;
    const double center = 0.5 * kWidth;
    for (int x = 8; x < kWidth - 8; ++x) {
        CAPTURE(x);
        // The fraction of the time in which the pixel's center is covered.
        const double at = x + 0.5 - center;
        const double low = std::max(at - 0.5 * width, -0.5 * path);
        const double high = std::min(at + 0.5 * width, 0.5 * path);
        const double covered = std::max(high - low, 0.0) / path;
        CHECK(std::abs(red(blurred, x, kHeight / 2) - covered) < 0.05);
    }
    CHECK(sum(blurred) == test::near(sum(still)).epsilon(0.01));
    CHECK(red(still, static_cast<int>(center + 0.4 * width), kHeight / 2) == test::near(1));
    CHECK(
        red(still, static_cast<int>(center + 0.7 * width), kHeight / 2) == test::near(0).scale(1));
}

TEST_CASE(
    "render sampled: an object that moves less than its width has a ramp at each edge"
    * technique("post.distributed-sampling")) {
    // As above with half the exposure: 8.1 px of path, 13.5 px of width.
    const TemporaryFolder folder;
    const std::string text = level(
        R"json(, "motion_blur": {"shutter": 90}, "frame_time": {"step": 0.005})json",
        R"json(, "transform": {"position": [0, 0, 0]},
           "sway": {"amplitude": [24, 0, 0], "frequency": [0.1, 1, 1], "phase": [0, 0, 0]})json",
        "");
    const std::vector<std::string> words = {
        "--frames", "2:2", "--fps", "2", "--set", "view.transform.position=[2.396,0,2]", "--spp"};
    const auto with = [&](const std::string& samples) {
        std::vector<std::string> more = words;
        more.push_back(samples);
        return render(folder, text, more);
    };
    const Picture blurred = with("256");
    const double path = 24 * 0.1 * std::cos(0.1) * 0.125 * 27;  // [px]
    const double half = 0.25 * 27;
    for (int x = 8; x < kWidth - 8; ++x) {
        CAPTURE(x);
        const double from_edge = half + 0.5 * path - std::abs(x + 0.5 - 0.5 * kWidth);
        const double covered = std::clamp(from_edge / path, 0.0, 1.0);
        CHECK(std::abs(red(blurred, x, kHeight / 2) - covered) < 0.04);
    }
}

TEST_CASE(
    "render sampled: an out-of-focus small light is a disc of the circle of confusion"
    * technique("post.distributed-sampling")) {
    // f = 0.024 m / 2 behind tan(0.4636) = 0.5; the eye is 2 m away and focused at 1 m.
    const TemporaryFolder folder;
    const std::string text = level(
        "", R"json(, "transform": {"position": [0, 0, 0], "scale": [0.1, 0.1, 1]})json",
        R"json(, "lens": {"f_number": 0.125, "focus_distance": 1})json");
    const Picture picture = render(folder, text, {"--spp", "1024"});
    // Film 0.024 m high behind a field of view of 2 tan = 1: v = 0.024, 1/F = 1/v + 1.
    const double v = 0.024;
    const double focal = 1 / (1 / v + 1);
    const double diameter = focal / 0.125 * v * (1.0 - 1.0 / 2.0) / 0.024 * kHeight;
    // The second moment of a disc about its center is d^2 / 8, of the square of side a, a^2 / 6.
    double moment = 0;
    double total = 0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const double dx = x + 0.5 - 0.5 * kWidth;
            const double dy = y + 0.5 - 0.5 * kHeight;
            moment += red(picture, x, y) * (dx * dx + dy * dy);
            total += red(picture, x, y);
        }
    }
    const double side = 0.05 * 27;
    const double found = std::sqrt(8 * (moment / total - side * side / 6 - 1.0 / 6));
    CHECK(found == test::near(diameter).epsilon(0.02));
    CHECK(total == test::near(side * side).epsilon(0.02));
    // In focus it is itself again.
    const Picture sharp =
        render(folder, text, {"--spp", "64", "--set", "view.lens.focus_distance=2"});
    CHECK(red(sharp, kWidth / 2, kHeight / 2) > 0.3);
    CHECK(red(sharp, kWidth / 2 + 3, kHeight / 2) == 0);
}

TEST_CASE(
    "render sampled: more samples converge, and layers are those at the frame's time"
    * technique("post.distributed-sampling")) {
    const TemporaryFolder folder;
    const std::string text = level(
        R"json(, "motion_blur": {"shutter": 360})json",
        R"json(, "transform": {"position": [0, 0, 0]}, "spin": {"axis": [0, 0, 1], "speed": 60})json",
        R"json(, "lens": {"f_number": 0.25, "focus_distance": 1.5})json");
    const auto at = [&](const std::string& samples) {
        return render(folder, text, {"--time", "0.1", "--spp", samples, "--aov", "depth"});
    };
    const Picture truth = at("1024");
    const auto error = [&](const Picture& picture) {
        double squares = 0;
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                const double difference = red(picture, x, y) - red(truth, x, y);
                squares += difference * difference;
            }
        }
        return std::sqrt(squares / (kWidth * kHeight));
    };
    const Picture few = at("16");
    const double of_16 = error(few);
    const double of_64 = error(at("64"));
    CHECK(of_16 < 0.1);
    CHECK(of_16 / of_64 > 1.5);  // 2 by chance alone
    // Depth is no mean: 2 m where the square is at that moment.
    const auto depth = static_cast<std::size_t>(few.channel("depth.Z"));
    const std::size_t center = static_cast<std::size_t>(kHeight / 2 * kWidth + kWidth / 2);
    CHECK(few.values[center * few.channels.size() + depth] == test::near(1.9995).epsilon(1e-3));
    CHECK(few.values[depth] > 1e9f);
}

}  // namespace limn::render_sampled_test
