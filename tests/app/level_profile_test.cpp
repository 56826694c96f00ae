// Every level looks the same with the formats and definitions of a GPU as with those of a software
// OpenGL.

#include "content/app/headless.h"
#include "content/app/stage.h"
#include "content/bake/image_compare.h"
#include "content/load/level_list.h"
#include "render/gpu/readback.h"
#include "render/render_view.h"

#include <doctest/doctest.h>

#include <memory>
#include <string>
#include <vector>

namespace limn {
namespace {

constexpr int kSteps = 10;
constexpr double kMinPsnr = 45;  // [dB]

std::vector<std::unique_ptr<Stage>> open_levels() {
    std::vector<std::unique_ptr<Stage>> stages;
    for (const LevelEntry& level : list_levels()) {
        Result<std::unique_ptr<Stage>> stage = open_stage(level.path);
        REQUIRE_MESSAGE(stage.ok(), (stage ? std::string() : stage.error().message));
        for (int i = 0; i < kSteps; ++i) {
            step_stage(**stage);
        }
        stages.push_back(*std::move(stage));
    }
    return stages;
}

ColorImage draw_level(HeadlessRenderer& headless, const Stage& stage) {
    const RenderView view =
        make_render_view(stage.world, stage.scene.camera, {.width = 320, .height = 180});
    const FrameOutput frame = render_accumulated(*headless.renderer, stage.world, view, 4);
    const gpu::ByteImage bytes = gpu::read_bytes(*frame.display);
    ColorImage image{bytes.width, bytes.height, {}};
    for (std::size_t i = 0; i < bytes.pixels.size();
         i += static_cast<std::size_t>(bytes.channels)) {
        const std::uint8_t* pixel = bytes.pixels.data() + i;
        image.pixels.push_back(Vec3(pixel[0], pixel[1], pixel[2]) / 255.0f);
    }
    return image;
}

std::vector<ColorImage>
draw_levels(gpu::Profile profile, const std::vector<std::unique_ptr<Stage>>& stages) {
    Result<HeadlessRenderer> headless = create_headless_renderer(profile);
    REQUIRE_MESSAGE(headless.ok(), (headless ? std::string() : headless.error().message));
    std::vector<ColorImage> images;
    for (const std::unique_ptr<Stage>& stage : stages) {
        images.push_back(draw_level(*headless, *stage));
    }
    return images;
}

TEST_CASE("profile: every level looks the same with both") {
    const std::vector<std::unique_ptr<Stage>> stages = open_levels();
    const std::vector<ColorImage> gpu = draw_levels(gpu::Profile::Gpu, stages);
    const std::vector<ColorImage> software = draw_levels(gpu::Profile::Software, stages);
    for (std::size_t i = 0; i < gpu.size(); ++i) {
        CAPTURE(stages[i]->scene.name);
        CHECK(psnr(gpu[i], software[i]) >= kMinPsnr);
    }
}

}  // namespace
}  // namespace limn
