// Every level: loads, runs for a second without a logged error, and looks like the image in
// tests/golden that we last agreed is right. `limn` draws software and GPU images with other
// roundings, so the comparison is FLIP's, not equality. The target `golden` draws them anew. With
// the formats and definitions of a GPU it looks the same.

#include "content/app/commands/stage.h"
#include "content/bake/image_compare.h"
#include "content/load/files/image_load.h"
#include "content/load/files/png_file.h"
#include "content/load/level/level_list.h"
#include "ecs/base/log.h"
#include "ecs/components/camera.h"
#include "ecs/components/camera_path.h"
#include "ecs/components/environment.h"
#include "ecs/components/light.h"
#include "ecs/components/shadow.h"
#include "ecs/components/surface.h"
#include "render/environment/environment_light.h"
#include "render/gpu/readback.h"
#include "render/render_view.h"
#include "tests/app/level_fixture.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace limn::level_golden_test {
using test::played_levels;
using test::PlayedLevel;

namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 180;
constexpr int kSamples = 4;
constexpr double kMinPsnr = 45;  // between the profiles [dB]

/// FLIP's largest mean, and its 99th percentile, against the golden images.
struct Tolerance {
    double mean;
    double p99;
};
constexpr Tolerance kSoftware = {0.01, 0.1};
/// Hardware filters with weights of 8 bits, rounds its own mip levels and snaps vertices to 1/256
/// of a pixel: textures are up to a code or two of 255 darker, edges fall into other pixels. An
/// NVIDIA H200 has 0.037 (cistern) and 0.23 (storm).
constexpr Tolerance kHardware = {0.04, 0.25};

gpu::ByteImage draw_level(HeadlessRenderer& headless, const Stage& stage) {
    const RenderView view =
        make_render_view(stage.world, stage.scene.camera, {.width = kWidth, .height = kHeight});
    const FrameOutput frame = render_accumulated(*headless.renderer, stage.world, view, kSamples);
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

ColorImage color_image(const gpu::ByteImage& image) {
    return color_image(image.width, image.height, image.channels, image.pixels.data());
}

struct DrawnLevels {
    bool by_software = true;
    std::vector<gpu::ByteImage> images{};
};

/// Of each level.
DrawnLevels draw_levels(HeadlessRenderer& headless) {
    DrawnLevels drawn = {.by_software = headless.device->caps().software};
    for (const PlayedLevel& level : played_levels()) {
        drawn.images.push_back(draw_level(headless, *level.stage));
    }
    return drawn;
}

const DrawnLevels& software_levels() {
    static const DrawnLevels drawn = draw_levels(test::level_renderer());
    return drawn;
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
    const std::vector<PlayedLevel>& levels = played_levels();
    REQUIRE(levels.size() >= 2);
    for (std::size_t i = 0; i < levels.size(); ++i) {
        const std::string& name = levels[i].name;
        CAPTURE(name);
        CHECK_FALSE(levels[i].logged_error);
        const gpu::ByteImage& drawn = software_levels().images[i];
        const std::string golden_path =
            std::string(LIMN_SOURCE_DIR) + "/tests/golden/" + name + ".png";
        if (update) {
            write_image_file(golden_path, drawn);
            continue;
        }
        const Result<ImageData> golden = load_image(golden_path, true);
        REQUIRE_MESSAGE(golden.ok(), (golden ? std::string() : golden.error().message));
        REQUIRE(golden->width == kWidth);
        REQUIRE(golden->height == kHeight);
        const ColorImage expected = color_image(kWidth, kHeight, 4, golden->pixels.data());
        const std::vector<float> errors = flip_map(expected, color_image(drawn));
        const ErrorSummary summary = summarize_errors(errors);
        const Tolerance& most = software_levels().by_software ? kSoftware : kHardware;
        CHECK(summary.mean <= most.mean);
        CHECK(summary.p99 <= most.p99);
        if (summary.mean > most.mean || summary.p99 > most.p99) {
            leave_mismatch(name, drawn, errors);
        }
    }
}

TEST_CASE("level: every level is named and has a camera that moves or that keys move") {
    const std::vector<LevelEntry> levels = list_levels();
    for (std::size_t i = 0; i < levels.size(); ++i) {
        CAPTURE(levels[i].name);
        const Stage& stage = *played_levels()[i].stage;
        CHECK_FALSE(levels[i].title.empty());
        CHECK(stage.scene.name == levels[i].name);
        CHECK(stage.scene.title == levels[i].title);
        const bool on_a_path =
            stage.world.find<CameraPath>(stage.scene.camera) != nullptr && stage.scene.duration > 0;
        const auto* const orbit = stage.world.find<OrbitCamera>(stage.scene.camera);
        const bool after_something = orbit != nullptr && stage.world.alive(orbit->target);
        const bool placed_by_keys = levels[i].name == "phonglab";
        const bool stands_still = levels[i].name == "relax";  // to compare two times by eye
        CHECK((on_a_path || after_something || placed_by_keys || stands_still));
    }
}

TEST_CASE("level: every level looks the same with the formats and definitions of a GPU") {
    (void)software_levels();
    HeadlessRenderer gpu = test::create_level_renderer(gpu::Profile::Gpu);
    const std::vector<gpu::ByteImage> images = draw_levels(gpu).images;
    for (std::size_t i = 0; i < images.size(); ++i) {
        CAPTURE(played_levels()[i].name);
        CHECK(psnr(color_image(images[i]), color_image(software_levels().images[i])) >= kMinPsnr);
    }
}

namespace {

float luminance_of(const Vec3& color) {
    return glm::dot(color, Vec3(0.2126f, 0.7152f, 0.0722f));
}

}  // namespace

TEST_CASE("level: nowhere does the sky light what is in shadow more than hazy air does") {
    // Illuminance of the sun, perpendicular to it, : of the sky. With 20 times the particles of
    // clear air: 5.6 at 20 degrees, 6.1 at 35.
    constexpr float kHaze = 5.5f;
    constexpr float kSun = 2;  // [lx]: moons and lightning are darker
    int suns = 0;
    int gradients = 0;
    for (const PlayedLevel& level : played_levels()) {
        CAPTURE(level.name);
        const World& world = level.stage->world;
        const auto* const sky = world.find_resource<Environment>();
        if (sky == nullptr || !sky->visible) {
            continue;
        }
        world.query<const DirectionalLight, Optional<const Sunlight>>().each(
            [&](const DirectionalLight& light, const Sunlight* sun) {
                const float direct = luminance_of(light.color) * light.illuminance;
                if (!light.enabled || (sun == nullptr && direct < kSun)) {
                    return;
                }
                ++suns;
                CHECK((sun != nullptr) == (sky->sky == SkyKind::Atmosphere));
                if (sun != nullptr) {
                    CHECK(sky->intensity == 1);  // the balance of the two is the air's
                    CHECK(sky->haze <= 20);
                    return;
                }
                ++gradients;
                const layout::Irradiance from_sky =
                    project_irradiance(make_environment_block(*sky, Vec3(0, 1, 0), Vec3(0)));
                CHECK(
                    direct
                    > kHaze * kPi * luminance_of(irradiance_toward(from_sky, Vec3(0, 1, 0))));
            });
    }
    CHECK(suns > 12);
    CHECK(gradients > 1);
}

TEST_CASE("level: the cloister has shadows of every method, and every light gets one") {
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
    HeadlessRenderer& headless = test::level_renderer();
    render_frame(*headless.renderer, (*stage)->world, view);
    // What stays where it is has been drawn once and for all; the cages turn, but no map sees them.
    step_stage(**stage);
    const FrameOutput next = render_frame(*headless.renderer, (*stage)->world, view);
    set_log_sink(nullptr);
    CHECK(warnings == 0);
    CHECK(next.statistics.shadow_views >= 14 * 6);
    CHECK(next.statistics.shadow_views_drawn == 0);
}

}  // namespace limn::level_golden_test
