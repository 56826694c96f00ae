#include "content/app/bench/bottleneck.h"
#include "content/app/commands/headless.h"
#include "content/app/commands/stage.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <string>

namespace limn::bottleneck_test {

using test::near;

TEST_CASE(
    "bottleneck: the slowest stage alone decides how many frames there are"
    * technique("engine.bottleneck")) {
    const PipelineTimes times = {4, 9, 6};
    CHECK(frame_period(times) == near(9));
    CHECK(frame_latency(times) == near(19));
    CHECK(find_bottleneck(times) == PipelineStage::Geometry);
    CHECK(frame_period({1, 9, 6}) == near(9));
    CHECK(frame_period({4, 9, 2}) == near(9));
    CHECK(frame_period({4, 6, 6}) == near(6));
    CHECK(find_bottleneck({7, 1, 6}) == PipelineStage::Application);
    CHECK(find_bottleneck({1, 1, 6}) == PipelineStage::Rasterization);
}

TEST_CASE("bottleneck: the experiments save what a stage takes, and never less than nothing") {
    const PipelineTimes times = times_of_experiments(19, 13, 4);
    CHECK(times.application == near(4));
    CHECK(times.geometry == near(9));
    CHECK(times.rasterization == near(6));
    CHECK(times_of_experiments(5, 6, 7).geometry == 0);
    CHECK(times_of_experiments(5, 6, 7).rasterization == 0);
    const std::string text = bottleneck_text(times);
    CHECK(
        text.find("geometry           9.00  ========================================\n")
        != std::string::npos);
    CHECK(text.find("bound by geometry: 111.1 frames a second") != std::string::npos);
}

TEST_CASE("bottleneck: a few triangles and instances of each mesh are drawn") {
    const auto opened = open_stage("gallery");
    REQUIRE(opened.ok());
    auto headless = create_headless_renderer();
    REQUIRE(headless.ok());
    const RenderView view =
        make_render_view((*opened)->world, (*opened)->scene.camera, {.width = 64, .height = 36});
    const FrameOutput all = render_frame(*headless->renderer, (*opened)->world, view);
    const FrameOutput few = render_frame(
        *headless->renderer, (*opened)->world, view, {.aovs = {}, .few_triangles = true});
    CHECK(few.statistics.triangles < all.statistics.triangles / 5);
    CHECK(few.statistics.draws == all.statistics.draws);
    const FrameOutput again = render_frame(*headless->renderer, (*opened)->world, view);
    CHECK(again.statistics.triangles == all.statistics.triangles);
}

}  // namespace limn::bottleneck_test
