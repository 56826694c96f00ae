#include "content/app/bench/bench_surfaces.h"
#include "content/app/commands/stage.h"
#include "ecs/components/camera_path.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace limn::bench_surfaces_test {

using test::near;

namespace {

/// Frames of 10 ms flat, and 5 ms more for each rung.
SurfaceBench ladder() {
    SurfaceBench bench{
        .machine = {.scene = "temple", .size = {64, 36}, .threads = 2}, .points = surface_points()};
    double ms = 10;
    for (SurfaceBenchPoint& point : bench.points) {
        point.report.frames = 3;
        for (const double noise : {0.0, 0.0, 7.0}) {
            find_series(point.report, BenchKind::Frame, BenchClock::Cpu, "all threads")
                .samples.push_back(ms + noise);
            find_series(point.report, BenchKind::Pass, BenchClock::Gpu, "gbuffer")
                .samples.push_back(ms / 2 + noise);
        }
        ms += 5;
    }
    return bench;
}

}  // namespace

TEST_CASE("bench_surfaces: each kind of detail is measured once, the flat one first") {
    std::vector<int> details;
    for (const SurfaceBenchPoint& point : surface_points()) {
        details.push_back(static_cast<int>(point.detail));
    }
    CHECK(details.front() == static_cast<int>(SurfaceDetail::Flat));
    std::ranges::sort(details);
    CHECK(std::ranges::adjacent_find(details) == details.end());
    // Without ObjectNormal and DoubleDepth, which need maps of another kind.
    CHECK(details.size() == static_cast<std::size_t>(SurfaceDetail::Displaced) - 1);
}

TEST_CASE("bench_surfaces: nothing but the wall is left, with its detail, before a still camera") {
    const auto opened = open_stage(kSurfacesScene);
    REQUIRE(opened.ok());
    Stage& stage = **opened;
    set_wall(stage, SurfaceDetail::Cone);
    const auto& assets = stage.world.resource<Assets>();
    int drawn = 0;
    stage.world.query<const MeshInstance>().each([&](const MeshInstance& instance) {
        if (instance.mesh.index != kNoAsset) {
            ++drawn;
            CHECK(assets.materials[instance.material.index].name == "wall");
            CHECK(assets.materials[instance.material.index].detail == SurfaceDetail::Cone);
        }
    });
    CHECK(drawn == 1);
    CHECK(stage.world.find<CameraPath>(stage.scene.camera) == nullptr);
}

TEST_CASE("bench_surfaces: ratios are of medians, in the table, the JSON and the CSV") {
    const SurfaceBench bench = ladder();
    const SurfaceCost third = surface_cost(bench, bench.points[2]);
    CHECK(third.frame == near(20));
    CHECK(third.gbuffer == near(10));
    CHECK(third.ratio == near(2));
    CHECK(surface_bench_table(bench).find("2.00  ====================\n") != std::string::npos);
    const nlohmann::json json = nlohmann::json::parse(surface_bench_json(bench));
    CHECK(json["points"][2]["ratio"].get<double>() == near(2));
    CHECK(json["points"].size() == bench.points.size());
    CHECK(
        surface_bench_csv(bench).find("\"flat\",3,10.000000,5.000000,1.000000\n")
        != std::string::npos);
}

}  // namespace limn::bench_surfaces_test
