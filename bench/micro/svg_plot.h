#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

// Plots of benches as SVG: times per item over their number, both axes logarithmic.

namespace limn::bench {

/// Builder of an SVG document.
class Svg {
  public:
    void text(
        double x, double y, std::string_view words, std::string_view color = "#333",
        std::string_view anchor = "start", double size = 12, std::string_view more = "") {
        body_ += fmt::format(
            "<text x=\"{:.1f}\" y=\"{:.1f}\" fill=\"{}\" text-anchor=\"{}\" font-size=\"{}\" "
            "{}>{}</text>\n",
            x, y, color, anchor, size, more, words);
    }
    void
    line(double x1, double y1, double x2, double y2, std::string_view color, double width = 1) {
        body_ += fmt::format(
            "<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"{}\" stroke-width=\"{}\"/>\n", x1,
            y1, x2, y2, color, width);
    }
    void
    box(double x, double y, double width, double height, std::string_view color, double opacity) {
        body_ += fmt::format(
            "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\" "
            "fill-opacity=\"{}\"/>\n",
            x, y, width, height, color, opacity);
    }
    void dot(double x, double y, std::string_view color) {
        body_ += fmt::format(
            "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.6\" fill=\"{}\" stroke=\"white\"/>\n", x, y,
            color);
    }
    void curve(
        const std::vector<std::array<double, 2>>& points, std::string_view color, double width,
        std::string_view dashes = "") {
        std::string path;
        for (const auto& [x, y] : points) {
            path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x, y);
        }
        body_ += fmt::format(
            "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" "
            "stroke-linejoin=\"round\" stroke-linecap=\"{}\" stroke-dasharray=\"{}\"/>\n",
            path, color, width, dashes.empty() ? "round" : "butt",
            dashes.empty() ? "none" : dashes);
    }
    [[nodiscard]] std::string done(double width, double height) const {
        return fmt::format(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
            "viewBox=\"0 0 {0} {1}\" font-family=\"Helvetica, Arial, 'DejaVu Sans', "
            "sans-serif\">\n"
            "<rect width=\"{0}\" height=\"{1}\" fill=\"#fcfcfa\"/>\n{2}</svg>\n",
            width, height, body_);
    }

  private:
    std::string body_;
};

inline constexpr const char* kInk = "#333";
inline constexpr const char* kFaint = "#777";

/// Position and range of a plot with logarithmic axes.
struct Panel {
    double left, top, width, height;
    double first_decade, last_decade;  ///< items, powers of ten
    double low_decade, high_decade;    ///< [ns]
    [[nodiscard]] double x_of(double items) const {
        return left + width * (std::log10(items) - first_decade) / (last_decade - first_decade);
    }
    [[nodiscard]] double y_of(double time) const {
        const double fraction = (std::log10(time) - low_decade) / (high_decade - low_decade);
        return top + height * (1 - std::clamp(fraction, 0.0, 1.0));
    }
};

/// `item`: what is counted, such as "entity", and its plural.
inline void draw_axes(
    Svg& svg, const Panel& panel, std::string_view title, std::string_view item,
    std::string_view items) {
    const double bottom = panel.top + panel.height;
    const double right = panel.left + panel.width;
    svg.text(panel.left, panel.top - 18, title, kInk, "start", 15, "font-weight=\"600\"");
    for (double decade = panel.low_decade; decade <= panel.high_decade + 1e-9; ++decade) {
        for (const double step : {1.0, 2.0, 5.0}) {
            const double time = step * std::pow(10.0, decade);
            if (std::log10(time) > panel.high_decade + 1e-9) {
                continue;
            }
            const double y = panel.y_of(time);
            svg.line(panel.left, y, right, y, step == 1 ? "#dcdcd8" : "#efefec");
            if (step == 1) {
                svg.text(panel.left - 8, y + 4, fmt::format("{:g}", time), kFaint, "end");
            }
        }
    }
    for (double decade = panel.first_decade; decade <= panel.last_decade; ++decade) {
        const double x = panel.x_of(std::pow(10.0, decade));
        svg.line(x, panel.top, x, bottom, "#efefec");
        svg.line(x, bottom, x, bottom + 4, "#aaa");
        svg.text(
            x, bottom + 19,
            fmt::format("10<tspan dy=\"-5\" font-size=\"9\">{:.0f}</tspan>", decade), kFaint,
            "middle");
    }
    svg.line(panel.left, bottom, right, bottom, "#aaa");
    svg.text(panel.left + panel.width / 2, bottom + 38, items, kFaint, "middle");
    svg.text(
        panel.left - 46, panel.top + panel.height / 2, fmt::format("time per {} [ns]", item),
        kFaint, "middle", 12,
        fmt::format(
            "transform=\"rotate(-90 {:.1f} {:.1f})\"", panel.left - 46,
            panel.top + panel.height / 2));
}

/// Names at the ends of the curves, moved apart so that they do not overlap.
struct EndLabel {
    double y;  ///< where the curve ends
    std::string name;
    std::string_view color;
};

inline void draw_labels(Svg& svg, double x, std::vector<EndLabel> labels) {
    constexpr double kLine = 14;
    std::sort(labels.begin(), labels.end(), [](const EndLabel& a, const EndLabel& b) {
        return a.y < b.y;
    });
    std::vector<double> at;
    for (const EndLabel& label : labels) {
        at.push_back(label.y);
    }
    for (int pass = 0; pass < 200; ++pass) {
        for (std::size_t i = 1; i < at.size(); ++i) {
            if (const double lack = kLine - (at[i] - at[i - 1]); lack > 0) {
                at[i - 1] -= lack / 2;
                at[i] += lack / 2;
            }
        }
    }
    for (std::size_t i = 0; i < labels.size(); ++i) {
        svg.line(x + 5, labels[i].y, x + 16, at[i], "#bbb");
        svg.text(x + 20, at[i] + 4, labels[i].name, labels[i].color);
    }
}

}  // namespace limn::bench
