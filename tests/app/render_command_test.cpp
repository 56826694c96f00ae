#include "tests/app/read_image.h"
#include "tests/app/run_program.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <thread>

namespace limn::render_command_test {

using test::count_lines;
using test::Picture;
using test::Program;
using test::ProgramRun;
using test::read_image;
using test::run_limn;
using test::TemporaryFolder;

namespace {

using Words = std::vector<std::string>;

/// Small and quick, so that a test renders many.
Words render_words(const Words& more) {
    Words words = {"render", "lights", "--size", "64x36", "--spp", "1"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

void check_ok(const ProgramRun& run) {
    CAPTURE(run.err);
    CHECK(run.exit_code == 0);
}

double mean(const Picture& picture) {
    double sum = 0.0;
    for (const float value : picture.values) {
        sum += static_cast<double>(value);
    }
    return sum / static_cast<double>(std::max(picture.values.size(), std::size_t{1}));
}

}  // namespace

TEST_CASE("render_command: a PNG has the requested size and is not uniform") {
    const TemporaryFolder folder;
    check_ok(run_limn(folder, render_words({"-o", "a.png"})));
    const Picture picture = read_image(folder.file("a.png"));
    REQUIRE(picture.whole);
    CHECK(picture.width == 64);
    CHECK(picture.height == 36);
    const auto [least, most] = std::minmax_element(picture.values.begin(), picture.values.end());
    CHECK(*most - *least > 0.3f);
}

TEST_CASE("render_command: an EXR holds linear radiance and every requested layer by name") {
    const TemporaryFolder folder;
    check_ok(run_limn(
        folder, render_words({"-o", "a.exr", "--aov", "depth,normal,albedo,velocity,emission"})));
    const Picture picture = read_image(folder.file("a.exr"));
    REQUIRE(picture.whole);
    for (const char* name :
         {"R", "G", "B", "depth.Z", "normal.X", "normal.Y", "normal.Z", "albedo.R", "velocity.X",
          "velocity.Y", "emission.B"}) {
        CAPTURE(name);
        CHECK(picture.channel(name) >= 0);
    }
    // Normals are unit vectors where there is a surface and zero where there is none.
    const std::size_t stride = picture.channels.size();
    const std::size_t x = static_cast<std::size_t>(picture.channel("normal.X"));
    const std::size_t y = static_cast<std::size_t>(picture.channel("normal.Y"));
    const std::size_t z = static_cast<std::size_t>(picture.channel("normal.Z"));
    int surfaces = 0;
    for (std::size_t i = 0; i < picture.values.size(); i += stride) {
        const float* texel = picture.values.data() + i;
        const float length =
            std::sqrt(texel[x] * texel[x] + texel[y] * texel[y] + texel[z] * texel[z]);
        surfaces += length > 0.5f ? 1 : 0;
        CHECK((length < 1e-6f || std::abs(length - 1.0f) < 0.01f));
    }
    CHECK(surfaces > 100);
}

TEST_CASE("render_command: the EXR of a matte plane under a point light is the closed form") {
    // A camera 4 m above the plane looks straight down, its image's top toward -z; the light
    // hangs off its axis. Radiance = albedo / pi * intensity * cos / d^2.
    const TemporaryFolder folder;
    test::write_text(folder.file("plane.level.json"), R"json({
      "resources": {"environment": {"sky": "uniform", "zenith": [0, 0, 0]}},
      "meshes": {"plane": {"make": "plane", "size": [40, 40]}},
      "materials": {"matte": {"shading": "blinn", "base_color": [0.5, 0.25, 0.125, 1], "specular": [0, 0, 0]}},
      "entities": [
        {"transform": {}, "mesh_instance": {"mesh": "plane", "material": "matte"}},
        {"transform": {"position": [0.5, 2, -0.3]},
         "point_light": {"color": [1, 1, 1], "intensity": 100, "radius": 0}},
        {"transform": {"position": [0, 4, 0], "rotation": [0, -90, 0]}, "camera": {"fov_y": 1.0}}
      ]
    })json");
    constexpr int kWidth = 64;
    constexpr int kHeight = 36;
    check_ok(run_limn(
        folder, {"render", "plane.level.json", "-o", "a.exr", "--size", "64x36", "--spp", "1",
                 "--aov", "depth,normal,albedo"}));
    const Picture picture = read_image(folder.file("a.exr"));
    REQUIRE(picture.whole);
    REQUIRE(picture.width == kWidth);
    REQUIRE(picture.height == kHeight);

    const double half_height = 4.0 * std::tan(0.5);  // of what the image shows [m]
    double worst = 0;
    for (int row = 0; row < kHeight; ++row) {
        for (int column = 0; column < kWidth; ++column) {
            const std::size_t pixel = static_cast<std::size_t>(row) * kWidth + column;
            const auto value = [&](const char* channel) {
                return static_cast<double>(
                    picture.values
                        [pixel * picture.channels.size()
                         + static_cast<std::size_t>(picture.channel(channel))]);
            };
            const double x =
                (2.0 * (column + 0.5) / kHeight - double(kWidth) / kHeight) * half_height;
            const double z = (2.0 * (row + 0.5) / kHeight - 1.0) * half_height;
            const double d2 = (x - 0.5) * (x - 0.5) + 4.0 + (z + 0.3) * (z + 0.3);
            const double irradiance = 100.0 / d2 * (2.0 / std::sqrt(d2));
            const double red = 0.5 / 3.14159265358979 * irradiance;
            worst = std::max(worst, std::abs(value("R") / red - 1.0));
            worst = std::max(worst, std::abs(value("G") / (0.5 * red) - 1.0));
            worst = std::max(worst, std::abs(value("B") / (0.25 * red) - 1.0));
            worst = std::max(worst, std::abs(value("depth.Z") / 4.0 - 1.0));
            worst = std::max(worst, std::abs(value("normal.Y") - 1.0));
        }
    }
    INFO("largest relative error " << worst);
    CHECK(worst <= 1e-3);
}

TEST_CASE("render_command: the same command gives the same bytes") {
    const TemporaryFolder folder;
    check_ok(run_limn(folder, render_words({"-o", "a.exr", "--time", "0.5"})));
    check_ok(run_limn(folder, render_words({"-o", "b.exr", "--time", "0.5"})));
    const std::string a = test::read_text(folder.file("a.exr"));
    CHECK(a.size() > 1000);
    CHECK(a == test::read_text(folder.file("b.exr")));
}

TEST_CASE("render_command: --set and --time change the image") {
    const TemporaryFolder folder;
    check_ok(run_limn(folder, render_words({"-o", "a.png"})));
    check_ok(run_limn(folder, render_words({"-o", "dark.png", "--set", "exposure.ev=-3"})));
    check_ok(run_limn(folder, render_words({"-o", "later.png", "--time", "3"})));
    const double usual = mean(read_image(folder.file("a.png")));
    CHECK(mean(read_image(folder.file("dark.png"))) < 0.7 * usual);
    CHECK(test::read_text(folder.file("later.png")) != test::read_text(folder.file("a.png")));
}

TEST_CASE("render_command: --average chooses the mean; EXR and --spp have that of the light") {
    const TemporaryFolder folder;
    const auto file = [&](const char* name, const Words& more) {
        Words words = {"render", "lights", "--size", "64x36", "--set", "exposure.ev=5", "-o", name};
        words.insert(words.end(), more.begin(), more.end());
        check_ok(run_limn(folder, words));
        return test::read_text(folder.file(name));
    };
    const std::string usual = file("usual.png", {});
    CHECK(file("displayed.png", {"--average", "displayed"}) == usual);
    CHECK(file("light.png", {"--average", "light"}) != usual);
    const std::string light = file("light.exr", {"--average", "light"});
    CHECK(file("light.exr", {}) == light);
    CHECK(file("light.exr", {"--average", "displayed"}) != light);
    const std::string sampled = file("sampled.png", {"--spp", "4"});
    CHECK(file("sampled.png", {"--spp", "4", "--average", "light"}) == sampled);
    const ProgramRun wrong =
        run_limn(folder, {"render", "lights", "-o", "x.png", "--average", "median"});
    CHECK(wrong.exit_code == 2);
    CHECK(wrong.err.find("found \"median\", expected light or displayed") != std::string::npos);
}

TEST_CASE("render_command: --show renders a technique at its time, and --off without it") {
    const TemporaryFolder folder;
    const std::vector<std::string> show = {"render", "--show", "anim.euler",
                                           "--size", "96x54",  "-o"};
    const auto render = [&](std::vector<std::string> words, const char* file) {
        words.emplace_back(file);
        return words;
    };
    check_ok(run_limn(folder, render(show, "on.png")));
    std::vector<std::string> off = render(show, "off.png");
    off.emplace_back("--off");
    check_ok(run_limn(folder, off));
    std::vector<std::string> timed = render(show, "timed.png");
    timed.insert(timed.end(), {"--time", "1.5"});
    check_ok(run_limn(folder, timed));
    const std::string on = test::read_text(folder.file("on.png"));
    CHECK(on == test::read_text(folder.file("timed.png")));
    CHECK(on != test::read_text(folder.file("off.png")));
}

TEST_CASE("render_command: a range writes one numbered file per frame, the same as single images") {
    const TemporaryFolder folder;
    check_ok(
        run_limn(folder, render_words({"-o", "f_%03d.png", "--frames", "2:4", "--fps", "30"})));
    for (const char* name : {"f_002.png", "f_003.png", "f_004.png"}) {
        CHECK(read_image(folder.file(name)).whole);
    }
    CHECK_FALSE(std::filesystem::exists(folder.file("f_001.png")));
    CHECK_FALSE(std::filesystem::exists(folder.file("f_005.png")));
    check_ok(run_limn(folder, render_words({"-o", "single.png", "--time", "0.1"})));
    CHECK(test::read_text(folder.file("f_003.png")) == test::read_text(folder.file("single.png")));
}

TEST_CASE("render_command: on failure it exits with 1, one line and no file") {
    const TemporaryFolder folder;
    const std::vector<std::pair<Words, const char*>> cases = {
        {{"-o", "a.png", "--camera", "nobody"}, "nobody"},
        {{"-o", "a.png", "--set", "exposure.evv=1"}, "evv"},
        {{"-o", "a.png", "--set", "exposure.ev=1000"}, "1000"},
        {{"-o", "a.png", "--set", "no_such_entity.transform.position=1"}, "no_such_entity"},
        {{"-o", "missing/a.png"}, "missing"},
        {{"-o", "/proc/a.png"}, "/proc/a.png"}};
    for (const auto& [words, says] : cases) {
        const ProgramRun run = run_limn(folder, render_words(words));
        CAPTURE(run.err);
        CHECK(run.exit_code == 1);
        CHECK(count_lines(run.err) == 1);
        CHECK(run.err.find(says) != std::string::npos);
        CHECK_FALSE(std::filesystem::exists(folder.file("a.png")));
    }
}

TEST_CASE("render_command: killed at any time, it leaves only complete files") {
    const TemporaryFolder folder;
    int pictures = 0;
    unsigned state = 12345;  // of a small generator: the moments differ, the test repeats itself
    for (int round = 0; round < 5; ++round) {
        Program program(folder, render_words({"-o", "frame_%04d.png", "--frames", "0:99"}));
        // Wait for the first files so that the kill falls among writes, not into the start.
        for (int i = 0; i < 3000 && program.running(); ++i) {
            if (std::filesystem::exists(folder.file("frame_0001.png"))) {
                break;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        state = state * 1664525u + 1013904223u;
        std::this_thread::sleep_for(std::chrono::microseconds(state % 60000u));
        program.kill(SIGKILL);
        program.wait();
        for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
            const std::string name = entry.path().filename().string();
            if (name == "stdout.txt" || name == "stderr.txt") {
                continue;
            }
            CAPTURE(name);
            CHECK(name.starts_with("frame_"));
            CHECK(read_image(entry.path().string()).whole);
            std::filesystem::remove(entry.path());
            ++pictures;
        }
    }
    CHECK(pictures >= 5);
}

TEST_CASE("render_command: bench writes JSON and CSV with a line per pass") {
    const TemporaryFolder folder;
    const ProgramRun run = run_limn(
        folder, {"bench", "gallery", "--frames", "3", "--warmup", "1", "--size", "64x36", "--json",
                 "b.json", "--csv", "b.csv"});
    check_ok(run);
    CHECK(run.out.find("median") != std::string::npos);
    const std::string json = test::read_text(folder.file("b.json"));
    CHECK(json.find("\"passes\"") != std::string::npos);
    CHECK(json.find("\"systems\"") != std::string::npos);
    CHECK(json.find("\"resident_begin_mib\"") != std::string::npos);
    CHECK(count_lines(test::read_text(folder.file("b.csv"))) > 5);
}

TEST_CASE("render_command: compare finds an image equal to itself") {
    const TemporaryFolder folder;
    check_ok(run_limn(folder, render_words({"-o", "a.png"})));
    check_ok(run_limn(folder, render_words({"-o", "b.png", "--set", "exposure.ev=1"})));
    const ProgramRun same = run_limn(folder, {"compare", "a.png", "a.png"});
    check_ok(same);
    CHECK(same.out.find("inf") != std::string::npos);
    const ProgramRun other =
        run_limn(folder, {"compare", "a.png", "b.png", "--json", "--diff", "d.png"});
    check_ok(other);
    CHECK(other.out.find("\"psnr\"") != std::string::npos);
    CHECK(read_image(folder.file("d.png")).whole);
}

}  // namespace limn::render_command_test
