#include "content/load/motion/curve_plot.h"

#include "content/load/files/json_document.h"
#include "ecs/base/math.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

// Techniques: char.ghost-view

namespace limn {
namespace {

constexpr double kPlotWidth = 800;  // [px]
constexpr double kPlotHeight = 360;
constexpr double kPlotMargin = 50;
constexpr std::array<const char*, 3> kCurveColors = {"#c33", "#2a2", "#36c"};  // by axis

std::string escape_svg(std::string_view text) {
    std::string escaped;
    for (const char c : text) {
        escaped += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
    }
    return escaped;
}

/// Maps times and values to pixels.
class PlotArea {
  public:
    PlotArea(double duration, double low, double high)
        : duration_(std::max(duration, 1e-6)), low_(low), high_(high) {}

    [[nodiscard]] double x(double time) const {
        return kPlotMargin + time / duration_ * (kPlotWidth - 2 * kPlotMargin);
    }
    [[nodiscard]] double y(double value) const {
        return kPlotHeight - kPlotMargin
               - (value - low_) / (high_ - low_) * (kPlotHeight - 2 * kPlotMargin);
    }

    [[nodiscard]] std::string draw_axes() const {
        std::string svg;
        const auto line = [&](double x1, double y1, double x2, double y2) {
            svg += format_text(
                "<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" stroke=\"#ccc\"/>\n",
                fixed_text(x1, 2), fixed_text(y1, 2), fixed_text(x2, 2), fixed_text(y2, 2));
        };
        const auto label = [&](double at_x, double at_y, const char* anchor, std::string text) {
            svg += format_text(
                "<text x=\"{}\" y=\"{}\" text-anchor=\"{}\">{}</text>\n", fixed_text(at_x, 2),
                fixed_text(at_y, 2), anchor, text);
        };
        const double value_step = nice_plot_step(high_ - low_);
        for (double v = std::ceil(low_ / value_step) * value_step; v <= high_; v += value_step) {
            line(x(0), y(v), x(duration_), y(v));
            label(x(0) - 6, y(v) + 4, "end", fixed_text(v, value_step < 1 ? 2 : 0));
        }
        const double time_step = nice_plot_step(duration_);
        for (double t = 0; t <= duration_ * 1.0001; t += time_step) {
            line(x(t), y(low_), x(t), y(high_));
            label(x(t), y(low_) + 18, "middle", fixed_text(t, time_step < 0.1 ? 2 : 1) + " s");
        }
        return svg;
    }

  private:
    double duration_;
    double low_;
    double high_;
};

}  // namespace

double nice_plot_step(double range) {
    const double rough = std::max(range, 1e-9) / 8;
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor * power >= rough) {
            return factor * power;
        }
    }
    return 10 * power;
}

Result<std::vector<ChannelCurve>>
find_channel_curves(const BvhFile& bvh, const std::string& joint) {
    const auto found = std::ranges::find(bvh.joints, joint, &BvhJoint::name);
    if (joint.empty() || found == bvh.joints.end()) {
        std::vector<std::string_view> names;
        for (const BvhJoint& known : bvh.joints) {
            names.emplace_back(known.name);
        }
        return fail("found no joint {}{}", in_quotes(joint), did_you_mean(joint, names));
    }
    std::vector<ChannelCurve> curves;
    const std::size_t width = bvh.channels();
    for (std::size_t c = 0; c < found->channels.size(); ++c) {
        if (is_position(found->channels[c])) {
            continue;
        }
        ChannelCurve& curve = curves.emplace_back();
        curve.name = std::string(1, "XYZ"[axis_of(found->channels[c])]) + "rotation";
        for (std::size_t f = 0; f < bvh.frames; ++f) {
            curve.values.push_back(bvh.values[f * width + found->first_value + c]);
        }
    }
    if (curves.empty()) {
        return fail("found no rotations of the joint {}", in_quotes(joint));
    }
    return curves;
}

std::string
plot_curves(const std::string& title, const std::vector<ChannelCurve>& curves, float frame_time) {
    double low = 0;
    double high = 0;
    std::size_t frames = 0;
    for (const ChannelCurve& curve : curves) {
        frames = std::max(frames, curve.values.size());
        for (const float value : curve.values) {
            low = std::min(low, static_cast<double>(value));
            high = std::max(high, static_cast<double>(value));
        }
    }
    if (high - low < 1e-3) {
        low -= 1;
        high += 1;
    }
    const double seconds = static_cast<double>(frame_time);
    const PlotArea area(
        seconds * static_cast<double>(std::max<std::size_t>(frames, 2) - 1), low, high);
    std::string svg = format_text(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" "
        "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" "
        "fill=\"#fff\"/>\n<text x=\"{}\" y=\"24\" font-size=\"15\">{} [degrees]</text>\n",
        fixed_text(kPlotWidth, 0), fixed_text(kPlotHeight, 0), fixed_text(kPlotMargin, 0),
        escape_svg(title));
    svg += area.draw_axes();
    for (std::size_t c = 0; c < curves.size(); ++c) {
        const auto axis = static_cast<std::size_t>(std::clamp(curves[c].name[0] - 'X', 0, 2));
        svg += format_text(
            "<polyline fill=\"none\" stroke-width=\"1.5\" stroke=\"{}\" points=\"",
            kCurveColors[axis]);
        for (std::size_t f = 0; f < curves[c].values.size(); ++f) {
            svg += format_text(
                "{},{} ", fixed_text(area.x(seconds * static_cast<double>(f)), 3),
                fixed_text(area.y(static_cast<double>(curves[c].values[f])), 3));
        }
        svg += format_text(
            "\"/>\n<text x=\"{}\" y=\"24\" text-anchor=\"end\" fill=\"{}\">{}</text>\n",
            fixed_text(
                kPlotWidth - kPlotMargin - 90 * static_cast<double>(curves.size() - 1 - c), 0),
            kCurveColors[axis], curves[c].name);
    }
    return svg + "</svg>\n";
}

}  // namespace limn
