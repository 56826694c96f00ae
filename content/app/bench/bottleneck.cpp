#include "content/app/bench/bottleneck.h"

#include "content/app/bench/bench_command.h"
#include "content/app/bench/bench_report.h"
#include "content/app/bench/frame_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

// Techniques: engine.bottleneck
// Shown by `limn bench gallery --size 320x180 --frames 30 --bottleneck`: engine.bottleneck

namespace limn {
namespace {

constexpr int kFewPixels = 8;  // times fewer in each direction

double median_frame(
    Stage& stage, HeadlessRenderer& headless, const IVec2& size, int frames, bool few_triangles) {
    BenchReport report;
    for (int i = 0; i < frames / 3 + 1 + frames; ++i) {
        const bool counts = i > frames / 3;
        run_bench_frame(stage, headless, size, counts ? &report : nullptr, few_triangles);
    }
    return summarize(find_series(report, BenchKind::Frame, BenchClock::Cpu, "frame").samples)
        .median;
}

}  // namespace

PipelineStage find_bottleneck(const PipelineTimes& times) {
    const double period = frame_period(times);
    return times.application == period ? PipelineStage::Application
           : times.geometry == period  ? PipelineStage::Geometry
                                       : PipelineStage::Rasterization;
}

double frame_period(const PipelineTimes& times) {
    return std::max({times.application, times.geometry, times.rasterization});
}

double frame_latency(const PipelineTimes& times) {
    return times.application + times.geometry + times.rasterization;
}

PipelineTimes times_of_experiments(double whole, double few_pixels, double least) {
    return {
        .application = least,
        .geometry = std::max(few_pixels - least, 0.0),
        .rasterization = std::max(whole - few_pixels, 0.0)};
}

PipelineTimes
measure_stages(Stage& stage, HeadlessRenderer& headless, const IVec2& size, int frames) {
    const IVec2 few = glm::max(size / kFewPixels, IVec2(16));
    const double whole = median_frame(stage, headless, size, frames, false);
    const double few_pixels = median_frame(stage, headless, few, frames, false);
    return times_of_experiments(
        whole, few_pixels, median_frame(stage, headless, few, frames, true));
}

std::string bottleneck_text(const PipelineTimes& times) {
    const std::pair<const char*, double> stages[] = {
        {"application", times.application},
        {"geometry", times.geometry},
        {"rasterization", times.rasterization}};
    std::string text = "\nStages of the pipeline [ms]\n";
    auto out = std::back_inserter(text);
    const double longest = std::max(frame_period(times), 1e-9);
    for (const auto& [name, ms] : stages) {
        fmt::format_to(
            out, "  {:<14} {:>8.2f}  {}\n", name, ms,
            std::string(static_cast<std::size_t>(40 * ms / longest), '='));
    }
    fmt::format_to(
        out, "  bound by {}: {:.1f} frames a second if the stages overlap, {:.2f} ms latency\n",
        stages[static_cast<std::size_t>(find_bottleneck(times))].first, 1000 / longest,
        frame_latency(times));
    return text;
}

}  // namespace limn
