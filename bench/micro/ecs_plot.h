#pragma once

#include "bench/micro/ecs_report.h"
#include "bench/micro/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// The SVG plot of a run: time per entity over the number of entities, for iteration and structural
// change, each over the wide gray line of the equivalent raw loop; below, every gate as a fraction
// of its limit.

namespace limn::bench {

inline constexpr const char* kRawColor = "#d3d3cf";
inline constexpr const char* kReached = "#0a8f6a";
inline constexpr const char* kMissed = "#d1495b";

/// Style of a curve; its name is that of its rows.
struct CurveStyle {
    std::string_view name;
    std::string_view color;
    bool dashed = false;
};

inline constexpr std::array<CurveStyle, 4> kIterationCurves = {{
    {"7 columns", "#c8553d"},
    {"7 columns, 2 threads", "#c8553d", true},
    {"2 columns", "#2a6fbb"},
    {"2 columns, 2 threads", "#2a6fbb", true},
}};

inline constexpr std::array<CurveStyle, 11> kStructureCurves = {{
    {"create, one by one", "#2a6fbb"},
    {"create, bulk", "#2a6fbb", true},
    {"destroy, one by one", "#8a4f9e"},
    {"destroy, all of a query", "#8a4f9e", true},
    {"add, one by one", "#c8553d"},
    {"add, all of a query", "#c8553d", true},
    {"remove, one by one", "#d08a1d"},
    {"remove, all of a query", "#d08a1d", true},
    {"deferred add", "#6b6b6b", true},
    {"snapshot, save", "#2e8b6f"},
    {"snapshot, restore", "#2e8b6f", true},
}};

template <std::size_t size>
void draw_curves(
    Svg& svg, const Panel& panel, const Report& report,
    const std::array<CurveStyle, size>& styles) {
    struct Drawn {
        const CurveStyle* style;
        std::vector<std::array<double, 2>> ecs;
        std::vector<std::array<double, 2>> raw;
    };
    std::vector<Drawn> curves;
    for (const CurveStyle& style : styles) {
        Drawn& curve = curves.emplace_back();
        curve.style = &style;
        for (const Row& row : report.rows) {
            if (row.curve == style.name) {
                const double x = panel.x_of(static_cast<double>(row.count));
                curve.ecs.push_back({x, panel.y_of(row.ecs.best)});
                if (row.raw.best > 0) {
                    curve.raw.push_back({x, panel.y_of(row.raw.best)});
                }
            }
        }
        if (curve.ecs.empty()) {
            curves.pop_back();
        }
    }
    for (const Drawn& curve : curves) {
        svg.curve(curve.raw, kRawColor, 6);
    }
    std::vector<EndLabel> labels;
    for (const Drawn& curve : curves) {
        svg.curve(curve.ecs, curve.style->color, 2, curve.style->dashed ? "5 3" : "");
        for (const auto& [x, y] : curve.ecs) {
            svg.dot(x, y, curve.style->color);
        }
        labels.push_back({curve.ecs.back()[1], std::string(curve.style->name), curve.style->color});
    }
    draw_labels(svg, panel.left + panel.width, std::move(labels));
}

// ---- gates

/// The corresponding row of the other run, or nullptr.
[[nodiscard]] inline const Row* same_row(const Report* other, const Row& row) {
    if (other != nullptr) {
        for (const Row& candidate : other->rows) {
            if (candidate.gate == row.gate && candidate.name == row.name
                && candidate.count == row.count) {
                return &candidate;
            }
        }
    }
    return nullptr;
}

[[nodiscard]] inline std::vector<const Row*> gate_rows(const Report& report) {
    std::vector<const Row*> rows;
    for (const Row& row : report.rows) {
        if (row.gate > 0 && row.limit > 0) {
            rows.push_back(&row);
        }
    }
    std::stable_sort(
        rows.begin(), rows.end(), [](const Row* a, const Row* b) { return a->gate < b->gate; });
    return rows;
}

/// ", 16k", ", 1M"; empty for other counts, which are in the names.
[[nodiscard]] inline std::string short_count(std::size_t count) {
    return count == 16384 ? ", 16k" : count == 1'000'000 ? ", 1M" : "";
}

inline double draw_gates(
    Svg& svg, double left, double top, double width, const Report& report, const Report* other) {
    constexpr double kRow = 25, kLabel = 400, kMaxFraction = 2;
    const std::vector<const Row*> rows = gate_rows(report);
    const double start = left + kLabel;
    const double scale = (width - kLabel - 190) / kMaxFraction;
    const double bottom = top + kRow * static_cast<double>(rows.size());
    svg.text(
        left, top - 34, "Gates: fraction of the limit", kInk, "start", 15, "font-weight=\"600\"");
    for (int i = 0; i <= 8; ++i) {
        const double x = start + scale * 0.25 * i;
        svg.line(x, top, x, bottom, i == 4 ? kInk : "#e6e6e2", i == 4 ? 1.5 : 1);
        if (i % 2 == 0) {
            const std::string word = i == 4 ? "the gate" : fmt::format("{:g}x", 0.25 * i);
            svg.text(x, top - 8, word, i == 4 ? kInk : kFaint, "middle");
        }
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Row& row = *rows[i];
        const double y = top + kRow * static_cast<double>(i);
        const auto bar = [&](const Row& shown, double from, double height, double opacity) {
            const double fraction = fraction_of_limit(shown, &Timing::median);
            const char* color = fraction <= 1 ? kReached : kMissed;
            svg.box(
                start, y + from, scale * std::min(fraction, kMaxFraction), height, color, opacity);
            if (fraction > kMaxFraction) {
                const double x = start + scale * kMaxFraction;
                svg.curve(
                    {{x + 3, y + from}, {x + 8, y + from + height / 2}, {x + 3, y + from + height}},
                    color, 1.5);
            }
        };
        const Row* second = same_row(other, row);
        bar(row, 4, second != nullptr ? 10 : 17, 0.9);
        if (second != nullptr) {
            bar(*second, 15, 5, 0.45);
        }
        svg.text(left + 22, y + 16, std::to_string(row.gate), kFaint, "end");
        svg.text(left + 32, y + 16, row.name + short_count(row.count));
        svg.text(
            start + scale * kMaxFraction + 16, y + 16,
            short_number(figure_of(row, &Timing::median)) + figure_unit(row), kInk, "start", 12,
            "font-weight=\"600\"");
        svg.text(
            start + scale * kMaxFraction + 188, y + 16,
            fmt::format("{} {:g}", row.figure == Figure::Speedup ? "≥" : "≤", row.limit), kFaint,
            "end", 11);
    }
    return bottom;
}

inline void draw_legend(Svg& svg, double x, double y, const Report& report, const Report* other) {
    const auto entry = [&](double width, std::string_view words, auto&& draw) {
        draw(x, y - 4);
        svg.text(x + 34, y, words, kFaint);
        x += width;
    };
    entry(190, "the equivalent raw loop", [&](double at, double center) {
        svg.curve({{at, center}, {at + 26, center}}, kRawColor, 6);
    });
    entry(270, "the ECS (dashed: bulk or 2 threads)", [&](double at, double center) {
        svg.curve({{at, center}, {at + 26, center}}, "#2a6fbb", 2);
    });
    entry(220, fmt::format("gate, {}", report.flags), [&](double at, double center) {
        svg.box(at, center - 5, 13, 10, kReached, 0.9);
        svg.box(at + 13, center - 5, 13, 10, kMissed, 0.9);
    });
    if (other != nullptr) {
        entry(160, fmt::format("gate, {}", other->flags), [&](double at, double center) {
            svg.box(at, center - 2, 13, 5, kReached, 0.45);
            svg.box(at + 13, center - 2, 13, 5, kMissed, 0.45);
        });
    }
}

/// `other`: the same with other compiler flags, or nullptr.
[[nodiscard]] inline std::string to_svg(const Report& report, const Report* other) {
    constexpr double kWidth = 1320;
    Svg svg;
    svg.text(
        60, 44, "Limn's ECS compared with raw arrays in the same process", kInk, "start", 22,
        "font-weight=\"600\"");
    svg.text(
        60, 66, fmt::format("{}; curves: best of the repeats, {}", report.machine, report.flags),
        kFaint);
    draw_legend(svg, 60, 94, report, other);

    const Panel iteration = {90, 150, 400, 440, 3, 7, -1, 1};
    draw_axes(
        svg, iteration, "Iteration: position += velocity * step, and 7 columns", "entity",
        "entities");
    draw_curves(svg, iteration, report, kIterationCurves);
    const Panel structure = {760, 150, 400, 440, 3, 7, -1, 3};
    draw_axes(svg, structure, "Structural change, and copies of a world", "entity", "entities");
    draw_curves(svg, structure, report, kStructureCurves);

    const double bottom = draw_gates(svg, 60, 712, kWidth - 120, report, other);
    return svg.done(kWidth, bottom + 40);
}

}  // namespace limn::bench
