// The program behind `limn bench particles`. Fails with 1 where a report cannot be written, not
// where a gate is missed.
#include "bench/parse_arguments.h"
#include "bench/particles/particle_race.h"
#include "bench/particles/particle_rows.h"
#include "bench/report_files.h"
#include "ecs/base/jobs.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <string>

int main(int argc, char** argv) {
    using namespace limn;
    CLI::App app("Particles against loops written by hand, and their cost by number");
    std::string csv;
    std::string json;
    std::string svg;
    std::string only;
    std::size_t most = 10'000'000;
    app.add_option("--csv", csv, "write the numbers as CSV; - is stdout");
    app.add_option("--json", json, "write the numbers as JSON; - is stdout");
    app.add_option("--svg", svg, "draw the cost per particle over their number");
    app.add_option("--only", only, "one part")
        ->check(CLI::IsMember({"update", "sort", "collision", "world", "draw", "growth"}));
    app.add_option("--most", most, "particles of the last point of the curves")
        ->check(CLI::Range(std::size_t{1000}, std::size_t{100'000'000}));
    app.add_option(
           "--repeats", bench::max_repeats, "runs of each at most, of which the best counts")
        ->check(CLI::Range(1, 400));
    if (const auto stop = bench::parse_arguments(app, "limn bench particles", argc, argv)) {
        return *stop;
    }

    bench::ParticleBench bench;
    bench.quiet = csv == "-" || json == "-";
    if (!bench.quiet) {
        fmt::print(
            "{} threads; times per particle, the best of many runs in turns\n", thread_count());
    }
    const auto wanted = [&](const char* part) { return only.empty() || only == part; };
    if (wanted("update")) {
        add_update_rows(bench);
    }
    if (wanted("sort")) {
        add_sort_rows(bench);
    }
    if (wanted("collision")) {
        add_collision_rows(bench);
    }
    if (wanted("world")) {
        add_world_rows(bench);
    }
    if (wanted("draw")) {
        add_draw_rows(bench);
    }
    if (wanted("growth")) {
        add_growth(bench, most);
    }
    const auto met =
        std::count_if(bench.gates.begin(), bench.gates.end(), [](const bench::GateRow& row) {
            return row.is_met();
        });
    if (!bench.quiet) {
        fmt::print("{} of {} gates met\n", met, bench.gates.size());
    }
    const bool written = bench::write_reports(
        {{csv, particle_bench_csv(bench)},
         {json, particle_bench_json(bench)},
         {svg, particle_bench_svg(bench)}});
    return written ? 0 : 1;
}
