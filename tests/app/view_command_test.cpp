#include "bench/oracles/tone_oracle.h"
#include "content/load/files/exr_file.h"
#include "content/load/files/png_file.h"
#include "tests/app/virtual_display.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

// `limn view`: images of known light, their PNG against the formula, and the window.

namespace limn::view_command_test {

using test::ProgramRun;
using test::run_limn;
using test::TemporaryFolder;

namespace {

constexpr int kWidth = 96;
constexpr int kHeight = 64;

/// Ten thousand to one in three tints, left to right.
std::vector<glm::vec3> make_ramp() {
    std::vector<glm::vec3> pixels;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const float level = std::pow(10.0f, 4.0f * static_cast<float>(x) / (kWidth - 1) - 3.0f);
            const float tint = static_cast<float>(y) / kHeight;
            pixels.emplace_back(level, level * (1 - 0.5f * tint), level * (1 - 0.9f * tint));
        }
    }
    return pixels;
}

void write_picture_exr(const std::string& path, const std::vector<glm::vec3>& pixels) {
    ExrImage image{.width = kWidth, .height = kHeight};
    std::vector<float> values;
    for (const glm::vec3& pixel : pixels) {
        values.insert(values.end(), {pixel.x, pixel.y, pixel.z});
    }
    add_layer(image, "", "RGB", values, false);
    REQUIRE(write_exr(path, image).ok());
}

/// The written PNG, RGBA or RGB, as RGB.
test::Pixels shown(const TemporaryFolder& folder, std::vector<std::string> options) {
    options.insert(options.begin(), {"view", "a.exr", "-o", "a.png"});
    const ProgramRun run = run_limn(folder, options);
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
    return test::read_png(folder.file("a.png"));
}

double clipped(const test::Pixels& picture) {
    int count = 0;
    for (std::size_t i = 0; i < picture.bytes.size(); i += 3) {
        count += *std::max_element(&picture.bytes[i], &picture.bytes[i] + 3) == 255 ? 1 : 0;
    }
    return 3.0 * count / static_cast<double>(picture.bytes.size());
}

}  // namespace

TEST_CASE(
    "view: an EXR is shown as a PNG with --average light is drawn, unless options say otherwise") {
    const TemporaryFolder folder;
    test::write_text(folder.file("ball.level.json"), R"({
        "resources": {"environment": {"sky": "gradient"}, "exposure": {"ev": -1.5, "curve": "neutral"}},
        "meshes": {"ball": {"make": "sphere", "segments": 24, "rings": 12}},
        "entities": [{"mesh_instance": {"mesh": "ball"}}]})");
    for (const char* file : {"a.exr", "direct.png"}) {
        const ProgramRun run = run_limn(
            folder,
            {"render", "ball.level.json", "-o", file, "--size", "64x36", "--average", "light"});
        CAPTURE(run.err);
        REQUIRE(run.exit_code == 0);
    }
    const test::Pixels direct = test::read_png(folder.file("direct.png"));
    CHECK(shown(folder, {}) == direct);
    CHECK_FALSE(shown(folder, {"--curve", "knee"}) == direct);
    CHECK_FALSE(shown(folder, {"--ev", "0"}) == direct);
}

TEST_CASE("view: an image of 8 bits is shown unchanged") {
    const TemporaryFolder folder;
    std::vector<std::uint8_t> codes;
    for (int i = 0; i < 256; ++i) {
        codes.insert(
            codes.end(), {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(255 - i),
                          static_cast<std::uint8_t>(i / 2)});
    }
    REQUIRE(write_png(folder.file("codes.png"), 64, 4, 3, codes).ok());
    const ProgramRun run = run_limn(folder, {"view", "codes.png", "-o", "a.png"});
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
    CHECK(test::read_png(folder.file("a.png")).bytes == codes);
}

TEST_CASE(
    "view: every pixel of the PNG matches the formula to one code value"
    * technique("hdr.viewer")) {
    const TemporaryFolder folder;
    const std::vector<glm::vec3> pixels = make_ramp();
    write_picture_exr(folder.file("a.exr"), pixels);
    glm::dvec3 mean(0);
    for (const glm::vec3& pixel : pixels) {
        mean += glm::dvec3(pixel) / static_cast<double>(pixels.size());
    }
    struct Setting {
        double ev;
        double defog;
        double contrast;
        double gamma;
    };
    for (const Setting& s : {Setting{0, 0, 0, 2.2}, Setting{2.5, 0.01, 0.7, 2.8}}) {
        const test::Pixels picture = shown(
            folder, {"--ev", std::to_string(s.ev), "--defog", std::to_string(s.defog), "--contrast",
                     std::to_string(s.contrast), "--gamma", std::to_string(s.gamma)});
        REQUIRE(picture.width == kWidth);
        REQUIRE(picture.height == kHeight);
        int wrong = 0;
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            for (int c = 0; c < 3; ++c) {
                const double want = oracle::knee_map(
                    pixels[i][c], s.defog * mean[c],
                    {.exposure = std::exp2(s.ev), .contrast = s.contrast, .exponent = 1 / s.gamma});
                const double code = std::round(255 * std::min(want, 1.0));
                wrong += std::abs(picture.bytes[3 * i + c] - code) > 1 ? 1 : 0;
            }
        }
        CHECK(wrong == 0);
    }
}

TEST_CASE(
    "view: more exposure clips more, and defog with contrast clips less again"
    * technique("hdr.viewer")) {
    const TemporaryFolder folder;
    write_picture_exr(folder.file("a.exr"), make_ramp());
    const double low = clipped(shown(folder, {"--ev", "0"}));
    const double high = clipped(shown(folder, {"--ev", "5"}));
    const double tamed =
        clipped(shown(folder, {"--ev", "5", "--defog", "0.01", "--contrast", "1"}));
    CHECK(low < high);
    CHECK(tamed < high);
    // The same settings give the same image.
    CHECK(shown(folder, {"--ev", "5"}) == shown(folder, {"--ev", "5"}));
    CHECK(shown(folder, {"--curve", "local"}) != shown(folder, {"--curve", "reinhard"}));
}

TEST_CASE("view: it prints statistics, and counts NaN" * technique("hdr.viewer")) {
    const TemporaryFolder folder;
    std::vector<glm::vec3> pixels(kWidth * kHeight, glm::vec3(0.5f));
    pixels[0] = glm::vec3(0.01f);
    pixels[1] = glm::vec3(1000.0f);
    write_picture_exr(folder.file("a.exr"), pixels);
    ProgramRun run = run_limn(folder, {"view", "a.exr", "-o", "a.png"});
    CHECK(run.exit_code == 0);
    CHECK(run.out.find("96 x 64") != std::string::npos);
    CHECK(run.out.find("1e+05:1") != std::string::npos);
    CHECK(run.out.find("NaN") == std::string::npos);

    pixels[5].y = std::numeric_limits<float>::quiet_NaN();
    pixels[6].x = std::numeric_limits<float>::infinity();
    write_picture_exr(folder.file("a.exr"), pixels);
    run = run_limn(folder, {"view", "a.exr", "-o", "a.png", "--dither", "false"});
    CHECK(run.exit_code == 0);
    CHECK(run.out.find("2 of 6144 pixels hold NaN or infinity") != std::string::npos);
    CHECK(run.out.find("1e+05:1") != std::string::npos);  // the numbers are those of the others
    const test::Pixels picture = test::read_png(folder.file("a.png"));
    CHECK(picture.bytes[3 * 5 + 1] == 0);
    CHECK(picture.bytes[3 * 6] == 255);
    CHECK(picture.bytes[3 * 7] == picture.bytes[3 * 8]);
}

TEST_CASE("view: for a file that is not an image it exits with 1 and one line") {
    const TemporaryFolder folder;
    write_picture_exr(folder.file("a.exr"), make_ramp());
    static_cast<void>(shown(folder, {}));
    const std::string whole = test::read_text(folder.file("a.exr"));
    test::write_text(folder.file("half.exr"), whole.substr(0, whole.size() / 2));
    test::write_text(folder.file("words.exr"), "no light in here");
    for (const char* file : {"half.exr", "words.exr", "missing.exr"}) {
        const ProgramRun run = run_limn(folder, {"view", file, "-o", "b.png"});
        CAPTURE(file);
        CHECK(run.exit_code == 1);
        CHECK(run.err.find(file) != std::string::npos);
        CHECK(test::count_lines(run.err) == 1);
        CHECK(test::read_text(folder.file("b.png")).empty());
    }
}

TEST_CASE(
    "view: in the window a key and its opposite restore the same image" * technique("hdr.viewer")) {
    if (!test::can_play()) {
        return;
    }
    test::DisplaySession session;
    write_picture_exr(session.folder.file("a.exr"), make_ramp());
    session.start({"view", "a.exr", "--ev", "2"});
    test::xdotool("key F2");  // the panel, whose numbers change
    const auto brightness = [](const test::Pixels& image) {
        return std::accumulate(image.bytes.begin(), image.bytes.end(), std::int64_t{0});
    };
    const test::Pixels first = session.wait_until_still();
    test::xdotool("key Up");
    REQUIRE(session.changes_from(first, 5000));
    CHECK(brightness(session.wait_until_still()) > brightness(first));
    test::xdotool("key Down");
    CHECK(session.wait_until_still() == first);
    test::xdotool("key Down");
    REQUIRE(session.changes_from(first, 5000));
    CHECK(brightness(session.wait_until_still()) < brightness(first));
    test::xdotool("key Up");
    CHECK(session.wait_until_still() == first);
    test::xdotool("key c");
    CHECK(session.changes_from(first, 5000));
    test::xdotool("key r");
    CHECK(session.wait_until_still() == first);
    test::xdotool("key Escape");
    CHECK(test::wait_for([&] { return !session.program->running(); }));
    CHECK(session.program->wait().exit_code == 0);
}

}  // namespace limn::view_command_test
