#pragma once

#include "content/app/bench/bottleneck.h"
#include "content/app/bench/frame_statistics.h"
#include "ecs/base/math.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// The numbers of a bench run and its three output formats. All times in milliseconds.

enum class BenchClock : std::uint8_t { Cpu, Gpu };
enum class BenchKind : std::uint8_t { Frame, System, Pass };

/// Times of one system, pass or part of the frame, one sample per frame.
struct BenchSeries {
    std::string name;
    BenchKind kind = BenchKind::Frame;
    BenchClock clock = BenchClock::Cpu;
    std::vector<double> samples;  ///< [ms]
};

/// Memory that a pass touches at least (PassTraffic).
struct BenchTraffic {
    std::string pass;
    double read_mib = 0;
    double written_mib = 0;
};
/// A render target (TargetCost).
struct BenchTarget {
    std::string name;
    std::string format;
    int bytes_per_pixel = 0;
    IVec2 size = {0, 0};  ///< [pixels]
    double mib = 0;
};

struct BenchReport {
    std::string scene = {};
    IVec2 size = {0, 0};  ///< [pixels]
    int frames = 0;
    int warmup = 0;
    int threads = 0;
    std::string gl_renderer = {};
    std::string gl_version = {};
    double resident_begin_mib = 0.0;  ///< memory of the process before the measured frames
    double resident_mib = 0.0;        ///< the same after them
    double heap_begin_mib = 0.0;      ///< of it, allocated heap: the minimum over some frames
    double heap_mib = 0.0;
    double gpu_mib = 0.0;  ///< textures and buffers in the frame graph's pool
    std::int64_t entities = 0;
    std::int64_t draws = 0;      ///< of the last frame
    std::int64_t triangles = 0;  ///< of the last frame
    int instances = 0;           ///< in view, of the last frame
    int tested_boxes = 0;        ///< FrameStatistics::tested_boxes of the last frame
    int programs = 0;            ///< shader programs, after the last frame
    int compiled = 0;            ///< of them, in the measured frames
    double compile_ms = 0.0;     ///< before the first frame, for all programs that the level needs
    std::optional<PipelineTimes> stages = {};  ///< with --bottleneck
    std::vector<BenchSeries> series = {};
    std::vector<BenchTraffic> traffic = {};  ///< of the last frame, in the order of its passes
    std::vector<BenchTarget> targets = {};   ///< of the last frame
};

/// Returns the series of that name, adding it on first use.
BenchSeries&
find_series(BenchReport& report, BenchKind kind, BenchClock clock, std::string_view name);

/// A text table under a summary of the run, slowest first within each kind.
[[nodiscard]] std::string bench_table(const BenchReport& report);
/// A text table of what passes read and write, and of the render targets, largest first.
[[nodiscard]] std::string traffic_table(const BenchReport& report);
/// The schema is in `limn bench --help`.
[[nodiscard]] std::string bench_json(const BenchReport& report);
/// kind,name,clock,median_ms,p95_ms,max_ms
[[nodiscard]] std::string bench_csv(const BenchReport& report);

}  // namespace limn
