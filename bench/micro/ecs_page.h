#pragma once

#include "bench/micro/ecs_plot.h"
#include "bench/micro/ecs_report.h"

#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>

// The Markdown report of a run: the gates with remarks, then everything that was measured.

namespace limn::bench {

/// A remark on a gate.
struct Remark {
    int gate;
    std::string_view peer;  ///< the best other library, on the machine where it was measured
    std::string_view text;
};

inline constexpr std::array<Remark, 23> kRemarks = {{
    {1, "flecs 0.97x", ""},
    {2, "mustache 1.09x", ""},
    {3, "flecs 0.88-0.99x", ""},
    {4, "flecs 0.94x", ""},
    {5, "EnTT raw group 22 ns",
     "With its 64 rows. g++ 12 leaves the loop scalar at -O2, where the raw loop alone takes "
     "longer "
     "than the gate; the overhead of the call is in the table below, and small with either flags."},
    {6, "flecs 4.8x",
     "Vectorized, the raw loop spends 1.8 ns on an array of 20 floats; finding the column of an "
     "archetype and noting its version adds 1.1 ns."},
    {7, "flecs 0.97x, EnTT view 13.8x", ""},
    {8, "flecs 15 R", ""},
    {9, "EnTT 55 R",
     "Mostly the first touch of fresh memory, which the raw loop pays as well: see the row with "
     "memory used before."},
    {10, "flecs 26 / 15 R", ""},
    {11, "EnTT 15 R, flecs 52-67 R",
     "Two moves of a row, out and into the hole it leaves; instruction-bound, not memory-bound, so "
     "that a small R makes the gate hard."},
    {12, "EnTT 15 R", ""},
    {13, "none", ""},
    {14, "EnTT by hand 24 R, flecs 112 R", ""},
    {15, "EnTT 37 R, flecs 497 R", ""},
    {16, "mustache 3.7 R / EnTT 18 R",
     "One at a time, each of a million entities costs two cache misses, slot and row; gather() "
     "prefetches both."},
    {17, "EnTT, flecs 72.5 B", ""},
    {18, "none", ""},
    {19, "none",
     "The machine has two cores. For scaling beyond: ranges are split once and handed out without "
     "a lock, and the overhead of a task (below) is less than a hundredth of the work of its "
     "chunk."},
    {20, "none", ""},
    {21, "none", ""},
    {22, "flecs 1.1 s", "At -O2 in both columns: it is compile time."},
    {23, "none", ""},
}};

[[nodiscard]] inline const Remark& remark_of(int gate) {
    return kRemarks[static_cast<std::size_t>(gate - 1)];
}

[[nodiscard]] inline std::string gate_table(const Report& report, const Report* other) {
    std::string text = fmt::format("| # | workload | gate | {} |", report.flags);
    text += other != nullptr ? fmt::format(" {} |", other->flags) : "";
    text += " best peer, elsewhere | |\n|--:|---|--:|--:|";
    text += other != nullptr ? "--:|" : "";
    text += "---|---|\n";
    const auto cell = [](const Row& row) {
        const std::string figure = short_number(figure_of(row, &Timing::median)) + figure_unit(row);
        const std::string_view word = verdict(row);
        return word == "reached"         ? fmt::format("{} ✓", figure)
               : word == "best run only" ? fmt::format(
                     "{} (best run {})", figure, short_number(figure_of(row, &Timing::best)))
                                         : fmt::format("**{}**", figure);
    };
    int last = 0;
    for (const Row* row : gate_rows(report)) {
        const Row* second = same_row(other, *row);
        text += fmt::format(
            "| {} | {}{} | {} | {} |", row->gate, row->name, short_count(row->count),
            gate_text(*row), cell(*row));
        if (other != nullptr) {
            text += fmt::format(" {} |", second != nullptr ? cell(*second) : "");
        }
        const bool first = row->gate != last;
        last = row->gate;
        text += fmt::format(
            " {} | {} |\n", first ? remark_of(row->gate).peer : "",
            first ? remark_of(row->gate).text : "");
    }
    return text;
}

/// All rows.
[[nodiscard]] inline std::string full_table(const Report& report, const Report* other) {
    const auto number = [](double value) {
        return value == 0 ? std::string() : short_number(value);
    };
    std::string head = "| workload | entities | unit |";
    std::string rule = "|---|--:|---|";
    for (const Report* run : {&report, other}) {
        if (run != nullptr) {
            head += fmt::format(" {} | raw | x raw | x R |", run->flags);
            rule += "--:|--:|--:|--:|";
        }
    }
    std::string text = head + "\n" + rule + "\n";
    for (const Row& row : report.rows) {
        text += fmt::format("| {} | {} | {} |", row.name, row.count, row.unit);
        const Row* second = same_row(other, row);
        for (const Row* shown : {&row, second}) {
            if (shown != nullptr) {
                text += fmt::format(
                    " {} | {} | {} | {} |", number(shown->ecs.median), number(shown->raw.median),
                    number(over(shown->ecs.median, shown->raw.median)),
                    number(over(shown->ecs.median, shown->reference.median)));
            }
        }
        text += "\n";
    }
    return text;
}

/// `plot`: file name of the plot, next to the page; empty: none.
[[nodiscard]] inline std::string
to_markdown(const Report& report, const Report* other, const std::string& plot) {
    std::string text = fmt::format(
        "# The ECS compared with raw arrays\n\n"
        "Written by `ecs_bench`; {}. Times are medians, alternating with those of the raw loop in "
        "the same process. `x raw` is the time relative to the equivalent raw loop (the results "
        "are compared bit by bit). `R` is `position += "
        "velocity * step` over a million rows in two `std::vector`s. The gates come from a study "
        "of other libraries on a slower machine of the same kind, where R was 0.925 ns; here "
        "memory is faster and R smaller, which makes every gate in units of R harder "
        "accordingly.\n\n",
        report.machine);
    if (!plot.empty()) {
        text += fmt::format("![times and gates]({})\n\n", plot);
    }
    text += "## Gates\n\n" + gate_table(report, other);
    text += "\n✓ reached. Bold: not reached. \"Best peer\" is the figure of that study.\n\n";
    text += "## Everything measured\n\n" + full_table(report, other);
    text += fmt::format(
        "\n## How\n\n"
        "```\n"
        "cmake --build build --target ecs_bench ecs_bench_o2   # Release\n"
        "build/ecs_bench_o2 --json ecs_o2.json --csv ecs_o2.csv\n"
        "build/ecs_bench --other ecs_o2.json --json ecs.json --csv ecs.csv --svg ecs.svg "
        "--markdown ecs.md\n"
        "```\n\n"
        "`ecs_bench` is compiled with `-O3 -march=native`, the library too, as the other libraries "
        "were; `ecs_bench_o2` with the flags of this project. In both, loops are aligned to cache "
        "lines (`-falign-loops=64`): the alignment of a short loop changes its time by a factor of "
        "up to 1.8, with and without an ECS.\n");
    return text;
}

}  // namespace limn::bench
