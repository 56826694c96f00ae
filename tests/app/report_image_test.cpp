// Inputs rebuilt from public bug reports; the right values are derived in expected.txt beside each.

#include "tests/app/read_image.h"
#include "tests/app/run_program.h"
#include "tests/near.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace limn::report_image_test {
namespace {

/// Renders a report's file with these options to `name` in `folder`, and reads it.
test::Picture render_report(
    const test::TemporaryFolder& folder, const std::string& file, const std::string& name,
    const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {"render", file, "-o", folder.file(name)};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const test::ProgramRun run = test::run_limn(folder, arguments);
    REQUIRE_MESSAGE(run.exit_code == 0, run.err);
    test::Picture image = test::read_image(folder.file(name));
    REQUIRE(image.whole);
    return image;
}

/// Pixels that are red, and the size of the box around them [px].
struct RedArea {
    int pixels = 0;
    int left = 1 << 20;
    int right = 0;
    int top = 1 << 20;
    int bottom = 0;

    [[nodiscard]] int width() const { return right - left + 1; }
    [[nodiscard]] int height() const { return bottom - top + 1; }
};

RedArea find_red(const test::Picture& image) {
    RedArea area;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const float* const rgb =
                &image.values[static_cast<std::size_t>(3 * (y * image.width + x))];
            if (rgb[0] > 0.1f && rgb[0] > 1.5f * rgb[1]) {
                ++area.pixels;
                area.left = std::min(area.left, x);
                area.right = std::max(area.right, x);
                area.top = std::min(area.top, y);
                area.bottom = std::max(area.bottom, y);
            }
        }
    }
    return area;
}

}  // namespace

TEST_CASE("reports: what a sheared square is drawn as does not depend on joints or channels") {
    const test::TemporaryFolder folder;
    std::vector<test::Picture> images;
    for (const std::string file : {"static", "animated", "skinned"}) {
        const auto path = test::shared_report("01-shear/" + file + ".gltf");
        if (!path) {
            return;
        }
        CAPTURE(file);
        images.push_back(
            render_report(folder, *path, "shear.png", {"--size", "640x480", "--camera", "front"}));
        const RedArea rhombus = find_red(images.back());
        CHECK(std::abs(rhombus.width() - 339) <= 2);
        CHECK(std::abs(rhombus.height() - 170) <= 2);
        const int box = rhombus.width() * rhombus.height();
        CHECK(std::abs(rhombus.pixels - box / 2) <= box / 100);
        CHECK(images.back().values == images.front().values);
    }
}

TEST_CASE("reports: tangents follow the uv set of the texture, whoever names it") {
    const test::TemporaryFolder folder;
    for (const auto& [file, along_y] :
         {std::pair<std::string, bool>{"set0", false}, {"plain", true}, {"override", true}}) {
        const auto path = test::shared_report("16-texcoord-override/" + file + ".gltf");
        if (!path) {
            return;
        }
        const std::string shown = file;
        CAPTURE(shown);
        const test::Picture image = render_report(
            folder, *path, "normal.exr",
            {"--size", "64x64", "--camera", "front", "--aov", "normal"});
        const int x = image.channel("normal.X");
        REQUIRE(x >= 0);
        const std::size_t channels = image.channels.size();
        const float* const center = &image.values[channels * (32 * 64 + 32)];
        const float normal[] = {
            center[x], center[image.channel("normal.Y")], center[image.channel("normal.Z")]};
        CHECK(normal[0] == test::near(along_y ? 0.0f : 0.7071f).scale(1).epsilon(0.01));
        CHECK(normal[1] == test::near(along_y ? 0.7071f : 0.0f).scale(1).epsilon(0.01));
        CHECK(normal[2] == test::near(0.7071f).scale(1).epsilon(0.01));
    }
}

TEST_CASE("reports: motion blur blurs neither what rests nor what jumps") {
    const test::TemporaryFolder folder;
    const std::string root = "29-motion-blur/";
    if (!test::shared_report(root + "still.level.json")) {
        return;
    }
    const auto draw = [&](const std::string& level, const std::string& time) {
        CAPTURE(level);
        return render_report(
            folder, *test::shared_report(root + level + ".level.json"), "blur.png",
            {"--size", "640x360", "--time", time});
    };
    for (const char* const level : {"still", "morph"}) {
        CAPTURE(level);
        for (const char* const time : {"0", "1"}) {
            CHECK(draw(level, time).values == draw(std::string(level) + "-off", time).values);
        }
    }
    // Other frames of the loop show the square nearer to the center.
    for (const auto& [level, first, last] :
         {std::tuple<std::string, int, int>{"loop", 59, 61}, {"jump", 57, 63}}) {
        const std::string shown = level;
        CAPTURE(shown);
        const test::ProgramRun run = test::run_limn(
            folder, {"render", *test::shared_report(root + level + ".level.json"), "-o",
                     folder.file("frame_%04d.png"), "--size", "640x360", "--frames",
                     std::to_string(first) + ":" + std::to_string(last)});
        REQUIRE_MESSAGE(run.exit_code == 0, run.err);
        for (int frame = first; frame <= last; ++frame) {
            CAPTURE(frame);
            const test::Picture image =
                test::read_image(folder.file("frame_00" + std::to_string(frame) + ".png"));
            REQUIRE(image.whole);
            int streak = 0;
            for (int x = 260; x <= 380; ++x) {
                const float* const rgb =
                    &image.values[static_cast<std::size_t>(3 * (180 * 640 + x))];
                streak += rgb[0] > 1.5f * rgb[1] ? 1 : 0;
            }
            CHECK(streak == 0);
            CHECK(find_red(image).pixels > 500);  // the square is in view
        }
    }
}

}  // namespace limn::report_image_test
