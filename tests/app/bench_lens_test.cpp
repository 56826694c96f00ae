#include "content/app/bench/bench_lens.h"
#include "content/app/commands/stage.h"
#include "ecs/components/camera_lens.h"
#include "ecs/components/glare.h"
#include "ecs/components/glow.h"
#include "ecs/components/motion_blur.h"
#include "ecs/components/rendering.h"
#include "ecs/components/ripple.h"
#include "tests/app/run_program.h"
#include "tests/support.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>

namespace limn::bench_lens_test {

using test::ProgramRun;
using test::run_limn;
using test::TemporaryFolder;

namespace {

/// Three frames a point: all take 10 ms, and 5 ms more for an effect, of which its pass has 4.
LensBench small_bench() {
    LensBench bench{
        .machine = {.scene = "stilllife", .size = {64, 36}, .threads = 2}, .points = lens_points()};
    for (LensBenchPoint& point : bench.points) {
        point.report.frames = 3;
        const bool some = point.effects != kLensNothing;
        for (const double noise : {0.0, 0.0, 7.0}) {
            find_series(point.report, BenchKind::Frame, BenchClock::Cpu, "frame")
                .samples.push_back((some ? 15 : 10) + noise);
            find_series(point.report, BenchKind::Pass, BenchClock::Gpu, "lights")
                .samples.push_back(6 + noise);
            if (some) {
                find_series(point.report, BenchKind::Pass, BenchClock::Gpu, point.name)
                    .samples.push_back(4 + noise);
            }
        }
    }
    return bench;
}

}  // namespace

TEST_CASE("bench_lens: every effect is measured alone, and the four together") {
    unsigned alone = 0;
    unsigned together = 0;
    for (const LensBenchPoint& point : lens_points()) {
        const bool one = (point.effects & (point.effects - 1)) == 0;
        (one ? alone : together) |= point.effects;
    }
    CHECK(lens_points().front().effects == kLensNothing);
    CHECK(alone == (kLensFour | kLensAntialiasing | kLensGlare));
    CHECK(together == kLensFour);
}

TEST_CASE("bench_lens: effects that are not requested are off, the others as in the level") {
    const auto opened = open_stage(kLensScene);
    REQUIRE(opened.ok());
    Stage& stage = **opened;
    World& world = stage.world;
    const float f_number = world.get<const Lens>(stage.scene.camera).f_number;
    set_lens_effects(stage, kLensDepthOfField | kLensGlare | kLensRipple);
    CHECK(world.get<const Lens>(stage.scene.camera).f_number == f_number);
    CHECK(world.find_resource<Glare>() != nullptr);
    CHECK(world.query<const HeatHaze>().count() == 1);
    CHECK(world.find_resource<Glow>() == nullptr);
    CHECK(world.find_resource<MotionBlur>() == nullptr);
    CHECK(world.resource<Rendering>().antialiasing == Antialiasing::None);
    set_lens_effects(stage, kLensMotionBlur | kLensGlow | kLensAntialiasing);
    CHECK(world.find<Lens>(stage.scene.camera) == nullptr);
    CHECK(world.find_resource<Glare>() == nullptr);
    world.query<const HeatHaze>().each([](const HeatHaze& haze) { CHECK(haze.strength == 0); });
    CHECK(world.find_resource<Glow>() != nullptr);
    CHECK(world.find_resource<MotionBlur>() != nullptr);
    CHECK(world.resource<Rendering>().antialiasing == Antialiasing::Temporal);
}

TEST_CASE("bench_lens: an effect costs the time it adds to a frame, and lists its passes") {
    const LensBench bench = small_bench();
    const LensCost none = lens_cost(bench, bench.points.front());
    CHECK(none.frame == 10);
    CHECK(none.added == 0);
    CHECK(none.passes == 0);
    const LensCost glow = lens_cost(bench, bench.points[5]);
    CHECK(glow.frame == 15);
    CHECK(glow.added == 5);
    CHECK(glow.passes == 4);
    const nlohmann::json json = nlohmann::json::parse(lens_bench_json(bench));
    REQUIRE(json["points"].size() == bench.points.size());
    CHECK(json["points"][5]["effects"] == "glow");
    CHECK(json["points"][5]["added_ms"] == 5.0);
    CHECK(json["points"][5]["passes"][0]["median_ms"] == 4.0);
    const std::string csv = lens_bench_csv(bench);
    CHECK(std::count(csv.begin(), csv.end(), '\n') == 9);
    CHECK(csv.find("\"glow\",3,15.000000,22.000000,5.000000,4.000000") != std::string::npos);
}

TEST_CASE("bench_lens: limn bench lens runs each effect's own passes") {
    const TemporaryFolder folder;
    const ProgramRun run = run_limn(
        folder,
        {"bench", "lens", "--frames", "1", "--warmup", "1", "--size", "64x36", "--json", "b.json"});
    CHECK(run.exit_code == 0);
    CHECK(run.out.find("temporal antialiasing") != std::string::npos);
    const nlohmann::json json = nlohmann::json::parse(test::read_text(folder.file("b.json")));
    const char* passes[] = {nullptr,         "temporal", "ripple", "motion blur",
                            "focus.compose", "glow",     "glare",  "ripple"};
    REQUIRE(json["points"].size() == std::size(passes));
    for (std::size_t i = 0; i < std::size(passes); ++i) {
        const auto& measured = json["points"][i]["passes"];
        CAPTURE(measured.dump());
        CHECK(measured.empty() == (passes[i] == nullptr));
        CHECK(
            std::any_of(
                measured.begin(), measured.end(),
                [&](const auto& pass) { return pass["name"] == passes[i]; })
            == (passes[i] != nullptr));
    }
}

}  // namespace limn::bench_lens_test
