#include "content/app/bench/bench_surfaces.h"

#include "content/app/bench/bench_command.h"
#include "content/app/commands/headless.h"
#include "content/app/commands/progress.h"
#include "content/app/commands/stage.h"
#include "content/make/patterns/relief_patterns.h"
#include "ecs/components/camera_path.h"
#include "ecs/components/name.h"
#include "ecs/components/transform.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace limn {
namespace {

/// At 30 degrees to the wall, which fills the image.
constexpr Vec3 kWallEye = {-1.4f, 1.5f, -2.1f};
constexpr Vec3 kWallTarget = {0.1f, 1.5f, -3.0f};

double
median_of(const BenchReport& report, BenchKind kind, BenchClock clock, std::string_view name) {
    for (const BenchSeries& series : report.series) {
        if (series.kind == kind && series.clock == clock && series.name == name) {
            return summarize(series.samples).median;
        }
    }
    return 0;
}

void use_odd_map(Assets& assets, Material& material) {
    TextureSlot& slot = material.relief_texture;
    if (slot.image.index < assets.images.size()) {
        assets.images.push_back(make_odd_map(
            assets.images[slot.image.index], material.relief_depth * std::abs(slot.scale.x)));
        slot.image = {static_cast<std::uint32_t>(assets.images.size() - 1)};
    }
}

Status measure_wall(
    const BenchOptions& options, HeadlessRenderer& headless, SurfaceBenchPoint& point,
    Progress& progress, int& done) {
    const std::unique_ptr<Stage> stage =
        LIMN_TRY(open_stage(kSurfacesScene, {.assignments = options.assignments}));
    set_wall(*stage, point.detail);
    point.report.frames = options.frames;
    point.report.warmup = options.warmup;
    for (int i = 0; i < options.warmup + options.frames; ++i) {
        BenchReport* report = i < options.warmup ? nullptr : &point.report;
        run_bench_frame(*stage, headless, options.size, report);
        progress.update(++done);
    }
    return Done{};
}

}  // namespace

std::vector<SurfaceBenchPoint> surface_points() {
    return {
        {.name = "flat", .detail = SurfaceDetail::Flat},
        {.name = "normal map", .detail = SurfaceDetail::Normal},
        {.name = "bump", .detail = SurfaceDetail::Bump},
        {.name = "parallax", .detail = SurfaceDetail::Parallax},
        {.name = "cone stepping", .detail = SurfaceDetail::Cone},
        {.name = "parallax occlusion", .detail = SurfaceDetail::Occlusion},
        {.name = "relief", .detail = SurfaceDetail::Relief},
        {.name = "silhouette", .detail = SurfaceDetail::Silhouette},
        {.name = "odd", .detail = SurfaceDetail::Odd},
        {.name = "displaced", .detail = SurfaceDetail::Displaced}};
}

void set_wall(Stage& stage, SurfaceDetail detail) {
    World& world = stage.world;
    auto& assets = world.resource<Assets>();
    std::uint32_t wall = kNoAsset;
    for (std::uint32_t i = 0; i < assets.materials.size(); ++i) {
        wall = assets.materials[i].name == "wall" ? i : wall;
    }
    if (wall == kNoAsset) {
        return;  // `--set` took it away
    }
    assets.materials[wall].detail = detail;
    if (detail == SurfaceDetail::Odd) {
        use_odd_map(assets, assets.materials[wall]);
    }
    ++assets.material_version;
    world.query<MeshInstance>().each([wall](MeshInstance& instance) {
        if (instance.material.index != wall) {
            instance.mesh.index = kNoAsset;
        }
    });
    const Entity camera = stage.scene.camera;
    world.remove<CameraPath>(camera);
    if (!world.has<Transform>(camera)) {
        world.add(camera, Transform{});
    }
    auto& pose = world.get<Transform>(camera);
    pose.position = kWallEye;
    pose.rotation = glm::quatLookAt(glm::normalize(kWallTarget - kWallEye), Vec3(0, 1, 0));
}

Result<SurfaceBench> measure_surfaces(const BenchOptions& options, HeadlessRenderer& headless) {
    SurfaceBench bench{.points = surface_points()};
    const std::unique_ptr<Stage> stage =
        LIMN_TRY(open_stage(kSurfacesScene, {.assignments = options.assignments}));
    bench.machine = machine_report(*stage, headless, options);
    const auto count = static_cast<int>(bench.points.size());
    Progress progress("frame", count * (options.warmup + options.frames));
    int done = 0;
    for (SurfaceBenchPoint& point : bench.points) {
        LIMN_TRY(measure_wall(options, headless, point, progress, done));
    }
    return bench;
}

SurfaceCost surface_cost(const SurfaceBench& bench, const SurfaceBenchPoint& point) {
    const auto frame = [](const BenchReport& report) {
        return median_of(report, BenchKind::Frame, BenchClock::Cpu, "all threads");
    };
    SurfaceCost cost{
        .frame = frame(point.report),
        .gbuffer = median_of(point.report, BenchKind::Pass, BenchClock::Gpu, "gbuffer")};
    const double flat = frame(bench.points.front().report);
    cost.ratio = flat > 0 ? cost.frame / flat : 0;
    return cost;
}

std::string surface_bench_table(const SurfaceBench& bench) {
    std::string text;
    auto out = std::back_inserter(text);
    fmt::format_to(
        out, "{}, {} x {}, {} frames, {} threads\n{}, OpenGL {}\n\n{:<20} {:>9} {:>9} {:>7}\n",
        bench.machine.scene, bench.machine.size.x, bench.machine.size.y,
        bench.points.front().report.frames, bench.machine.threads, bench.machine.gl_renderer,
        bench.machine.gl_version, "[ms], medians", "frame", "gbuffer", "ratio");
    for (const SurfaceBenchPoint& point : bench.points) {
        const SurfaceCost cost = surface_cost(bench, point);
        const auto bar = static_cast<std::size_t>(std::clamp(10 * cost.ratio, 0.0, 60.0));
        fmt::format_to(
            out, "{:<20} {:>9.2f} {:>9.2f} {:>7.2f}  {}\n", point.name, cost.frame, cost.gbuffer,
            cost.ratio, std::string(bar, '='));
    }
    return text;
}

std::string surface_bench_json(const SurfaceBench& bench) {
    nlohmann::ordered_json points = nlohmann::ordered_json::array();
    for (const SurfaceBenchPoint& point : bench.points) {
        const SurfaceCost cost = surface_cost(bench, point);
        points.push_back(
            {{"detail", point.name},
             {"median_ms", cost.frame},
             {"gbuffer_ms", cost.gbuffer},
             {"ratio", cost.ratio}});
    }
    const BenchReport& first = bench.points.front().report;
    const nlohmann::ordered_json json = {
        {"scene", bench.machine.scene},
        {"size", {bench.machine.size.x, bench.machine.size.y}},
        {"frames", first.frames},
        {"warmup", first.warmup},
        {"threads", bench.machine.threads},
        {"gl", {{"renderer", bench.machine.gl_renderer}, {"version", bench.machine.gl_version}}},
        {"points", std::move(points)}};
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string surface_bench_csv(const SurfaceBench& bench) {
    std::string text = "detail,frames,median_ms,gbuffer_ms,ratio\n";
    for (const SurfaceBenchPoint& point : bench.points) {
        const SurfaceCost cost = surface_cost(bench, point);
        fmt::format_to(
            std::back_inserter(text), "\"{}\",{},{:.6f},{:.6f},{:.6f}\n", point.name,
            point.report.frames, cost.frame, cost.gbuffer, cost.ratio);
    }
    return text;
}

}  // namespace limn
