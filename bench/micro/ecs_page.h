#pragma once

#include "bench/micro/ecs_plot.h"
#include "bench/micro/ecs_report.h"

#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>

// The page of a run, as Markdown: the gates with what there is to say about each, then everything
// that was measured.

namespace limn::bench {

/// What is to be said about a gate, beyond the number.
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
     "than the gate; what the call adds is in the table below, and small with either flags."},
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
     "Two moves of a row, out and into the hole it leaves, bound by instructions and not by "
     "memory, "
     "so that a small R makes the gate hard."},
    {12, "EnTT 15 R", ""},
    {13, "none", ""},
    {14, "EnTT by hand 24 R, flecs 112 R", ""},
    {15, "EnTT 37 R, flecs 497 R", ""},
    {16, "mustache 3.7 R / EnTT 18 R",
     "One at a time, a million entities cost two misses each, slot and row; gather() fetches both "
     "ahead."},
    {17, "EnTT, flecs 72.5 B", ""},
    {18, "none", ""},
    {19, "none",
     "Two cores are what there is. For more of them: ranges are cut once and handed out without a "
     "lock, and what a task adds (below) is less than a hundredth of the work of its chunk."},
    {20, "none", ""},
    {21, "none", ""},
    {22, "flecs 1.1 s", "At -O2 in both columns: it is the time of the compiler."},
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

/// Every row that is no gate, or all of them.
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

/// `plot`: the name of the picture's file beside the page; empty: none.
[[nodiscard]] inline std::string
to_markdown(const Report& report, const Report* other, const std::string& plot) {
    std::string text = fmt::format(
        "# The ECS beside raw arrays\n\n"
        "Written by `ecs_bench`; {}. Times are medians, taken in turns with those of the raw loop "
        "in the same process. `x raw` is the time over that of the raw loop beside it, which "
        "computes the same (the results are compared to the last bit). `R` is `position += "
        "velocity * step` over a million rows in two `std::vector`s. The gates come from a study "
        "of other libraries on a slower machine of the same kind, where R was 0.925 ns; here "
        "memory is quicker and R smaller, which makes every gate in R harder by as much.\n\n",
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
        "were; `ecs_bench_o2` with the flags of this project. In both, loops begin with a line of "
        "the cache (`-falign-loops=64`): where a loop of a few instructions happens to begin "
        "changes its time by up to 1.8, with and without an ECS.\n");
    return text;
}

}  // namespace limn::bench
