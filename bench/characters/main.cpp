// The program behind `limn bench characters`. Fails with 1 where a report cannot be written, not
// where a gate is missed.
#include "bench/characters/character_rows.h"
#include "bench/parse_arguments.h"
#include "bench/report_files.h"
#include "ecs/base/jobs.h"
#include "systems/animation/pose_chain.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>

int main(int argc, char** argv) {
    using namespace limn;
    CLI::App app("Many characters next to scalar loops: clips, poses, skins");
    std::string csv;
    std::string json;
    std::string only;
    bench::CharacterBench bench;
    std::set<std::string> names;
    for (const bench::CharacterPart& part : bench::character_parts()) {
        names.insert(part.name);
    }
    app.add_option("--csv", csv, "write the numbers as CSV; - is stdout");
    app.add_option("--json", json, "write the numbers as JSON; - is stdout");
    app.add_option("--only", only, "one part")->check(CLI::IsMember(names));
    app.add_option("--repeats", bench.repeats, "runs of each at most, of which the best counts")
        ->check(CLI::Range(1, 1000));
    if (const auto stop = bench::parse_arguments(app, "limn bench characters", argc, argv)) {
        return *stop;
    }

    bench.quiet = csv == "-" || json == "-";
    bench.vector_factor = pose_vector_floats() >= 16 ? 1.0 : 1.6;
    if (!bench.quiet) {
        fmt::print(
            "{} threads, vectors of {} floats; the best of many runs in turns\n", thread_count(),
            pose_vector_floats());
    }
    for (const bench::CharacterPart& part : bench::character_parts()) {
        if (only.empty() || only == part.name) {
            part.add(bench);
        }
    }
    if (!bench.quiet) {
        const auto gates =
            std::count_if(bench.rows.begin(), bench.rows.end(), [](const bench::CharacterRow& row) {
                return row.limit > 0;
            });
        const auto met =
            std::count_if(bench.rows.begin(), bench.rows.end(), [](const bench::CharacterRow& row) {
                return row.limit > 0 && row.is_met();
            });
        fmt::print("{} of {} gates met\n", met, gates);
    }
    const bool written = bench::write_reports(
        {{csv, character_bench_csv(bench)}, {json, character_bench_json(bench)}});
    return written ? 0 : 1;
}
