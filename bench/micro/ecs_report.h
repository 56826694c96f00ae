#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

// What ecs_bench found out, as a table, CSV, JSON and a plot.

namespace limn::bench {

/// Of the repeats of one thing [ns an item].
struct Timing {
    double median = 0;
    double best = 0;
};

/// What a gate bounds.
enum class Figure {
    OfRaw,        ///< time over that of the raw loop beside it
    OfReference,  ///< time over R: position += velocity * step on 1M raw rows
    Plain,        ///< the time itself, or whatever number stands in its place
    Speedup,      ///< time of the raw loop over the time
};

struct Row {
    int gate = 0;  ///< number in the list of gates; 0: none
    std::string name;
    std::size_t count = 0;  ///< entities
    const char* unit = "";  ///< of the times
    Timing ecs;             ///< what is measured
    Timing raw;             ///< the same without ECS; 0: there is no such thing
    Timing reference;       ///< R, measured in turns with the others
    Figure figure = Figure::OfRaw;
    double limit = 0;  ///< at most; of a speedup, at least. 0: no gate
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

/// A machine that does other things too only ever adds time, so the best run counts as well.
[[nodiscard]] inline const char* verdict(const Row& row) {
    if (row.limit == 0) {
        return "";
    }
    const auto reached = [&](double figure) {
        return row.figure == Figure::Speedup ? figure >= row.limit : figure <= row.limit;
    };
    if (reached(figure_of(row, &Timing::median))) {
        return "reached";
    }
    return reached(figure_of(row, &Timing::best)) ? "best run only" : "NOT reached";
}

[[nodiscard]] inline std::string gate_text(const Row& row) {
    if (row.limit == 0) {
        return "";
    }
    const char* unit = row.figure == Figure::OfReference ? " R"
                       : row.figure == Figure::Plain     ? ""
                                                         : "x";
    return fmt::format("{} {}{}", row.figure == Figure::Speedup ? ">=" : "<=", row.limit, unit);
}

[[nodiscard]] inline std::string table_line(const Row& row) {
    const auto number = [](double value) {
        return value == 0 ? std::string("-") : fmt::format("{:.4g}", value);
    };
    return fmt::format(
        "{:>3} {:<44} {:>9} {:>9} {:>9} {:>9} {:>7} {:>7}  {:<10} {:>7} {:>7}  {:<9} {}\n",
        row.gate > 0 ? std::to_string(row.gate) : "",
        row.name,
        row.count,
        number(row.ecs.median),
        number(row.ecs.best),
        number(row.raw.median),
        number(over(row.ecs.median, row.raw.median)),
        number(over(row.ecs.median, row.reference.median)),
        row.unit,
        row.limit > 0 ? number(figure_of(row, &Timing::median)) : "",
        row.limit > 0 ? number(figure_of(row, &Timing::best)) : "",
        gate_text(row),
        verdict(row));
}

[[nodiscard]] inline std::string table_head() {
    return fmt::format(
        "{:>3} {:<44} {:>9} {:>9} {:>9} {:>9} {:>7} {:>7}  {:<10} {:>7} {:>7}  {}\n",
        "#",
        "workload",
        "entities",
        "median",
        "best",
        "raw",
        "x raw",
        "x R",
        "unit",
        "figure",
        "best",
        "gate");
}

[[nodiscard]] inline std::string to_csv(const std::vector<Row>& rows) {
    std::string text = "gate,workload,entities,unit,median,best,raw_median,raw_best,r_median,"
                       "of_raw,of_r,figure,figure_best,limit,verdict\n";
    for (const Row& row : rows) {
        text += fmt::format(
            "{},\"{}\",{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.5g},{:.5g},{:.5g},{:.5g},{},{}"
            "\n",
            row.gate,
            row.name,
            row.count,
            row.unit,
            row.ecs.median,
            row.ecs.best,
            row.raw.median,
            row.raw.best,
            row.reference.median,
            over(row.ecs.median, row.raw.median),
            over(row.ecs.median, row.reference.median),
            figure_of(row, &Timing::median),
            figure_of(row, &Timing::best),
            row.limit,
            verdict(row));
    }
    return text;
}

/// Names hold nothing that JSON would escape.
[[nodiscard]] inline std::string to_json(const std::vector<Row>& rows) {
    std::string text = "[\n";
    for (const Row& row : rows) {
        text += fmt::format(
            R"(  {{"gate": {}, "workload": "{}", "entities": {}, "unit": "{}", "median": {:.6g}, )"
            R"("best": {:.6g}, "raw_median": {:.6g}, "raw_best": {:.6g}, "r_median": {:.6g}, )"
            R"("figure": {:.5g}, "figure_best": {:.5g}, "limit": {}, "verdict": "{}"}}{})",
            row.gate,
            row.name,
            row.count,
            row.unit,
            row.ecs.median,
            row.ecs.best,
            row.raw.median,
            row.raw.best,
            row.reference.median,
            figure_of(row, &Timing::median),
            figure_of(row, &Timing::best),
            row.limit,
            verdict(row),
            &row == &rows.back() ? "\n" : ",\n");
    }
    return text + "]\n";
}

/// One curve of the plot: best times, since the curve is about the machine and not its guests.
struct Curve {
    std::string name;
    const char* color;
    std::vector<double> entities;
    std::vector<double> time;  ///< [ns an entity]
};

/// Time an entity against the number of entities, which has a logarithmic axis.
[[nodiscard]] inline std::string to_svg(std::string_view title, const std::vector<Curve>& curves) {
    constexpr double kWidth = 720, kHeight = 400, kLeft = 60, kRight = 20, kTop = 40, kBottom = 50;
    double smallest = 1e300, largest = 0, slowest = 0;
    for (const Curve& curve : curves) {
        for (std::size_t i = 0; i < curve.entities.size(); ++i) {
            smallest = std::min(smallest, curve.entities[i]);
            largest = std::max(largest, curve.entities[i]);
            slowest = std::max(slowest, curve.time[i]);
        }
    }
    const double first = std::floor(std::log10(smallest) + 1e-9);
    const double last = std::max(first + 1, std::ceil(std::log10(largest) - 1e-9));
    const double tick = slowest > 2 ? 0.5 : 0.25;
    const double top = std::ceil(slowest / tick) * tick;
    const auto x_of = [&](double entities) {
        return kLeft + (std::log10(entities) - first) / (last - first) * (kWidth - kLeft - kRight);
    };
    const auto y_of = [&](double time) {
        return kHeight - kBottom - time / top * (kHeight - kTop - kBottom);
    };

    std::string text = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" "
        "font-family=\"sans-serif\" font-size=\"12\">\n"
        "<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n"
        "<text x=\"{2}\" y=\"20\" font-size=\"14\">{3}</text>\n",
        kWidth,
        kHeight,
        kLeft,
        title);
    const auto line = [&](double x1, double y1, double x2, double y2) {
        text += fmt::format(
            "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#ddd\"/>\n",
            x1,
            y1,
            x2,
            y2);
    };
    const auto label = [&](double x, double y, const char* anchor, const std::string& words) {
        text += fmt::format(
            "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, words);
    };
    for (double power = first; power <= last; ++power) {
        const double x = x_of(std::pow(10.0, power));
        line(x, kTop, x, kHeight - kBottom);
        label(x, kHeight - kBottom + 18, "middle", fmt::format("1e{:.0f}", power));
    }
    for (int i = 0; i * tick <= top + 1e-9; ++i) {
        const double y = y_of(i * tick);
        line(kLeft, y, kWidth - kRight, y);
        label(kLeft - 8, y + 4, "end", fmt::format("{:.2f}", i * tick));
    }
    label((kLeft + kWidth) / 2, kHeight - 10, "middle", "entities");
    label(kLeft, kTop - 8, "end", "ns");

    double legend = kTop + 14;
    for (const Curve& curve : curves) {
        std::string points;
        for (std::size_t i = 0; i < curve.entities.size(); ++i) {
            points += fmt::format("{:.1f},{:.1f} ", x_of(curve.entities[i]), y_of(curve.time[i]));
        }
        text += fmt::format(
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n"
            "<text x=\"{}\" y=\"{}\" fill=\"{}\">{}</text>\n",
            points,
            curve.color,
            kLeft + 12,
            legend,
            curve.color,
            curve.name);
        legend += 16;
    }
    return text + "</svg>\n";
}

/// Says why not on stderr.
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
