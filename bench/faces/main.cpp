// The program behind `limn bench faces`. Fails with 1 where a report cannot be written or nothing
// can be drawn, not where a limit is missed.
#include "bench/faces/face_crowd.h"
#include "bench/faces/face_rows.h"
#include "bench/parse_arguments.h"
#include "bench/report_files.h"
#include "ecs/base/jobs.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <string>

int main(int argc, char** argv) {
    using namespace limn;
    CLI::App app("A crowd of faces: what it costs to move them, to measure and to draw their skin");
    std::string csv;
    std::string json;
    std::string svg;
    std::string only;
    bench::FaceBench bench;
    app.add_option("--csv", csv, "write the numbers as CSV; - is stdout");
    app.add_option("--json", json, "write the numbers as JSON; - is stdout");
    app.add_option("--svg", svg, "draw the cost per face over their number");
    app.add_option("--only", only, "one part")
        ->check(CLI::IsMember({"measure", "deform", "growth", "pixels", "furrows"}));
    app.add_option("--repeats", bench.repeats, "runs of each at most, of which the best counts")
        ->check(CLI::Range(1, 1000));
    if (const auto stop = bench::parse_arguments(app, "limn bench faces", argc, argv)) {
        return *stop;
    }

    bench.quiet = csv == "-" || json == "-";
    const auto wanted = [&](const char* part) { return only.empty() || only == part; };
    if (!bench.quiet) {
        fmt::print(
            "{} faces of {} vertices and {} triangles, {} threads; the best of many runs in "
            "turns\n",
            bench::kCrowd, bench::face_crowd().mesh.positions.size(),
            bench::face_crowd().mesh.indices.size() / 3, thread_count());
    }
    if (wanted("measure")) {
        add_measure_rows(bench);
    }
    if (wanted("deform")) {
        add_deform_rows(bench);
    }
    if (wanted("growth")) {
        add_face_growth(bench);
    }
    if (wanted("pixels")) {
        if (const Status drawn = add_pixel_rows(bench); !drawn) {
            fmt::print(stderr, "limn bench: {}\n", drawn.error().message);
            return 1;
        }
    }
    if (wanted("furrows")) {
        if (const Status drawn = add_furrow_rows(bench); !drawn) {
            fmt::print(stderr, "limn bench: {}\n", drawn.error().message);
            return 1;
        }
    }
    const bool written = bench::write_reports(
        {{csv, face_bench_csv(bench)},
         {json, face_bench_json(bench)},
         {svg, face_bench_svg(bench)}});
    return written ? 0 : 1;
}
