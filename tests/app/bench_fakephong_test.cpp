#include "content/app/bench_fakephong.h"
#include "tests/app/run_program.h"
#include "tests/support.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>

namespace limn {

using test::ProgramRun;
using test::run_limn;
using test::TemporaryFolder;

TEST_CASE("bench_fakephong: costs are ratios to per-pixel shading of the same model and lights") {
    FakePhongBench bench{.machine = {.scene = "phonglab", .size = {64, 36}, .frames = 3}};
    for (const int lights : kFakePhongLights) {
        FakePhongPoint& point = bench.points.emplace_back(FakePhongPoint{"teapot", lights, {}});
        point.best_ms.fill(8.0 * lights);
        point.best_ms[1] = 2.0 * lights;
    }
    const nlohmann::json json = nlohmann::json::parse(fakephong_bench_json(bench));
    REQUIRE(json["points"].size() == kFakePhongLights.size());
    CHECK(json["points"][1]["methods"][0]["ratio"] == 1.0);
    CHECK(json["points"][1]["methods"][1]["shading"] == "vertex");
    CHECK(json["points"][1]["methods"][1]["ratio"] == 0.25);
    const std::string csv = fakephong_bench_csv(bench);
    CHECK(csv.find("teapot,4,vertex,3,8.0000,0.250\n") != std::string::npos);
    CHECK(fakephong_bench_table(bench).find("vertex") != std::string::npos);
}

TEST_CASE("bench_fakephong: every method is timed on every model under 1, 4 and 16 lights") {
    const TemporaryFolder folder;
    const ProgramRun run = run_limn(
        folder, {"bench", "fakephong", "--frames", "1", "--size", "32x18", "--csv", "b.csv"});
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
    const std::string csv = test::read_text(folder.file("b.csv"));
    CHECK(std::count(csv.begin(), csv.end(), '\n') == 1 + 4 * 3 * kShadingRates);
    CHECK(csv.find("nan") == std::string::npos);
    CHECK(csv.find("sphere,16,quadratic_blinn,1,") != std::string::npos);
}

}  // namespace limn
