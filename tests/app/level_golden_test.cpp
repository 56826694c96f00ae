// Every level: loads, runs for a second without a logged error, repeats bit for bit, and looks like
// the image in tests/golden that we last agreed is right. `limn` draws software and GPU images
// with other roundings, so the comparison is FLIP's, not equality. The target `golden` draws them
// anew.

#include "content/app/headless.h"
#include "content/app/stage.h"
#include "content/bake/image_compare.h"
#include "content/load/image_load.h"
#include "content/load/level_list.h"
#include "content/load/made_assets.h"
#include "content/load/png_file.h"
#include "ecs/base/log.h"
#include "ecs/components/shadow.h"
#include "ecs/components/surface.h"
#include "ecs/snapshot.h"
#include "render/gpu/readback.h"
#include "render/render_view.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace limn {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 180;
constexpr int kSamples = 4;
constexpr int kSteps = 60;

HeadlessRenderer& shared_renderer() {
    static HeadlessRenderer shared = [] {
        Result<HeadlessRenderer> made = create_headless_renderer();
        if (!made) {
            std::fprintf(stderr, "%s\n", made.error().message.c_str());
            std::exit(1);
        }
        return *std::move(made);
    }();
    return shared;
}

/// Meshes and images that levels make, which the test cases share.
MadeAssets& shared_assets() {
    static MadeAssets shared;
    return shared;
}

gpu::ByteImage draw_level(Stage& stage) {
    const RenderView view =
        make_render_view(stage.world, stage.scene.camera, {.width = kWidth, .height = kHeight});
    const FrameOutput frame =
        render_accumulated(*shared_renderer().renderer, stage.world, view, kSamples);
    return gpu::read_bytes(*frame.display);
}

ColorImage color_image(int width, int height, int channels, const std::uint8_t* bytes) {
    ColorImage image{width, height, {}};
    for (int i = 0; i < width * height; ++i) {
        const std::uint8_t* pixel = bytes + static_cast<std::ptrdiff_t>(i) * channels;
        image.pixels.push_back(Vec3(pixel[0], pixel[1], pixel[2]) / 255.0f);
    }
    return image;
}

void write_image_file(const std::string& path, const gpu::ByteImage& image) {
    const Status written = write_png(path, image.width, image.height, image.channels, image.pixels);
    CHECK_MESSAGE(written.ok(), (written ? std::string() : written.error().message));
}

/// What is left behind of a mismatch: the image as it is now, and where it differs.
void leave_mismatch(
    const std::string& name, const gpu::ByteImage& drawn, const std::vector<float>& errors) {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "limn-golden";
    std::filesystem::create_directories(folder);
    write_image_file((folder / (name + ".png")).string(), drawn);
    gpu::ByteImage difference{drawn.width, drawn.height, 1, {}};
    for (const float error : errors) {
        difference.pixels.push_back(static_cast<std::uint8_t>(255.0f * std::min(error, 1.0f)));
    }
    write_image_file((folder / (name + ".difference.png")).string(), difference);
    MESSAGE("the new picture and the difference are in " << folder.string());
}

}  // namespace

TEST_CASE("level: every level runs for a second without an error and looks as agreed") {
    const bool update = std::getenv("LIMN_UPDATE_GOLDEN") != nullptr;
    const std::vector<LevelEntry> levels = list_levels();
    REQUIRE(levels.size() >= 2);
    for (const LevelEntry& level : levels) {
        CAPTURE(level.name);
        const std::uint64_t errors_before = logged_error_count();
        Result<std::unique_ptr<Stage>> stage = open_stage(level.path, {.made = &shared_assets()});
        REQUIRE_MESSAGE(stage.ok(), (stage ? std::string() : stage.error().message));
        for (int i = 0; i < kSteps; ++i) {
            step_stage(**stage);
        }
        CHECK(logged_error_count() == errors_before);

        const gpu::ByteImage drawn = draw_level(**stage);
        const std::string golden_path =
            std::string(LIMN_SOURCE_DIR) + "/tests/golden/" + level.name + ".png";
        if (update) {
            write_image_file(golden_path, drawn);
            continue;
        }
        const Result<ImageData> golden = load_image(golden_path, true);
        REQUIRE_MESSAGE(golden.ok(), (golden ? std::string() : golden.error().message));
        REQUIRE(golden->width == kWidth);
        REQUIRE(golden->height == kHeight);
        const ColorImage expected = color_image(kWidth, kHeight, 4, golden->pixels.data());
        const ColorImage found = color_image(kWidth, kHeight, drawn.channels, drawn.pixels.data());
        const std::vector<float> errors = flip_map(expected, found);
        const ErrorSummary summary = summarize_errors(errors);
        CHECK(summary.mean <= 0.01);
        CHECK(summary.p99 <= 0.1);
        if (summary.mean > 0.01 || summary.p99 > 0.1) {
            leave_mismatch(level.name, drawn, errors);
        }
    }
}

TEST_CASE("level: the cloister has shadows of every method, and no light is refused its own") {
    Result<std::unique_ptr<Stage>> stage = open_stage("cloister");
    REQUIRE(stage.ok());
    step_stage(**stage);
    int lights[5] = {};
    std::as_const((*stage)->world).query<const Shadow>().each([&](const Shadow& shadow) {
        ++lights[static_cast<std::size_t>(shadow.method)];
    });
    CHECK(lights[static_cast<std::size_t>(ShadowMethod::Map)] >= 2);
    CHECK(lights[static_cast<std::size_t>(ShadowMethod::Volume)] >= 2);
    CHECK(lights[static_cast<std::size_t>(ShadowMethod::Hybrid)] >= 2);
    // Casters that are not closed, or an atlas that is full, would be told.
    static int warnings;
    warnings = 0;
    set_log_sink([](LogLevel, std::string_view) { ++warnings; });
    const RenderView view =
        make_render_view((*stage)->world, (*stage)->scene.camera, {.width = 64, .height = 36});
    render_frame(*shared_renderer().renderer, (*stage)->world, view);
    // What stays where it is has been drawn once and for all; the cages turn, but no map sees them.
    step_stage(**stage);
    const FrameOutput next = render_frame(*shared_renderer().renderer, (*stage)->world, view);
    set_log_sink(nullptr);
    CHECK(warnings == 0);
    CHECK(next.statistics.shadow_views >= 14 * 6);
    CHECK(next.statistics.shadow_views_drawn == 0);
}

TEST_CASE("level: the same level runs to the same state twice") {
    for (const LevelEntry& level : list_levels()) {
        CAPTURE(level.name);
        std::uint64_t hashes[2] = {};
        for (std::uint64_t& hash : hashes) {
            Result<std::unique_ptr<Stage>> stage =
                open_stage(level.path, {.made = &shared_assets()});
            REQUIRE(stage.ok());
            for (int i = 0; i < 10; ++i) {
                step_stage(**stage);
            }
            hash = state_hash((*stage)->world);
        }
        CHECK(hashes[0] == hashes[1]);
    }
}

}  // namespace limn
