#include "content/app/bench/bench_lights.h"

#include "content/app/bench/bench_command.h"
#include "content/app/commands/headless.h"
#include "content/app/commands/progress.h"
#include "content/app/commands/stage.h"
#include "ecs/base/hash.h"
#include "ecs/base/text.h"
#include "ecs/components/camera_path.h"
#include "ecs/components/light.h"
#include "ecs/world.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <numeric>

namespace limn {
namespace {

constexpr int kMinLights = 16;
constexpr double kMaxPointTime = 4.0;  ///< no further frame is started after this time [s]
constexpr int kMinFrames = 2;          ///< measured even beyond that time
constexpr const char* kMethodNames[kLightMethods] = {
    "clustered", "full_screen", "volumes", "object_major", "light_major"};
constexpr auto kClustered = static_cast<std::size_t>(LightMethod::Clustered);
constexpr auto kFullScreen = static_cast<std::size_t>(LightMethod::FullScreen);

Summary lights_frame_summary(const BenchReport& report) {
    for (const BenchSeries& series : report.series) {
        if (series.kind == BenchKind::Frame && series.name == "frame") {
            return summarize(series.samples);
        }
    }
    return {};
}

bool was_measured(const LightsBenchPoint& point) {
    return point.left_out.empty();
}

/// Measures frames of the stage as it is now, after warm-up frames that compile shaders and upload.
void measure_lights_point(
    Stage& stage, HeadlessRenderer& headless, const BenchOptions& options, BenchReport& report) {
    using Clock = std::chrono::steady_clock;
    const auto seconds_since = [](Clock::time_point begin) {
        return std::chrono::duration<double>(Clock::now() - begin).count();
    };
    const Clock::time_point warm = Clock::now();
    do {
        run_bench_frame(stage, headless, options.size, nullptr);
        ++report.warmup;
    } while (report.warmup < options.warmup && seconds_since(warm) < 0.25 * kMaxPointTime);
    const Clock::time_point begin = Clock::now();
    do {
        run_bench_frame(stage, headless, options.size, &report);
        ++report.frames;
    } while (report.frames < options.frames
             && (report.frames < kMinFrames || seconds_since(begin) < kMaxPointTime));
}

/// Median frame time over that of the clustered method with as many lights; 0 if either is missing.
double cost_over_clustered(const LightsBench& bench, std::size_t method, std::size_t count) {
    const LightsBenchPoint& point = bench.points[method][count];
    const LightsBenchPoint& clustered = bench.points[kClustered][count];
    if (!was_measured(point) || !was_measured(clustered)) {
        return 0;
    }
    return lights_frame_summary(point.report).median
           / std::max(lights_frame_summary(clustered.report).median, 1e-6);
}

}  // namespace

std::vector<int> light_counts(int lights) {
    std::vector<int> counts;
    for (int count = kMinLights; count < lights; count *= 4) {
        counts.push_back(count);
    }
    counts.push_back(lights);
    return counts;
}

int enable_some_lights(World& world, int count) {
    // Ordered by a hash of their index, so that any prefix is spread over the level.
    const auto query = world.query<PointLight>();
    const auto total = static_cast<int>(query.count());
    std::vector<int> order(static_cast<std::size_t>(total));
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [](int a, int b) {
        return hash_combine(0, static_cast<std::uint64_t>(a))
               < hash_combine(0, static_cast<std::uint64_t>(b));
    });
    std::vector<bool> shines(order.size(), false);
    for (int i = 0; i < std::min(count, total); ++i) {
        shines[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])] = true;
    }
    std::size_t i = 0;
    query.each([&](PointLight& light) { light.enabled = shines[i++]; });
    return total;
}

Result<LightsBench>
measure_lights(Stage& stage, HeadlessRenderer& headless, const BenchOptions& options) {
    const int total = enable_some_lights(stage.world, 0);
    if (total == 0) {
        return fail("{}: found no point lights, expected some to count", stage.scene.name);
    }
    // A fixed camera: every point renders the same view, however many frames came before.
    stage.world.remove<CameraPath>(stage.scene.camera);
    LightsBench bench{.machine = machine_report(stage, headless, options)};
    bench.counts = light_counts(total);
    Progress progress("point", static_cast<int>(bench.counts.size()) * kLightMethods);
    int done = 0;
    for (std::size_t method = 0; method < kLightMethods; ++method) {
        stage.world.resource<Rendering>().lights = static_cast<LightMethod>(method);
        int measured = 0;       // light count of the last measured point
        double frame_ms = 0.0;  // and its median frame time
        for (const int count : bench.counts) {
            LightsBenchPoint& point = bench.points[method].emplace_back();
            point.lights = count;
            // With twice the lights a frame takes at most twice as long.
            const double expected = measured > 0 ? 1e-3 * frame_ms * count / measured : 0.0;
            if (expected > kMaxLightFrame) {
                point.left_out = fmt::format("a frame would take up to {:.0f} s", expected);
            } else {
                enable_some_lights(stage.world, count);
                measure_lights_point(stage, headless, options, point.report);
                measured = count;
                frame_ms = lights_frame_summary(point.report).median;
            }
            progress.update(++done);
        }
    }
    return bench;
}

std::string lights_bench_table(const LightsBench& bench) {
    std::string text;
    auto out = std::back_inserter(text);
    fmt::format_to(
        out,
        "{}, {} x {}, {} threads\n{}, OpenGL {}\n\n"
        "Median frame time [ms], and its ratio to the clustered method:\n{:<7}",
        bench.machine.scene, bench.machine.size.x, bench.machine.size.y, bench.machine.threads,
        bench.machine.gl_renderer, bench.machine.gl_version, "lights");
    for (const char* name : kMethodNames) {
        fmt::format_to(out, " {:>19}", name);
    }
    std::string left_out;
    for (std::size_t i = 0; i < bench.counts.size(); ++i) {
        fmt::format_to(out, "\n{:<7}", bench.counts[i]);
        for (std::size_t method = 0; method < kLightMethods; ++method) {
            const LightsBenchPoint& point = bench.points[method][i];
            if (was_measured(point)) {
                fmt::format_to(
                    out, " {:>11.2f} {:>6.1f}x", lights_frame_summary(point.report).median,
                    cost_over_clustered(bench, method, i));
            } else {
                fmt::format_to(out, " {:>19}", "-");
                left_out += fmt::format(
                    "- {}, {} lights: {}\n", kMethodNames[method], point.lights, point.left_out);
            }
        }
    }
    const LightsBenchPoint& most = bench.points[kClustered].back();
    fmt::format_to(out, "\n{}\nPasses of clustered, {} lights [ms]:\n", left_out, most.lights);
    for (const BenchSeries& series : most.report.series) {
        if (series.kind == BenchKind::Pass && series.clock == BenchClock::Gpu) {
            fmt::format_to(
                out, "  {:<24} {:>9.3f}\n", series.name, summarize(series.samples).median);
        }
    }
    return text;
}

std::string lights_bench_json(const LightsBench& bench) {
    nlohmann::ordered_json methods = nlohmann::ordered_json::array();
    for (std::size_t method = 0; method < kLightMethods; ++method) {
        nlohmann::ordered_json points = nlohmann::ordered_json::array();
        for (const LightsBenchPoint& point : bench.points[method]) {
            if (!was_measured(point)) {
                points.push_back({{"lights", point.lights}, {"left_out", point.left_out}});
                continue;
            }
            const Summary frame = lights_frame_summary(point.report);
            nlohmann::ordered_json passes = nlohmann::ordered_json::array();
            for (const BenchSeries& series : point.report.series) {
                if (series.kind == BenchKind::Pass && series.clock == BenchClock::Gpu) {
                    passes.push_back(
                        {{"name", series.name}, {"median_ms", summarize(series.samples).median}});
                }
            }
            points.push_back(
                {{"lights", point.lights},
                 {"frames", point.report.frames},
                 {"median_ms", frame.median},
                 {"p95_ms", frame.p95},
                 {"max_ms", frame.max},
                 {"passes", std::move(passes)}});
        }
        methods.push_back({{"name", kMethodNames[method]}, {"points", std::move(points)}});
    }
    nlohmann::ordered_json ratios = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < bench.counts.size(); ++i) {
        const double ratio = cost_over_clustered(bench, kFullScreen, i);
        if (ratio > 0) {
            ratios.push_back({{"lights", bench.counts[i]}, {"ratio", ratio}});
        }
    }
    const nlohmann::ordered_json json = {
        {"scene", bench.machine.scene},
        {"size", {bench.machine.size.x, bench.machine.size.y}},
        {"threads", bench.machine.threads},
        {"gl", {{"renderer", bench.machine.gl_renderer}, {"version", bench.machine.gl_version}}},
        {"methods", std::move(methods)},
        {"full_screen_over_clustered", std::move(ratios)}};
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string lights_bench_csv(const LightsBench& bench) {
    std::string text = "method,lights,frames,median_ms,p95_ms,max_ms\n";
    for (std::size_t method = 0; method < kLightMethods; ++method) {
        for (const LightsBenchPoint& point : bench.points[method]) {
            if (was_measured(point)) {
                const Summary frame = lights_frame_summary(point.report);
                fmt::format_to(
                    std::back_inserter(text), "{},{},{},{:.6f},{:.6f},{:.6f}\n",
                    kMethodNames[method], point.lights, point.report.frames, frame.median,
                    frame.p95, frame.max);
            }
        }
    }
    return text;
}

}  // namespace limn
