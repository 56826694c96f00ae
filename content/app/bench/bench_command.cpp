#include "content/app/bench/bench_command.h"

#include "content/app/bench/bench_fakephong.h"
#include "content/app/bench/bench_forms.h"
#include "content/app/bench/bench_lens.h"
#include "content/app/bench/bench_lights.h"
#include "content/app/bench/bench_report.h"
#include "content/app/bench/bench_surfaces.h"
#include "content/app/bench/bench_tables.h"
#include "content/app/commands/headless.h"
#include "content/app/commands/progress.h"
#include "content/app/commands/sibling_program.h"
#include "content/app/commands/stage.h"
#include "content/app/panels/profiler_panel.h"
#include "content/load/files/atomic_file.h"
#include "ecs/base/jobs.h"
#include "ecs/base/text.h"
#include "render/graph/frame_graph.h"
#include "render/render_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <limits>
#include <string>
#include <utility>

namespace limn {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr const char* kLightsScene =
    "lights";                      ///< by name, not by file: measured by light count and method
constexpr int kHeapFrames = 600;   ///< last ones, whose minimum of heap memory counts; at least a
                                   ///< whole camera path
constexpr int kHeapInterval = 60;  ///< frames between heap measurements
constexpr const char* kParticlesName = "particles";  ///< likewise: particle pools, without a scene
constexpr const char* kFacesName = "faces";          ///< likewise: a crowd of heads
constexpr const char* kCharactersName = "characters";  ///< likewise: poses of crowds
constexpr const char* kLensName = "lens";            ///< not a scene: the lens effects, one by one
constexpr const char* kFormsName = "forms";          ///< not a scene: forms of a shader
constexpr const char* kTablesName = "tables";        ///< not a scene: hash tables
constexpr const char* kSurfacesName = "surfaces";    ///< not a scene: kinds of surface detail
constexpr const char* kFakePhongName = "fakephong";  ///< not a scene: the methods of shading

/// Whether another program runs this benchmark.
bool is_program(const std::string& scene) {
    return scene == kParticlesName || scene == kFacesName || scene == kCharactersName;
}

double ms_between(SteadyClock::time_point begin, SteadyClock::time_point end) {
    return std::chrono::duration<double, std::milli>(end - begin).count();
}

/// To the file, or to stdout for "-".
Status write_report(const std::string& path, const std::string& text) {
    if (path == "-") {
        fmt::print("{}", text);
        return Done{};
    }
    return path.empty() ? Status(Done{}) : write_file(path, text);
}

/// Writes what was asked for: `json` and `csv` as text, the table unless one of them goes to
/// stdout.
Status write_results(
    const BenchOptions& options, const std::string& table, const std::string& json,
    const std::string& csv) {
    if (options.json != "-" && options.csv != "-") {
        fmt::print("{}", table);
    }
    const Status written = write_report(options.json, json);
    return written ? write_report(options.csv, csv) : written;
}

/// CPU time of this process, including threads of a software OpenGL [ms]: depends less
/// on other programs than the frame time.
double all_threads_ms() {
    std::timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

/// Fails if the device cannot render images of that size.
Result<HeadlessRenderer> create_renderer_for(const BenchOptions& options) {
    Result<HeadlessRenderer> headless =
        create_headless_renderer(options.profile, {}, options.renderer);
    if (headless) {
        if (const Status fits = check_image_size(*headless->device, options.size); !fits) {
            return fits.error();
        }
    }
    return headless;
}

Status run_lens_bench(const BenchOptions& options) {
    Result<HeadlessRenderer> headless = create_renderer_for(options);
    if (!headless) {
        return headless.error();
    }
    const Result<LensBench> bench = measure_lens(options, *headless);
    if (!bench) {
        return bench.error();
    }
    return write_results(
        options, lens_bench_table(*bench), lens_bench_json(*bench), lens_bench_csv(*bench));
}

Status run_surfaces_bench(const BenchOptions& options) {
    HeadlessRenderer headless = LIMN_TRY(create_renderer_for(options));
    const SurfaceBench bench = LIMN_TRY(measure_surfaces(options, headless));
    return write_results(
        options, surface_bench_table(bench), surface_bench_json(bench), surface_bench_csv(bench));
}

Status run_forms_bench(const BenchOptions& options) {
    const HeadlessRenderer headless = LIMN_TRY(create_renderer_for(options));
    const FormBench bench = LIMN_TRY(measure_forms(*headless.device, options.size, options.frames));
    return write_results(
        options, form_bench_table(bench), form_bench_json(bench), form_bench_csv(bench));
}

Status run_tables_bench(const BenchOptions& options) {
    const TableBench bench = measure_tables(options.frames);
    return write_results(
        options, table_bench_text(bench), table_bench_json(bench), table_bench_csv(bench));
}

Status run_fakephong_bench(const BenchOptions& options) {
    HeadlessRenderer headless = LIMN_TRY(create_renderer_for(options));
    const FakePhongBench bench = LIMN_TRY(measure_fakephong(options, headless));
    return write_results(
        options, fakephong_bench_table(bench), fakephong_bench_json(bench),
        fakephong_bench_csv(bench));
}

/// Memory of the report itself, reserved with the last warm-up frame.
double memory_of_samples_mib(const BenchReport& report) {
    std::size_t bytes = 0;
    for (const BenchSeries& series : report.series) {
        bytes += series.samples.capacity() * sizeof(series.samples[0]);
    }
    return static_cast<double>(bytes) / (1 << 20);
}

/// Empties all series but keeps their memory resident, so that it does not count as growth.
void touch_samples(BenchReport& report) {
    for (BenchSeries& series : report.series) {
        series.samples.assign(static_cast<std::size_t>(report.frames), 0.0);
        series.samples.clear();
    }
}

void add_frame_buffer_cost(const FrameGraph& graph, BenchReport& report) {
    constexpr double kMib = 1 << 20;
    for (const PassTraffic& pass : graph.traffic()) {
        report.traffic.push_back(
            {std::string(pass.name), static_cast<double>(pass.read_bytes) / kMib,
             static_cast<double>(pass.written_bytes) / kMib});
    }
    for (const TargetCost& target : graph.targets()) {
        report.targets.push_back(
            {std::string(target.name),
             target.format,
             target.bytes_per_pixel,
             {target.width, target.height},
             static_cast<double>(target.bytes) / kMib});
    }
}

}  // namespace

void run_bench_frame(
    Stage& stage, HeadlessRenderer& headless, const IVec2& size, BenchReport* report,
    bool few_triangles) {
    FrameGraph& graph = frame_graph(*headless.renderer);
    const double begin_threads = all_threads_ms();
    const SteadyClock::time_point begin = SteadyClock::now();
    step_stage(stage);
    const SteadyClock::time_point simulated = SteadyClock::now();
    const RenderView view =
        make_render_view(stage.world, stage.scene.camera, {.width = size.x, .height = size.y});
    const FrameOutput frame = render_frame(
        *headless.renderer, stage.world, view, {.aovs = {}, .few_triangles = few_triangles});
    const SteadyClock::time_point drawn = SteadyClock::now();
    graph.wait_for_timings();
    const SteadyClock::time_point end = SteadyClock::now();
    const double threads = all_threads_ms() - begin_threads;
    if (report == nullptr) {
        return;
    }
    const auto add = [report](BenchKind kind, BenchClock clock, std::string_view name, double ms) {
        find_series(*report, kind, clock, name).samples.push_back(ms);
    };
    add(BenchKind::Frame, BenchClock::Cpu, "frame", ms_between(begin, end));
    add(BenchKind::Frame, BenchClock::Cpu, "all threads", threads);
    add(BenchKind::Frame, BenchClock::Cpu, "simulate", ms_between(begin, simulated));
    add(BenchKind::Frame, BenchClock::Cpu, "draw", ms_between(simulated, drawn));
    add(BenchKind::Frame, BenchClock::Cpu, "extract", frame.statistics.extract_ms);
    for (const SystemTiming& timing : stage.schedule.timings()) {
        add(BenchKind::System, BenchClock::Cpu, timing.name, timing.last * 1e3);
    }
    double gpu_ms = 0.0;
    for (const PassTiming& timing : graph.timings()) {
        add(BenchKind::Pass, BenchClock::Cpu, timing.name, timing.last_cpu_ms);
        add(BenchKind::Pass, BenchClock::Gpu, timing.name, timing.last_gpu_ms);
        gpu_ms += timing.last_gpu_ms;
    }
    add(BenchKind::Frame, BenchClock::Gpu, "passes", gpu_ms);
    report->draws = frame.statistics.draws;
    report->triangles = frame.statistics.triangles;
    report->instances = frame.statistics.visible_instances;
    report->tested_boxes = frame.statistics.tested_boxes;
    report->programs = frame.statistics.programs;
    report->compiled += frame.statistics.compiled;
}

BenchReport
machine_report(const Stage& stage, const HeadlessRenderer& headless, const BenchOptions& options) {
    return {
        .scene = stage.scene.name,
        .size = options.size,
        .threads = thread_count(),
        .gl_renderer = headless.device->caps().renderer,
        .gl_version = headless.device->caps().version};
}

std::vector<std::string> bench_program_arguments(const BenchOptions& options) {
    std::vector<std::string> arguments = {
        "--repeats", std::to_string(std::min(options.frames, 400))};
    for (const auto& [option, value] :
         {std::pair{"--json", options.json},
          {"--csv", options.csv},
          {"--svg", options.svg},
          {"--only", options.only},
          {"--most", options.most > 0 ? std::to_string(options.most) : std::string()}}) {
        if (!value.empty()) {
            arguments.insert(arguments.end(), {option, value});
        }
    }
    return arguments;
}

std::vector<Assignment> bench_assignments(const BenchOptions& options) {
    std::vector<Assignment> all = {
        {"rendering.level_rows", std::to_string(std::max(options.size.y, 16))}};
    all.insert(all.end(), options.assignments.begin(), options.assignments.end());
    return all;
}

Status check_bench_options(const BenchOptions& options) {
    if (options.most > 0 && options.scene != kParticlesName) {
        return fail("--most is for `particles`, found `{}`", options.scene);
    }
    if (!options.svg.empty() && options.scene != kParticlesName && options.scene != kFacesName) {
        return fail("--svg is for `particles` and `faces`, found `{}`", options.scene);
    }
    const bool is_scene = !is_program(options.scene) && options.scene != kLensName
                          && options.scene != kSurfacesName && options.scene != kTablesName
                          && options.scene != kFormsName && options.scene != kFakePhongName
                          && options.scene != kLightsScene;
    if (options.bottleneck && !is_scene) {
        return fail("--bottleneck is for scenes, found `{}`", options.scene);
    }
    if (options.targets && !is_scene) {
        return fail("--targets is for scenes, found `{}`", options.scene);
    }
    if (is_program(options.scene)) {
        return Done{};
    }
    if (!options.only.empty()) {
        return fail(
            "--only is for `particles`, `faces` and `characters`, found `{}`", options.scene);
    }
    return Done{};
}

Status run_bench(const BenchOptions& options) {
    if (is_program(options.scene)) {
        return run_sibling(
            "limn bench", "limn-bench-" + options.scene, bench_program_arguments(options));
    }
    if (options.scene == kLensName) {
        return run_lens_bench(options);
    }
    if (options.scene == kSurfacesName) {
        return run_surfaces_bench(options);
    }
    if (options.scene == kFormsName) {
        return run_forms_bench(options);
    }
    if (options.scene == kTablesName) {
        return run_tables_bench(options);
    }
    if (options.scene == kFakePhongName) {
        return run_fakephong_bench(options);
    }
    Result<std::unique_ptr<Stage>> opened =
        open_stage(options.scene, {.assignments = bench_assignments(options)});
    if (!opened) {
        return opened.error();
    }
    Stage& stage = **opened;
    Result<HeadlessRenderer> headless = create_renderer_for(options);
    if (!headless) {
        return headless.error();
    }
    if (options.scene == kLightsScene) {
        const Result<LightsBench> bench = measure_lights(stage, *headless, options);
        if (!bench) {
            return bench.error();
        }
        return write_results(
            options, lights_bench_table(*bench), lights_bench_json(*bench),
            lights_bench_csv(*bench));
    }
    BenchReport report = machine_report(stage, *headless, options);
    report.frames = options.frames;
    report.warmup = options.warmup;
    const SteadyClock::time_point begin = SteadyClock::now();
    warm_up_world(*headless, stage.world, stage.scene.camera, options.size);
    report.compile_ms = ms_between(begin, SteadyClock::now());
    report.resident_begin_mib = resident_memory_mib();
    report.heap_begin_mib = heap_memory_mib();
    {
        const int frames = options.warmup + options.frames;
        const int path = static_cast<int>(stage.scene.duration / stage_step(stage));
        const int heap_frames = std::max(kHeapFrames, path);
        Progress progress("frame", frames);
        for (int i = 0; i < frames; ++i) {
            // The last warm-up frame names the series.
            const bool reported = i + 1 >= options.warmup;
            run_bench_frame(stage, *headless, options.size, reported ? &report : nullptr);
            const int left = (i < options.warmup ? options.warmup : frames) - (i + 1);
            if (i == 0 || i == options.warmup) {
                report.heap_mib = std::numeric_limits<double>::infinity();
            }
            if (left < heap_frames && left % kHeapInterval == 0) {
                glFinish();  // the driver keeps more while frames are in flight
                report.heap_mib = std::min(report.heap_mib, heap_memory_mib());
            }
            if (i + 1 == options.warmup) {
                touch_samples(report);
                report.compiled = 0;
                report.resident_begin_mib = resident_memory_mib();
                report.heap_begin_mib = report.heap_mib + memory_of_samples_mib(report);
            }
            progress.update(i + 1);
        }
    }
    report.entities = static_cast<std::int64_t>(stage.world.entity_count());
    report.resident_mib = resident_memory_mib();
    report.gpu_mib =
        static_cast<double>(frame_graph(*headless->renderer).stats().pool_bytes) / (1 << 20);
    add_frame_buffer_cost(frame_graph(*headless->renderer), report);
    if (options.bottleneck) {
        report.stages = measure_stages(stage, *headless, options.size, options.frames);
    }
    return write_results(
        options, bench_table(report) + (options.targets ? traffic_table(report) : ""),
        bench_json(report), bench_csv(report));
}

}  // namespace limn
