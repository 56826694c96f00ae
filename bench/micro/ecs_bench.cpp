#include "bench/micro/ecs_access.h"
#include "bench/micro/ecs_compile.h"
#include "bench/micro/ecs_growth.h"
#include "bench/micro/ecs_iteration.h"
#include "bench/micro/ecs_measure.h"
#include "bench/micro/ecs_page.h"
#include "bench/micro/ecs_plot.h"
#include "bench/micro/ecs_report.h"
#include "bench/micro/ecs_snapshot.h"
#include "bench/micro/ecs_split.h"
#include "bench/micro/ecs_structure.h"
#include "bench/micro/ecs_systems.h"
#include "bench/micro/ecs_toggle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

// Benchmarks the ECS against raw arrays in the same process.
//
//     ecs_bench [--quick] [--only GROUP] [--json FILE] [--csv FILE] [--svg FILE] [--markdown FILE]
//               [--other FILE] [--from FILE]
//
// The ECS and the raw loop alternate, 15 times (7 where each repeat needs a new world); the median
// of each counts, and on a loaded machine also the best. Times are per entity, unless the unit says
// otherwise, followed by their ratio to the raw loop and to R: position += velocity * step over a
// million raw rows, alternating with the rest. If the figure has a gate, the line says whether it
// is reached. Both sides compute the same; their results are compared bit by bit, so that neither
// can be optimized away or do less. One thread, unless the workload says otherwise.
//
// --only runs the groups whose name contains the word; --quick repeats less. --from reads the JSON
// of an earlier run instead of measuring, --other that of a run with other compiler flags, to show
// next to it: ecs_bench_o2 is the same program with the flags of this project.

namespace {

using namespace limn;
using namespace limn::bench;

struct Options {
    bool quick = false;
    std::string only;  ///< the groups whose name contains it
    std::string from;
    std::string other;
    std::string json;
    std::string csv;
    std::string svg;
    std::string markdown;
};

/// False: wrong usage.
bool parse(int argc, char** argv, Options& options) {
    const std::pair<std::string_view, std::string*> words[] = {
        {"--only", &options.only},         {"--from", &options.from}, {"--other", &options.other},
        {"--json", &options.json},         {"--csv", &options.csv},   {"--svg", &options.svg},
        {"--markdown", &options.markdown},
    };
    for (int i = 1; i < argc; ++i) {
        if (std::string_view(argv[i]) == "--quick") {
            options.quick = true;
            continue;
        }
        const auto* found = std::find_if(std::begin(words), std::end(words), [&](const auto& word) {
            return word.first == argv[i];
        });
        if (found == std::end(words) || i + 1 == argc) {
            return false;
        }
        *found->second = argv[++i];
    }
    return true;
}

std::string machine_text() {
    std::string processor = "unknown processor";
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("model name")) {
            processor = line.substr(line.find(':') + 2);
            break;
        }
    }
#if defined(__clang__)
    const std::string compiler = fmt::format("clang {}", __clang_version__);
#else
    const std::string compiler = fmt::format("gcc {}", __VERSION__);
#endif
    return fmt::format(
        "{}, {} cores, {}", processor, std::thread::hardware_concurrency(), compiler);
}

/// Empty, with an error, where no group has such a name.
std::optional<Report> measure(const Options& options, bool& failed) {
    register_component<Position>();
    register_component<Velocity>();
    register_component<Rotation>();
    register_component<Turn>();
    register_component<Tint>();
    register_component<Life>();
    register_component<Scale>();
    Bench bench;
    bench.report.flags = LIMN_BENCH_FLAGS;
    bench.report.machine = machine_text();
    if (options.quick) {
        bench.repeats = 5;
        bench.slow_repeats = 3;
    }
    const std::size_t largest = options.quick ? 1'000'000 : 10'000'000;
    const std::pair<std::string_view, std::function<void()>> groups[] = {
        {"iteration", [&] { iteration(bench); }},
        {"layouts", [&] { raw_layouts(bench); }},
        {"fragmented", [&] { fragmented(bench); }},
        {"churn", [&] { after_churn(bench); }},
        {"create", [&] { create(bench); }},
        {"destroy", [&] { destroy(bench); }},
        {"add", [&] { add_and_remove(bench); }},
        {"toggle", [&] { toggles(bench); }},
        {"deferred", [&] { deferred(bench); }},
        {"get", [&] { random_get(bench, kCached, 4.7), random_get(bench, kMany, 18); }},
        {"memory", [&] { memory(bench); }},
        {"changed", [&] { changed(bench); }},
        {"split", [&] { split(bench); }},
        {"schedule", [&] { empty_schedule(bench); }},
        {"threads", [&] { on_threads(bench); }},
        {"hash", [&] { hashes(bench), hash_time(bench); }},
        {"snapshot", [&] { snapshot(bench); }},
        {"compile", [&] { compile_time(bench); }},
        {"doubling", [&] { doubling(bench); }},
        {"growth", [&] { growth(bench, largest); }},
    };
    const auto is_wanted = [&](const auto& group) {
        return group.first.find(options.only) != std::string_view::npos;
    };
    if (std::none_of(std::begin(groups), std::end(groups), is_wanted)) {
        fmt::print(stderr, "ecs_bench: found --only {}, expected part of:", options.only);
        for (const auto& [name, run] : groups) {
            fmt::print(stderr, " {}", name);
        }
        fmt::print(stderr, "\n");
        return std::nullopt;
    }
    fmt::print("{}; {}\n{}", bench.report.machine, bench.report.flags, table_head());
    for (const auto& group : groups) {
        if (is_wanted(group)) {
            group.second();
        }
    }
    failed = bench.failed;
    return bench.report;
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    if (!parse(argc, argv, options)) {
        fmt::print(
            stderr,
            "usage: ecs_bench [--quick] [--only GROUP] [--json FILE] [--csv FILE] [--svg FILE] "
            "[--markdown FILE] [--other FILE] [--from FILE]\n");
        return 2;
    }
    bool failed = false;
    std::optional<Report> other;
    if (!options.other.empty()) {
        other = read_report(options.other);
        failed = !other.has_value();
    }
    const std::optional<Report> report =
        options.from.empty() ? measure(options, failed) : read_report(options.from);
    if (!report.has_value()) {
        return options.from.empty() ? 2 : 1;
    }
    const Report* beside = other.has_value() ? &*other : nullptr;
    const auto write = [&](const std::string& path, const auto& make) {
        if (!path.empty() && !write_file(path, make())) {
            failed = true;
        }
    };
    write(options.json, [&] { return to_json(*report); });
    write(options.csv, [&] { return to_csv(*report); });
    write(options.svg, [&] { return to_svg(*report, beside); });
    write(options.markdown, [&] {
        return to_markdown(*report, beside, options.svg.substr(options.svg.rfind('/') + 1));
    });
    return failed ? 1 : 0;
}
