#include "content/app/bench/bench_lights.h"
#include "ecs/components/light.h"
#include "ecs/world.h"
#include "tests/app/run_program.h"
#include "tests/support.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

namespace limn::bench_lights_test {

using test::ProgramRun;
using test::run_limn;
using test::TemporaryFolder;

namespace {

std::vector<bool> shining(World& world, int count) {
    CHECK(enable_some_lights(world, count) == 100);
    std::vector<bool> result;
    world.query<const PointLight>().each(
        [&](const PointLight& light) { result.push_back(light.enabled); });
    return result;
}

/// Two numbers of lights; the full-screen method takes 3 times as long and is left out of the
/// larger one.
LightsBench small_bench() {
    LightsBench bench{.machine = {.scene = "lights", .size = {64, 36}, .threads = 2}};
    bench.counts = {16, 64};
    for (std::size_t method = 0; method < kLightMethods; ++method) {
        for (const int lights : bench.counts) {
            LightsBenchPoint& point = bench.points[method].emplace_back();
            point.lights = lights;
            if (method == 1 && lights == 64) {
                point.left_out = "a frame would take up to 99 s";
                continue;
            }
            point.report.frames = 1;
            find_series(point.report, BenchKind::Frame, BenchClock::Cpu, "frame")
                .samples.push_back(method == 1 ? 6 : 2);
            find_series(point.report, BenchKind::Pass, BenchClock::Gpu, "lights")
                .samples.push_back(1.5);
        }
    }
    return bench;
}

}  // namespace

TEST_CASE("bench_lights: counts are powers of four up to all lights") {
    CHECK(light_counts(4096) == std::vector<int>{16, 64, 256, 1024, 4096});
    CHECK(light_counts(100) == std::vector<int>{16, 64, 100});
    CHECK(light_counts(3) == std::vector<int>{3});
}

TEST_CASE("bench_lights: the requested number of lights is on, and smaller sets are subsets of "
          "larger ones") {
    World world;
    for (int i = 0; i < 100; ++i) {
        world.create(PointLight{});
    }
    const std::vector<bool> few = shining(world, 16);
    const std::vector<bool> more = shining(world, 64);
    CHECK(std::count(few.begin(), few.end(), true) == 16);
    CHECK(std::count(more.begin(), more.end(), true) == 64);
    int low = 0;
    for (std::size_t i = 0; i < few.size(); ++i) {
        CHECK((!few[i] || more[i]));
        low += few[i] && i < 50 ? 1 : 0;
    }
    CHECK(low >= 4);  // spread
    CHECK(low <= 12);
    CHECK(shining(world, 1000) == std::vector<bool>(100, true));
}

TEST_CASE("bench_lights: the JSON has what was measured, what was skipped, and the ratio") {
    const nlohmann::json json = nlohmann::json::parse(lights_bench_json(small_bench()));
    REQUIRE(json["methods"].size() == kLightMethods);
    CHECK(json["methods"][1]["name"] == "full_screen");
    CHECK(json["methods"][1]["points"][0]["median_ms"] == 6.0);
    CHECK(json["methods"][1]["points"][1]["left_out"] == "a frame would take up to 99 s");
    CHECK(json["methods"][0]["points"][1]["passes"][0]["name"] == "lights");
    REQUIRE(json["full_screen_over_clustered"].size() == 1);
    CHECK(json["full_screen_over_clustered"][0]["ratio"] == 3.0);
}

TEST_CASE("bench_lights: the table has a line per number of lights, and says what was skipped") {
    const std::string table = lights_bench_table(small_bench());
    CHECK(table.find("3.0x") != std::string::npos);
    CHECK(table.find("- full_screen, 64 lights: a frame would take up to 99 s") < table.size());
    CHECK(table.find("Passes of clustered, 64 lights") < table.size());
    const std::string csv = lights_bench_csv(small_bench());
    CHECK(std::count(csv.begin(), csv.end(), '\n') == 10);
}

TEST_CASE("bench_lights: limn bench lights measures all five methods in one run") {
    const TemporaryFolder folder;
    const ProgramRun run = run_limn(
        folder, {"bench", "lights", "--frames", "1", "--warmup", "1", "--size", "32x18", "--json",
                 "b.json"});
    CHECK(run.exit_code == 0);
    CHECK(run.out.find("light_major") != std::string::npos);
    const nlohmann::json json = nlohmann::json::parse(test::read_text(folder.file("b.json")));
    REQUIRE(json["methods"].size() == kLightMethods);
    for (const auto& method : json["methods"]) {
        CHECK(method["points"].size() == 5);
        CHECK(method["points"][0]["median_ms"] > 0);
    }
}

}  // namespace limn::bench_lights_test
