#pragma once

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// The results of ecs_bench as a table, CSV and JSON. Reads the JSON back, to compare two runs.
// ecs_plot.h and ecs_page.h produce a plot and a page.

namespace limn::bench {

/// Over the repeats of one measurement [ns per item].
struct Timing {
    double median = 0;
    double best = 0;
};

/// What a gate bounds.
enum class Figure {
    OfRaw,        ///< time relative to the equivalent raw loop
    OfReference,  ///< time over R: position += velocity * step on 1M raw rows
    Plain,        ///< the time itself, or another number
    Speedup,      ///< raw loop's time over the time
};
inline constexpr std::array<std::string_view, 4> kFigureNames = {"raw", "R", "plain", "speedup"};

struct Row {
    int gate = 0;  ///< number in the list of gates; 0: none
    std::string name;
    std::size_t count = 0;  ///< entities
    std::string unit;       ///< of the times
    Timing ecs;             ///< what is measured
    Timing raw;             ///< the same without ECS; 0: no equivalent
    Timing reference;       ///< R, measured alternately with the others
    Figure figure = Figure::OfRaw;
    double limit = 0;   ///< upper bound; lower bound of a speedup; 0: no gate
    std::string curve;  ///< in the plot; empty: none
};

/// A run of the program.
struct Report {
    std::string flags;    ///< of the compiler
    std::string machine;  ///< processor, cores, compiler
    std::vector<Row> rows;
};

[[nodiscard]] inline double over(double a, double b) {
    return b > 0 ? a / b : 0;
}

[[nodiscard]] inline double figure_of(const Row& row, double Timing::*which) {
    switch (row.figure) {
    case Figure::OfRaw:
        return over(row.ecs.*which, row.raw.*which);
    case Figure::OfReference:
        return over(row.ecs.*which, row.reference.*which);
    case Figure::Speedup:
        return over(row.raw.*which, row.ecs.*which);
    case Figure::Plain:
        break;
    }
    return row.ecs.*which;
}

/// The figure as a fraction of the gate's limit: 1 just meets it, less is better.
[[nodiscard]] inline double fraction_of_limit(const Row& row, double Timing::*which) {
    const double figure = figure_of(row, which);
    return row.figure == Figure::Speedup ? over(row.limit, figure) : over(figure, row.limit);
}

/// Other load on the machine only adds time, so the best run counts as well.
[[nodiscard]] inline const char* verdict(const Row& row) {
    if (row.limit == 0) {
        return "";
    }
    if (fraction_of_limit(row, &Timing::median) <= 1) {
        return "reached";
    }
    return fraction_of_limit(row, &Timing::best) <= 1 ? "best run only" : "NOT reached";
}

/// Three significant digits, without an exponent.
[[nodiscard]] inline std::string short_number(double value) {
    return value >= 1000 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

/// Unit of a gate's figure.
[[nodiscard]] inline std::string figure_unit(const Row& row) {
    return row.figure == Figure::OfReference ? " R"
           : row.figure == Figure::Plain     ? " " + row.unit
                                             : "x";
}

[[nodiscard]] inline std::string gate_text(const Row& row) {
    if (row.limit == 0) {
        return "";
    }
    return fmt::format(
        "{} {}{}", row.figure == Figure::Speedup ? ">=" : "<=", row.limit, figure_unit(row));
}

[[nodiscard]] inline std::string table_line(const Row& row) {
    const auto number = [](double value) {
        return value == 0 ? std::string("-") : fmt::format("{:.4g}", value);
    };
    return fmt::format(
        "{:>3} {:<50} {:>8} {:>9} {:>9} {:>9} {:>7} {:>7}  {:<7} {:>7} {:>7}  {:<15} {}\n",
        row.gate > 0 ? std::to_string(row.gate) : "", row.name, row.count, number(row.ecs.median),
        number(row.ecs.best), number(row.raw.median), number(over(row.ecs.median, row.raw.median)),
        number(over(row.ecs.median, row.reference.median)), row.unit,
        row.limit > 0 ? number(figure_of(row, &Timing::median)) : "",
        row.limit > 0 ? number(figure_of(row, &Timing::best)) : "", gate_text(row), verdict(row));
}

[[nodiscard]] inline std::string table_head() {
    return fmt::format(
        "{:>3} {:<50} {:>8} {:>9} {:>9} {:>9} {:>7} {:>7}  {:<7} {:>7} {:>7}  {}\n", "#",
        "workload", "entities", "median", "best", "raw", "x raw", "x R", "unit", "figure", "best",
        "gate");
}

[[nodiscard]] inline std::string to_csv(const Report& report) {
    std::string text = "gate,workload,entities,unit,median,best,raw_median,raw_best,r_median,"
                       "of_raw,of_r,figure,figure_best,limit,verdict\n";
    for (const Row& row : report.rows) {
        text += fmt::format(
            "{},\"{}\",{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.5g},{:.5g},{:.5g},{:.5g},{},{}"
            "\n",
            row.gate, row.name, row.count, row.unit, row.ecs.median, row.ecs.best, row.raw.median,
            row.raw.best, row.reference.median, over(row.ecs.median, row.raw.median),
            over(row.ecs.median, row.reference.median), figure_of(row, &Timing::median),
            figure_of(row, &Timing::best), row.limit, verdict(row));
    }
    return text;
}

/// One line per row. Names contain no characters that JSON escapes.
[[nodiscard]] inline std::string to_json(const Report& report) {
    std::string text = fmt::format(
        "{{\n\"flags\": \"{}\",\n\"machine\": \"{}\",\n\"rows\": [\n", report.flags,
        report.machine);
    for (const Row& row : report.rows) {
        text += fmt::format(
            R"({{"gate": {}, "workload": "{}", "entities": {}, "unit": "{}", "median": {:.6g}, )"
            R"("best": {:.6g}, "raw_median": {:.6g}, "raw_best": {:.6g}, "r_median": {:.6g}, )"
            R"("r_best": {:.6g}, "of": "{}", "limit": {}, "curve": "{}", "verdict": "{}"}}{})",
            row.gate, row.name, row.count, row.unit, row.ecs.median, row.ecs.best, row.raw.median,
            row.raw.best, row.reference.median, row.reference.best,
            kFigureNames[static_cast<std::size_t>(row.figure)], row.limit, row.curve, verdict(row),
            &row == &report.rows.back() ? "\n" : ",\n");
    }
    return text + "]\n}\n";
}

// ---- reading it again

/// The value of "key" in a line written by to_json; empty if missing.
[[nodiscard]] inline std::string_view value_in(std::string_view line, std::string_view key) {
    const std::string quoted = fmt::format("\"{}\": ", key);
    const std::size_t found = line.find(quoted);
    if (found == std::string_view::npos) {
        return {};
    }
    line.remove_prefix(found + quoted.size());
    if (line.starts_with('"')) {
        line.remove_prefix(1);
        return line.substr(0, line.find('"'));
    }
    return line.substr(0, line.find_first_of(",}"));
}

[[nodiscard]] inline Row row_from(std::string_view line) {
    const auto text = [&](std::string_view key) { return std::string(value_in(line, key)); };
    const auto number = [&](std::string_view key) {
        return std::strtod(text(key).c_str(), nullptr);
    };
    Row row;
    row.gate = static_cast<int>(number("gate"));
    row.name = text("workload");
    row.count = static_cast<std::size_t>(number("entities"));
    row.unit = text("unit");
    row.ecs = {number("median"), number("best")};
    row.raw = {number("raw_median"), number("raw_best")};
    row.reference = {number("r_median"), number("r_best")};
    for (std::size_t i = 0; i < kFigureNames.size(); ++i) {
        if (value_in(line, "of") == kFigureNames[i]) {
            row.figure = static_cast<Figure>(i);
        }
    }
    row.limit = number("limit");
    row.curve = text("curve");
    return row;
}

/// Reads what to_json wrote; on failure prints a line on stderr and returns nothing.
[[nodiscard]] inline std::optional<Report> read_report(const std::string& path) {
    std::FILE* file = std::fopen(path.c_str(), "rb");
    Report report;
    if (file != nullptr) {
        char buffer[4096];
        while (std::fgets(buffer, sizeof(buffer), file) != nullptr) {
            const std::string_view line = buffer;
            if (line.starts_with("\"flags\"")) {
                report.flags = value_in(line, "flags");
            } else if (line.starts_with("\"machine\"")) {
                report.machine = value_in(line, "machine");
            } else if (line.starts_with("{\"gate\"")) {
                report.rows.push_back(row_from(line));
            }
        }
        std::fclose(file);
    }
    if (report.rows.empty()) {
        fmt::print(stderr, "{}: found no rows, expected the JSON of an ecs_bench run\n", path);
        return std::nullopt;
    }
    return report;
}

/// On failure prints a line on stderr.
[[nodiscard]] inline bool write_file(const std::string& path, const std::string& text) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    const bool written =
        file != nullptr && std::fwrite(text.data(), 1, text.size(), file) == text.size();
    const bool closed = file != nullptr && std::fclose(file) == 0;
    if (!written || !closed) {
        fmt::print(stderr, "{}: cannot be written\n", path);
    }
    return written && closed;
}

}  // namespace limn::bench
