#include "bench/quality/fakephong_page.h"

#include "bench/quality/fakephong_tables.h"
#include "bench/quality/quality.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace limn::fakephong {
namespace {

constexpr int kPlot = 256;   ///< side of a plot, including the margin
constexpr int kMargin = 26;  ///< for the labels of the axes

/// Two curves over a row, from 0 to 1, with axes; Phong's is drawn first.
std::string scanline_svg(std::span<const float> phong, std::span<const float> method, int row) {
    const double height = kPlot - 2.0 * kMargin;
    const double width = kPlot - 1.5 * kMargin;
    const auto plot_x = [&](double fraction) { return kMargin + width * fraction; };
    const auto plot_y = [&](double value) { return kMargin + height * (1 - value); };
    const auto path = [&](std::span<const float> curve, const char* color) {
        std::string points;
        for (std::size_t x = 0; x < curve.size(); ++x) {
            const double value = static_cast<double>(std::clamp(curve[x], 0.0f, 1.0f));
            const double fraction =
                (static_cast<double>(x) + 0.5) / static_cast<double>(curve.size());
            points += fmt::format("{:.1f},{:.1f} ", plot_x(fraction), plot_y(value));
        }
        return fmt::format(
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\"/>", points,
            color);
    };
    std::string axes;
    for (const double value : {0.0, 0.5, 1.0}) {
        axes += fmt::format(
            "<path d=\"M{} {:.1f}H{:.1f}\" stroke=\"#2c323b\"/><text x=\"{}\" y=\"{:.1f}\" "
            "text-anchor=\"end\">{:g}</text>",
            kMargin, plot_y(value), plot_x(1), kMargin - 5, plot_y(value) + 4, value);
    }
    axes += fmt::format(
        "<text x=\"{}\" y=\"{}\">0</text><text x=\"{:.1f}\" y=\"{}\" "
        "text-anchor=\"end\">{} px</text><text x=\"{}\" y=\"15\">(R + G + B) / 3</text>",
        kMargin, kPlot - 9, plot_x(1), kPlot - 9, phong.size(), kMargin);
    return fmt::format(
        "<div><svg viewBox=\"0 0 {} {}\" width=\"100%\" style=\"background:#0c0d0f\" "
        "fill=\"#98a2b0\" font-size=\"11\">{}{}{}</svg>"
        "<small>row {}: Phong gray, method orange</small></div>\n",
        kPlot, kPlot, axes, path(phong, "#8a93a0"), path(method, "#ffa040"), row);
}

/// "3 px right of Phong's, at 0.95 of its height"
std::string peak_text(const ScanlineComparison& line) {
    if (line.peak_ratio < 0.1) {
        return fmt::format("the peak has but {:.2f} of the height of Phong's", line.peak_ratio);
    }
    const std::string shift = line.peak_shift == 0
                                  ? std::string("the peak is not shifted")
                                  : fmt::format(
                                      "the peak is {} px {} of Phong's", std::abs(line.peak_shift),
                                      line.peak_shift < 0 ? "left" : "right");
    return fmt::format("{}, at {:.2f} of its height", shift, line.peak_ratio);
}

Status add_images(std::string& html, const SceneResult& scene, const MethodResult& one) {
    const PhongImage& phong = reference_of(scene, one);
    html += fmt::format(
        "<figure><figcaption><b>{}</b>: correctness {:.4f}; {}</figcaption><div class=\"row\">\n",
        scene.scene.name, one.correctness, peak_text(one.scanline));
    html += LIMN_TRY(image_tag(one.image.color, one.method->name));
    html += LIMN_TRY(image_tag(
        phong.color, one.method->diffuse_only ? "Phong shading, diffuse light" : "Phong shading"));
    html += LIMN_TRY(image_tag(
        enhanced_difference(phong.color, one.image.color), "difference, to the power 1/10"));
    html += scanline_svg(
        scanline(phong.color, scene.scene.row), scanline(one.image.color, scene.scene.row),
        scene.scene.row);
    html += "</div></figure>\n";
    return Done{};
}

/// Errors at its samples on all scenes, and at other points on one.
std::string error_text(const ShadingMethod& method, double at_samples, double inside) {
    const bool has_samples = method.lightings > 0 || method.exact_points > 0;
    const char* const where = has_samples ? "its own sample points" : "corners";
    return at_samples < 1e-5
               ? fmt::format("At {} it is exact, between them wrong by up to {:.2f}", where, inside)
               : fmt::format(
                   "Even at {} it is wrong by up to {:.2f}, between them by up to {:.2f}", where,
                   at_samples, inside);
}

}  // namespace

std::string describe_method(const ShadingMethod& method, std::span<const SceneResult> results) {
    const SceneResult* best = &results[0];
    const SceneResult* worst = &results[0];
    double at_samples = 0;
    for (const SceneResult& result : results) {
        const MethodResult& here = result_of(result, method.id);
        best = here.correctness > result_of(*best, method.id).correctness ? &result : best;
        worst = here.correctness < result_of(*worst, method.id).correctness ? &result : worst;
        at_samples = std::max(at_samples, here.error_at_samples);
    }
    const MethodResult& high = result_of(*best, method.id);
    const MethodResult& low = result_of(*worst, method.id);
    const auto per = [](const Work& work, std::int64_t count) {
        return count > 0 ? weighted_operations(work) / static_cast<double>(count) : 0;
    };
    const PhongImage& phong = reference_of(*worst, low);
    const double pixel = per(low.image.shading, low.image.pixels);
    const double phong_pixel = per(phong.shading, phong.pixels);
    const std::string where =
        results.size() == 1
            ? fmt::format("Its correctness is {:.4f};", high.correctness)
            : fmt::format(
                "It holds best on the {} ({:.4f}) and worst on the {} ({:.4f}), where",
                best->scene.name, high.correctness, worst->scene.name, low.correctness);
    return fmt::format(
        "{} {}. {}. A pixel costs {:.0f} weighted operations, {:.0f} % of Phong shading's, a facet "
        "{:.0f} "
        "more. Worth it {}.",
        where, peak_text(low.scanline), error_text(method, at_samples, low.error_inside), pixel,
        phong_pixel > 0 ? 100 * pixel / phong_pixel : 0, per(low.image.setup, low.image.triangles),
        verdict_of(method, results));
}

Result<std::string> fakephong_html(std::span<const SceneResult> results) {
    const bool of_thesis = results.size() > 1;  // a user's model is the only scene
    std::string html = correctness_section(results);
    html += of_thesis ? texture_section() : std::string();
    html += ranking_section(results);
    html += of_thesis ? contradiction_section(results) : std::string();
    html += worth_section(results);
    // A mesh of many facets, and, if there is one, a facet of many pixels.
    const auto single = std::find_if(results.begin(), results.end(), [](const SceneResult& one) {
        return one.scene.mesh.triangles.size() == 1;
    });
    html += work_section(results[0]);
    html += single != results.end() && of_thesis ? work_section(*single) : std::string();
    html += path_section(results);
    for (const ShadingMethod& method : shading_methods().subspan(1)) {
        html += fmt::format(
            "<h3>{}{}</h3>\n<p>{}</p>\n", method.name,
            method.diffuse_only ? ", of diffuse light" : "", describe_method(method, results));
        for (const SceneResult& result : results) {
            LIMN_TRY(add_images(html, result, result_of(result, method.id)));
        }
    }
    return html;
}

}  // namespace limn::fakephong
