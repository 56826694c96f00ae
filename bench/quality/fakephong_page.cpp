#include "bench/quality/fakephong_page.h"

#include "bench/fakephong/phong_models.h"
#include "bench/quality/quality.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace limn::fakephong {
namespace {

/// Two curves over a row, 0 .. 1; Phong's is drawn first.
std::string scanline_svg(std::span<const float> phong, std::span<const float> method) {
    const auto path = [](std::span<const float> curve, const char* color) {
        std::string points;
        for (std::size_t x = 0; x < curve.size(); ++x) {
            points += fmt::format(
                "{},{:.1f} ", x, 102 - 100 * static_cast<double>(std::clamp(curve[x], 0.0f, 1.0f)));
        }
        return fmt::format(
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\"/>", points,
            color);
    };
    return fmt::format(
        "<div><svg viewBox=\"0 0 {} 104\" width=\"100%\" style=\"background:#0c0d0f\">{}{}</svg>"
        "<small>scanline: Phong gray, method orange</small></div>\n",
        phong.size(), path(phong, "#8a93a0"), path(method, "#ffa040"));
}

std::string join(const std::vector<std::string>& ids) {
    return join_text(ids, " &gt; ");
}

const MethodResult& result_of(const SceneResult& scene, std::string_view id) {
    return *std::find_if(scene.methods.begin(), scene.methods.end(), [id](const MethodResult& one) {
        return one.method->id == id;
    });
}

std::string correctness_table(std::span<const SceneResult> results) {
    std::string html =
        "<h3>Table 6.1: color correctness of highlights</h3>\n<table><tr><th>scene</th>";
    const auto columns = shading_methods().subspan(1, kTableColumns);
    for (const ShadingMethod& method : columns) {
        html += fmt::format("<th>{}</th>", method.name);
    }
    html += "</tr>\n";
    for (const PrintedRow& row : printed_table()) {
        html += fmt::format("<tr><td>{}, as printed</td>", row.model);
        for (const double value : row.correctness) {
            html += fmt::format("<td class=\"number\">{:.4f}</td>", value);
        }
        html += "</tr>\n";
    }
    for (const SceneResult& result : results) {
        html += fmt::format(
            "<tr><td>{} ({} facets)</td>", result.scene.name, result.scene.mesh.triangles.size());
        for (std::size_t i = 0; i < kTableColumns; ++i) {
            html += fmt::format("<td class=\"number\">{:.4f}</td>", result.methods[i].correctness);
        }
        html += "</tr>\n";
    }
    return html + "</table>\n";
}

std::string work_table(const SceneResult& result) {
    std::string html = fmt::format(
        "<h3>Counted work: {}</h3>\n<table><tr><th>method</th><th>lightings per facet</th>"
        "<th>additions per pixel</th><th>multiplications</th><th>divisions</th><th>roots</th>"
        "<th>powers</th><th>fetches</th></tr>\n",
        result.scene.name);
    const auto add = [&html](std::string_view name, const PhongImage& image) {
        const auto per = [](std::int64_t count, std::int64_t of) {
            return of > 0 ? static_cast<double>(count) / static_cast<double>(of) : 0;
        };
        const Work& w = image.shading;
        html += fmt::format(
            "<tr><td>{}</td><td class=\"number\">{:.0f}</td>", name,
            per(image.setup.lightings, image.triangles));
        for (const std::int64_t count :
             {w.additions, w.multiplications, w.divisions, w.roots, w.powers, w.fetches}) {
            html += fmt::format("<td class=\"number\">{:.1f}</td>", per(count, image.pixels));
        }
        html += "</tr>\n";
    };
    add("Phong", result.phong);
    for (const MethodResult& one : result.methods) {
        add(one.method->name, one.image);
    }
    return html + "</table>\n";
}

std::string path_table() {
    std::string html =
        "<h3>Along an edge: arc against polynomial</h3>\n<p>The thesis calls quadratic Blinn "
        "coordinates exact for normals on an arc. They are not: an arc is a sine and a cosine, and "
        "the "
        "quadratic through three of its points is only much closer than the chord.</p>\n"
        "<table><tr><th>arc</th><th>linear, sine</th><th>linear, cosine</th><th>quadratic, "
        "sine</th><th>quadratic, cosine</th></tr>\n";
    for (const double degrees : {15.0, 30.0, 60.0, 90.0}) {
        const PathDeviation d = path_deviation(degrees * 3.141592653589793 / 180);
        html += fmt::format(
            "<tr><td>{:.0f}°</td><td>{:.4f}</td><td>{:.4f}</td><td>{:.4f}</td><td>{:.4f}</td></"
            "tr>\n",
            degrees, d.linear_sine, d.linear_cosine, d.quadratic_sine, d.quadratic_cosine);
    }
    return html + "</table>\n";
}

Status add_images(std::string& html, const SceneResult& scene, const MethodResult& one) {
    const std::vector<float> phong = scanline(scene.phong.color, scene.scene.row);
    html += fmt::format(
        "<figure><figcaption>{}, {}: {:.4f}; the peak is {} px off and {:.2f} times as "
        "high</figcaption><div class=\"row\">\n",
        scene.scene.name, one.method->name, one.correctness, one.scanline.peak_shift,
        one.scanline.peak_ratio);
    html += LIMN_TRY(image_tag(one.image.color, one.method->name));
    html += LIMN_TRY(image_tag(scene.phong.color, "Phong"));
    html += LIMN_TRY(image_tag(
        enhanced_difference(scene.phong.color, one.image.color), "difference, to the power 1/10"));
    html += scanline_svg(phong, scanline(one.image.color, scene.scene.row));
    html += "</div></figure>\n";
    return Done{};
}

}  // namespace

std::string describe_method(const ShadingMethod& method, std::span<const SceneResult> results) {
    const SceneResult* best = &results[0];
    const SceneResult* worst = &results[0];
    for (const SceneResult& result : results) {
        const double here = result_of(result, method.id).correctness;
        best = here > result_of(*best, method.id).correctness ? &result : best;
        worst = here < result_of(*worst, method.id).correctness ? &result : worst;
    }
    const MethodResult& high = result_of(*best, method.id);
    const MethodResult& low = result_of(*worst, method.id);
    const auto cost = [](const PhongImage& image) {
        return image.pixels > 0
                   ? weighted_operations(image.shading) / static_cast<double>(image.pixels)
                   : 0;
    };
    return fmt::format(
        "It holds best on the {} ({:.4f}) and worst on the {} ({:.4f}), where the peak of the "
        "scanline "
        "is {:.2f} times Phong's and {} px off. At its own samples the highlight is wrong by at "
        "most "
        "{:.1g}, elsewhere on that scene by up to {:.2f}. A pixel costs {:.0f} weighted "
        "operations, {:.0f} "
        "% of Phong shading's.",
        best->scene.name, high.correctness, worst->scene.name, low.correctness,
        low.scanline.peak_ratio, low.scanline.peak_shift, low.error_at_samples, low.error_inside,
        cost(low.image), 100 * cost(low.image) / cost(worst->phong));
}

Result<std::string> fakephong_html(std::span<const SceneResult> results) {
    std::string html = correctness_table(results);
    html += "<p>The thesis ranks by quality: quadratic Blinn map, Blinn map, quadratic shading, "
            "environment "
            "map. Its own table has subdivided Gouraud and quadratic shading above the Blinn map "
            "on both "
            "models. By correctness and by counted work, best first:</p>\n<ul>\n";
    for (const SceneResult& result : results) {
        html +=
            fmt::format("<li>{}: {}</li>\n", result.scene.name, join(rank_by_correctness(result)));
    }
    html += fmt::format(
        "</ul>\n<p>Least work on the {}: {}. The thesis: environment map, Blinn map, quadratic, "
        "quadratic Blinn map.</p>\n",
        results[0].scene.name, join(rank_by_work(results[0])));
    html += work_table(results[0]) + path_table();
    for (const ShadingMethod& method : shading_methods().subspan(1)) {
        if (method.id == "phong-map") {
            continue;  // diffuse light only
        }
        html +=
            fmt::format("<h3>{}</h3>\n<p>{}</p>\n", method.name, describe_method(method, results));
        for (const SceneResult& result : results) {
            LIMN_TRY(add_images(html, result, result_of(result, method.id)));
        }
    }
    return html;
}

}  // namespace limn::fakephong
