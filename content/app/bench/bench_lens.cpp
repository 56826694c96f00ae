#include "content/app/bench/bench_lens.h"

#include "content/app/bench/bench_command.h"
#include "content/app/commands/headless.h"
#include "content/app/commands/progress.h"
#include "content/app/commands/stage.h"
#include "ecs/components/camera_lens.h"
#include "ecs/components/glare.h"
#include "ecs/components/glow.h"
#include "ecs/components/motion_blur.h"
#include "ecs/components/rendering.h"
#include "ecs/components/ripple.h"
#include "ecs/components/transform.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>
#include <utility>

namespace limn {
namespace {

/// A box that encloses the table and everything on it.
constexpr Transform kHotAir = {.position = {0, 0.2f, -0.1f}, .scale = {1, 0.4f, 0.8f}};

/// If `wanted`, keeps the level's resource or inserts a default; else removes it.
template <typename Resource>
void set_resource(World& world, bool wanted) {
    if (!wanted) {
        world.remove_resource<Resource>();
    } else if (world.find_resource<Resource>() == nullptr) {
        world.insert_resource(Resource{});
    }
}

const BenchSeries* find_frames(const BenchReport& report) {
    for (const BenchSeries& series : report.series) {
        if (series.kind == BenchKind::Frame && series.name == "frame") {
            return &series;
        }
    }
    return nullptr;
}

Summary frame_summary(const BenchReport& report) {
    const BenchSeries* frames = find_frames(report);
    return frames == nullptr ? Summary{} : summarize(frames->samples);
}

/// Median times of the passes of `report` that `without` does not have, slowest first.
std::vector<std::pair<std::string, double>>
passes_beyond(const BenchReport& report, const BenchReport& without) {
    const auto is_pass = [](const BenchSeries& series) {
        return series.kind == BenchKind::Pass && series.clock == BenchClock::Gpu;
    };
    std::vector<std::pair<std::string, double>> passes;
    for (const BenchSeries& series : report.series) {
        const bool known = std::any_of(
            without.series.begin(), without.series.end(),
            [&](const BenchSeries& other) { return is_pass(other) && other.name == series.name; });
        if (is_pass(series) && !known) {
            passes.emplace_back(series.name, summarize(series.samples).median);
        }
    }
    std::stable_sort(passes.begin(), passes.end(), [](const auto& a, const auto& b) {
        return a.second > b.second;
    });
    return passes;
}

Status measure_point(
    const BenchOptions& options, HeadlessRenderer& headless, LensBenchPoint& point,
    Progress& progress, int& done) {
    Result<std::unique_ptr<Stage>> stage =
        open_stage(kLensScene, {.assignments = options.assignments});
    if (!stage) {
        return stage.error();
    }
    set_lens_effects(**stage, point.effects);
    point.report.frames = options.frames;
    point.report.warmup = options.warmup;
    for (int i = 0; i < options.warmup + options.frames; ++i) {
        BenchReport* report = i < options.warmup ? nullptr : &point.report;
        run_bench_frame(**stage, headless, options.size, report);
        progress.update(++done);
    }
    return Done{};
}

}  // namespace

std::vector<LensBenchPoint> lens_points() {
    return {
        {.name = "none"},
        {.name = "temporal antialiasing", .effects = kLensAntialiasing},
        {.name = "ripple", .effects = kLensRipple},
        {.name = "motion blur", .effects = kLensMotionBlur},
        {.name = "depth of field", .effects = kLensDepthOfField},
        {.name = "glow", .effects = kLensGlow},
        {.name = "glare", .effects = kLensGlare},
        {.name = "ripple, motion blur, depth of field, glow", .effects = kLensFour}};
}

void set_lens_effects(Stage& stage, unsigned effects) {
    World& world = stage.world;
    set_resource<MotionBlur>(world, (effects & kLensMotionBlur) != 0);
    set_resource<Glow>(world, (effects & kLensGlow) != 0);
    set_resource<Glare>(world, (effects & kLensGlare) != 0);
    set_resource<Rendering>(world, true);
    world.resource<Rendering>().antialiasing =
        (effects & kLensAntialiasing) != 0 ? Antialiasing::Temporal : Antialiasing::None;

    const Entity camera = stage.scene.camera;
    if ((effects & kLensDepthOfField) == 0) {
        world.remove<Lens>(camera);
    } else if (!world.has<Lens>(camera)) {
        world.add(camera, Lens{});
    }

    world.remove_resource<LensRain>();
    world.query<HeatHaze>().each([](HeatHaze& haze) { haze.strength = 0; });
    world.query<RippleRing>().each([](RippleRing& ring) { ring.amplitude = 0; });
    world.query<ScreenRipple>().each([](ScreenRipple& ripple) { ripple.amplitude = 0; });
    if ((effects & kLensRipple) != 0) {
        world.create(kHotAir, HeatHaze{.strength = 0.004f, .scale = 0.05f, .rise = 0.2f});
    }
}

Result<LensBench> measure_lens(const BenchOptions& options, HeadlessRenderer& headless) {
    LensBench bench{.points = lens_points()};
    Result<std::unique_ptr<Stage>> stage =
        open_stage(kLensScene, {.assignments = options.assignments});
    if (!stage) {
        return stage.error();
    }
    bench.machine = machine_report(**stage, headless, options);
    const auto count = static_cast<int>(bench.points.size());
    Progress progress("frame", count * (options.warmup + options.frames));
    int done = 0;
    for (LensBenchPoint& point : bench.points) {
        if (const Status measured = measure_point(options, headless, point, progress, done);
            !measured) {
            return measured.error();
        }
    }
    return bench;
}

LensCost lens_cost(const LensBench& bench, const LensBenchPoint& point) {
    const BenchReport& none = bench.points.front().report;
    LensCost cost{.frame = frame_summary(point.report).median};
    cost.added = cost.frame - frame_summary(none).median;
    for (const auto& pass : passes_beyond(point.report, none)) {
        cost.passes += pass.second;
    }
    return cost;
}

std::string lens_bench_table(const LensBench& bench) {
    std::string text;
    auto out = std::back_inserter(text);
    const BenchReport& none = bench.points.front().report;
    fmt::format_to(
        out, "{}, {} x {}, {} frames, {} threads\n{}, OpenGL {}\n\n{:<42} {:>10} {:>10} {:>10}\n",
        bench.machine.scene, bench.machine.size.x, bench.machine.size.y, none.frames,
        bench.machine.threads, bench.machine.gl_renderer, bench.machine.gl_version, "[ms], medians",
        "frame", "added", "passes");
    for (const LensBenchPoint& point : bench.points) {
        const LensCost cost = lens_cost(bench, point);
        fmt::format_to(
            out, "{:<42} {:>10.2f} {:>10.2f} {:>10.2f}\n", point.name, cost.frame, cost.added,
            cost.passes);
    }
    fmt::format_to(out, "\nPasses of {}:\n", bench.points.back().name);
    for (const auto& [name, ms] : passes_beyond(bench.points.back().report, none)) {
        fmt::format_to(out, "  {:<24} {:>9.3f}\n", name, ms);
    }
    return text;
}

std::string lens_bench_json(const LensBench& bench) {
    const BenchReport& none = bench.points.front().report;
    nlohmann::ordered_json points = nlohmann::ordered_json::array();
    for (const LensBenchPoint& point : bench.points) {
        const LensCost cost = lens_cost(bench, point);
        nlohmann::ordered_json passes = nlohmann::ordered_json::array();
        for (const auto& [name, ms] : passes_beyond(point.report, none)) {
            passes.push_back({{"name", name}, {"median_ms", ms}});
        }
        points.push_back(
            {{"effects", point.name},
             {"median_ms", cost.frame},
             {"p95_ms", frame_summary(point.report).p95},
             {"added_ms", cost.added},
             {"passes_ms", cost.passes},
             {"passes", std::move(passes)}});
    }
    const nlohmann::ordered_json json = {
        {"scene", bench.machine.scene},
        {"size", {bench.machine.size.x, bench.machine.size.y}},
        {"frames", none.frames},
        {"warmup", none.warmup},
        {"threads", bench.machine.threads},
        {"gl", {{"renderer", bench.machine.gl_renderer}, {"version", bench.machine.gl_version}}},
        {"points", std::move(points)}};
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string lens_bench_csv(const LensBench& bench) {
    std::string text = "effects,frames,median_ms,p95_ms,added_ms,passes_ms\n";
    for (const LensBenchPoint& point : bench.points) {
        const LensCost cost = lens_cost(bench, point);
        fmt::format_to(
            std::back_inserter(text), "\"{}\",{},{:.6f},{:.6f},{:.6f},{:.6f}\n", point.name,
            point.report.frames, cost.frame, frame_summary(point.report).p95, cost.added,
            cost.passes);
    }
    return text;
}

}  // namespace limn
