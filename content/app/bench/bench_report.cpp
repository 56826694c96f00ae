#include "content/app/bench/bench_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>
#include <utility>

namespace limn {
namespace {

constexpr BenchKind kReportKinds[] = {BenchKind::Frame, BenchKind::System, BenchKind::Pass};

constexpr double kShownMib = 0.05;  // the tables list what is at least as large
constexpr double kShownMs = 0.005;  // the table lists systems that take at least this long

const char* kind_name(BenchKind kind) {
    switch (kind) {
    case BenchKind::Frame:
        return "frame";
    case BenchKind::System:
        return "system";
    case BenchKind::Pass:
        return "pass";
    }
    return "";
}

const char* clock_name(BenchClock clock) {
    return clock == BenchClock::Cpu ? "cpu" : "gpu";
}

struct Line {
    const BenchSeries* series = nullptr;
    Summary summary;
};

std::vector<Line> lines_of(const BenchReport& report, BenchKind kind) {
    std::vector<Line> lines;
    for (const BenchSeries& series : report.series) {
        if (series.kind == kind) {
            lines.push_back({&series, summarize(series.samples)});
        }
    }
    return lines;
}

}  // namespace

BenchSeries&
find_series(BenchReport& report, BenchKind kind, BenchClock clock, std::string_view name) {
    for (BenchSeries& series : report.series) {
        if (series.kind == kind && series.clock == clock && series.name == name) {
            return series;
        }
    }
    BenchSeries series{.name = std::string(name), .kind = kind, .clock = clock, .samples = {}};
    series.samples.reserve(static_cast<std::size_t>(report.frames));
    return report.series.emplace_back(std::move(series));
}

std::string bench_table(const BenchReport& report) {
    std::string text;
    auto out = std::back_inserter(text);
    fmt::format_to(
        out,
        "{}, {} x {}, {} frames after {}, {} threads\n{}, OpenGL {}\n"
        "{} entities, {} boxes tested for {} instances in view, {} draws, {} triangles\n{:.0f} MiB "
        "resident ({:+.1f} since the warm-up), "
        "{:.0f} MiB of render "
        "targets\n{} shader programs, compiled and run once in {:.0f} ms; {} more later\n\n",
        report.scene, report.size.x, report.size.y, report.frames, report.warmup, report.threads,
        report.gl_renderer, report.gl_version, report.entities, report.tested_boxes,
        report.instances, report.draws, report.triangles, report.resident_mib,
        report.resident_mib - report.resident_begin_mib, report.gpu_mib,
        report.programs - report.compiled, report.compile_ms, report.compiled);
    fmt::format_to(out, "{:<34} {:>3} {:>11} {:>11} {:>11}\n", "[ms]", "", "median", "p95", "max");
    for (const BenchKind kind : kReportKinds) {
        std::vector<Line> lines = lines_of(report, kind);
        std::stable_sort(lines.begin(), lines.end(), [](const Line& a, const Line& b) {
            return a.summary.median > b.summary.median;
        });
        // Most systems have nothing to do in a level.
        const std::size_t left_out =
            kind != BenchKind::System ? 0 : std::erase_if(lines, [](const Line& line) {
                return line.summary.median < kShownMs && line.summary.max < 10 * kShownMs;
            });
        for (const Line& line : lines) {
            fmt::format_to(
                out, "{:<6} {:<27} {:>3} {:>11.3f} {:>11.3f} {:>11.3f}\n", kind_name(kind),
                line.series->name, clock_name(line.series->clock), line.summary.median,
                line.summary.p95, line.summary.max);
        }
        if (left_out > 0) {
            fmt::format_to(
                out, "system {} more, below {} each; --json and --csv have them\n", left_out,
                kShownMs);
        }
    }
    return report.stages ? text + bottleneck_text(*report.stages) : text;
}

std::string traffic_table(const BenchReport& report) {
    const auto largest_first = [](auto list, auto size) {
        std::stable_sort(list.begin(), list.end(), [&](const auto& a, const auto& b) {
            return size(a) > size(b);
        });
        return list;
    };
    const auto both = [](const BenchTraffic& one) { return one.read_mib + one.written_mib; };
    const auto mib = [](const BenchTarget& one) { return one.mib; };
    std::string text;
    auto out = std::back_inserter(text);
    BenchTraffic sum{.pass = "all passes"};
    fmt::format_to(out, "\n{:<34} {:>11} {:>11}\n", "[MiB], each texel once", "read", "written");
    for (const BenchTraffic& one : largest_first(report.traffic, both)) {
        sum.read_mib += one.read_mib;
        sum.written_mib += one.written_mib;
        if (both(one) >= kShownMib) {
            fmt::format_to(
                out, "pass   {:<27} {:>11.2f} {:>11.2f}\n", one.pass, one.read_mib,
                one.written_mib);
        }
    }
    fmt::format_to(
        out, "{:<34} {:>11.2f} {:>11.2f}\n\n{:<34} {:>11} {:>11} {:>11}\n", sum.pass, sum.read_mib,
        sum.written_mib, "render target", "pixels", "bytes/pixel", "MiB");
    for (const BenchTarget& one : largest_first(report.targets, mib)) {
        if (one.mib >= kShownMib) {
            fmt::format_to(
                out, "{:<34} {:>11} {:>11} {:>11.2f}\n", one.name + ", " + one.format,
                fmt::format("{}x{}", one.size.x, one.size.y), one.bytes_per_pixel, one.mib);
        }
    }
    return text;
}

std::string bench_json(const BenchReport& report) {
    nlohmann::ordered_json json = {
        {"scene", report.scene},
        {"size", {report.size.x, report.size.y}},
        {"frames", report.frames},
        {"warmup", report.warmup},
        {"threads", report.threads},
        {"gl", {{"renderer", report.gl_renderer}, {"version", report.gl_version}}},
        {"memory",
         {{"resident_begin_mib", report.resident_begin_mib},
          {"resident_mib", report.resident_mib},
          {"heap_begin_mib", report.heap_begin_mib},
          {"heap_mib", report.heap_mib},
          {"gpu_mib", report.gpu_mib}}},
        {"counts",
         {{"entities", report.entities},
          {"boxes_tested", report.tested_boxes},
          {"instances", report.instances},
          {"draws", report.draws},
          {"triangles", report.triangles},
          {"programs", report.programs},
          {"compiled", report.compiled}}},
        {"compile_ms", report.compile_ms}};
    if (report.stages) {
        json["stages"] = {
            {"application_ms", report.stages->application},
            {"geometry_ms", report.stages->geometry},
            {"rasterization_ms", report.stages->rasterization}};
    }
    for (const BenchKind kind : kReportKinds) {
        const char* key = kind == BenchKind::Frame    ? "frame"
                          : kind == BenchKind::System ? "systems"
                                                      : "passes";
        nlohmann::ordered_json array = nlohmann::ordered_json::array();
        for (const Line& line : lines_of(report, kind)) {
            array.push_back(
                {{"name", line.series->name},
                 {"clock", clock_name(line.series->clock)},
                 {"median_ms", line.summary.median},
                 {"p95_ms", line.summary.p95},
                 {"max_ms", line.summary.max}});
        }
        json[key] = std::move(array);
    }
    json["traffic"] = json["targets"] = nlohmann::ordered_json::array();
    for (const BenchTraffic& one : report.traffic) {
        json["traffic"].push_back(
            {{"pass", one.pass}, {"read_mib", one.read_mib}, {"written_mib", one.written_mib}});
    }
    for (const BenchTarget& one : report.targets) {
        json["targets"].push_back(
            {{"name", one.name},
             {"format", one.format},
             {"bytes_per_pixel", one.bytes_per_pixel},
             {"size", {one.size.x, one.size.y}},
             {"mib", one.mib}});
    }
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string bench_csv(const BenchReport& report) {
    std::string text = "kind,name,clock,median_ms,p95_ms,max_ms\n";
    for (const BenchKind kind : kReportKinds) {
        for (const Line& line : lines_of(report, kind)) {
            fmt::format_to(
                std::back_inserter(text), "{},{},{},{:.6f},{:.6f},{:.6f}\n", kind_name(kind),
                line.series->name, clock_name(line.series->clock), line.summary.median,
                line.summary.p95, line.summary.max);
        }
    }
    return text;
}

}  // namespace limn
