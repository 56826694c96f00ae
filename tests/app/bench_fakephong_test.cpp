#include "content/app/bench/bench_fakephong.h"
#include "tests/app/run_program.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace limn::bench_fakephong_test {

using test::ProgramRun;
using test::run_limn;
using test::TemporaryFolder;

TEST_CASE(
    "bench_fakephong: costs are ratios to per-pixel shading of the same model and lights"
    * technique("fakephong.metric-efficiency")) {
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

TEST_CASE("bench_fakephong: counted lighting evaluations match the thesis, and Phong shading's "
          "work is 1") {
    const std::vector<FakePhongCount> counts = count_fakephong();
    const auto of = [&](const char* model, const char* method) {
        return std::find_if(
                   counts.begin(), counts.end(),
                   [&](const FakePhongCount& one) {
                       return one.model == model && one.method == method;
                   })
            ->efficiency;
    };
    REQUIRE(counts.size() == 4 * (14 + 3));
    for (const char* model : {"teapot", "triangle", "dodecahedron", "sphere"}) {
        CHECK(of(model, "phong").work == 1);
        CHECK(of(model, "gouraud").lightings == 3);
        CHECK(of(model, "gouraud-subdivided").lightings == 6);
        CHECK(of(model, "quadratic").lightings == 6);
        CHECK(of(model, "blinn-map").lightings == 3);
        CHECK(of(model, "quadratic-blinn").lightings == 6);
        CHECK(of(model, "blinn-map").fetches == 1);
        CHECK(of(model, "envmap").work < of(model, "blinn-map").work);
    }
    CHECK(of("triangle", "quadratic, stepped").multiplications < 0.1);
    CHECK(of("triangle", "quadratic, stepped").work < of("triangle", "quadratic").work);
}

TEST_CASE(
    "bench_fakephong: every method is timed on every model under 1, 4 and 16 lights"
    * technique("fakephong.metric-efficiency")) {
    const TemporaryFolder folder;
    const ProgramRun run = run_limn(
        folder, {"bench", "fakephong", "--frames", "1", "--size", "32x18", "--csv", "b.csv"});
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
    const std::string csv = test::read_text(folder.file("b.csv"));
    CHECK(std::count(csv.begin(), csv.end(), '\n') == 1 + 4 * 3 * kShadingRates + 2 + 4 * (14 + 3));
    CHECK(csv.find("nan") == std::string::npos);
    CHECK(csv.find("sphere,16,quadratic_blinn,1,") != std::string::npos);
    CHECK(csv.find("sphere,\"quadratic-blinn\",6,") != std::string::npos);
    CHECK(csv.find("triangle,\"cubic, stepped\",10,") != std::string::npos);
    CHECK(run.out.find("Counted on a CPU") != std::string::npos);
}

}  // namespace limn::bench_fakephong_test
