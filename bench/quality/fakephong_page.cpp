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

constexpr int kPlot = 256;   ///< side of a plot, of which the curves leave a margin
constexpr int kMargin = 26;  ///< for the labels of the axes

/// Two curves over a row, from 0 to 1, with axes; Phong's is drawn first.
std::string scanline_svg(std::span<const float> phong, std::span<const float> method, int row) {
    const double height = kPlot - 2.0 * kMargin;
    const double width = kPlot - 1.5 * kMargin;
    const auto place_x = [&](double share) { return kMargin + width * share; };
    const auto place_y = [&](double value) { return kMargin + height * (1 - value); };
    const auto path = [&](std::span<const float> curve, const char* color) {
        std::string points;
        for (std::size_t x = 0; x < curve.size(); ++x) {
            const double value = static_cast<double>(std::clamp(curve[x], 0.0f, 1.0f));
            const double share = (static_cast<double>(x) + 0.5) / static_cast<double>(curve.size());
            points += fmt::format("{:.1f},{:.1f} ", place_x(share), place_y(value));
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
            kMargin, place_y(value), place_x(1), kMargin - 5, place_y(value) + 4, value);
    }
    axes += fmt::format(
        "<text x=\"{}\" y=\"{}\">0</text><text x=\"{:.1f}\" y=\"{}\" "
        "text-anchor=\"end\">{} px</text><text x=\"{}\" y=\"15\">(R + G + B) / 3</text>",
        kMargin, kPlot - 9, place_x(1), kPlot - 9, phong.size(), kMargin);
    return fmt::format(
        "<div><svg viewBox=\"0 0 {} {}\" width=\"100%\" style=\"background:#0c0d0f\" "
        "fill=\"#98a2b0\" font-size=\"11\">{}{}{}</svg>"
        "<small>row {}: Phong gray, method orange</small></div>\n",
        kPlot, kPlot, axes, path(phong, "#8a93a0"), path(method, "#ffa040"), row);
}

/// Names of methods, best first.
std::string join_names(const std::vector<std::string>& ids) {
    std::vector<std::string> names;
    for (const std::string& id : ids) {
        names.emplace_back(find_method(id)->name);
    }
    return join_text(names, " &gt; ");
}

/// "78 px to the right"
std::string shift_text(int pixels) {
    return pixels == 0
               ? "in its place"
               : fmt::format("{} px to the {}", std::abs(pixels), pixels < 0 ? "left" : "right");
}

/// Of a frame, set-up included.
double work_share(const SceneResult& scene, const MethodResult& one) {
    const auto sum = [](const PhongImage& image) {
        return weighted_operations(image.setup) + weighted_operations(image.shading);
    };
    return sum(scene.phong) > 0 ? sum(one.image) / sum(scene.phong) : 0;
}

const MethodResult& result_of(const SceneResult& scene, std::string_view id) {
    return *std::find_if(scene.methods.begin(), scene.methods.end(), [id](const MethodResult& one) {
        return one.method->id == id;
    });
}

/// A scene that is fitted to a printed row, and that row; null for others.
const PrintedRow* fitted_row(const SceneResult& result) {
    for (const PrintedRow& row : printed_table()) {
        if (result.scene.name == fmt::format("{}, fitted", row.model)) {
            return &row;
        }
    }
    return nullptr;
}

std::string distance_row(const SceneResult& result) {
    const PrintedRow* row = fitted_row(result);
    if (row == nullptr) {
        return {};
    }
    std::string html = "<tr><td><small>its distance from the print</small></td>";
    for (std::size_t i = 0; i < kTableColumns; ++i) {
        html += fmt::format(
            "<td class=\"number\"><small>{:+.4f}</small></td>",
            result.methods[i].correctness - row->correctness[i]);
    }
    return html + "</tr>\n";
}

/// How far the fits are from the print, and why.
std::string fit_text(std::span<const SceneResult> results) {
    std::string html;
    for (const SceneResult& result : results) {
        if (const PrintedRow* row = fitted_row(result)) {
            std::size_t farthest = 0;
            const auto distance = [&](std::size_t i) {
                return std::abs(result.methods[i].correctness - row->correctness[i]);
            };
            for (std::size_t i = 1; i < kTableColumns; ++i) {
                farthest = distance(i) > distance(farthest) ? i : farthest;
            }
            html += fmt::format(
                "<p>The {} comes within {:.4f} of its row; farthest is {}. The thesis gives "
                "neither "
                "place of light and eye nor exponents, so that they are fitted{}</p>\n",
                row->model, distance(farthest), result.methods[farthest].method->name,
                result.scene.texture_size < 64 ? fmt::format(
                    ". Its row has both Blinn maps below even subdivided Gouraud: here only "
                    "textures as coarse as {} texels do that, and then quadratic shading, which "
                    "reads none, stays better than printed.",
                    result.scene.texture_size)
                                               : std::string(", with the shape of the triangle."));
        }
    }
    return html;
}

std::string ranking_table(std::span<const SceneResult> results) {
    std::string html =
        "<h3>Rankings</h3>\n<p>The thesis ranks by the shape of highlights, which color "
        "correctness "
        "hardly sees: its own table has subdivided Gouraud and quadratic shading above the Blinn "
        "map "
        "on both models. On closed coarse meshes both rankings agree.</p>\n"
        "<table><tr><th>by color correctness</th><th>best first</th></tr>\n"
        "<tr><td>the thesis</td><td>quadratic Blinn map &gt; Blinn map &gt; quadratic &gt; "
        "environment map</td></tr>\n";
    for (const SceneResult& result : results) {
        html += fmt::format(
            "<tr><td>{}</td><td>{}</td></tr>\n", result.scene.name,
            join_names(rank_by_correctness(result)));
    }
    return html
           + fmt::format(
               "</table>\n<table><tr><th>by work</th><th>least first</th></tr>\n<tr><td>the "
               "thesis</td><td>environment map &gt; Blinn map &gt; quadratic &gt; quadratic Blinn "
               "map</td></tr>\n<tr><td>counted, {}</td><td>{}</td></tr>\n</table>\n",
               results[0].scene.name, join_names(rank_by_work(results[0])));
}

/// A method on the meshes of a kind: the most work, as a share of Phong shading's, and the lowest
/// correctness.
struct Worth {
    bool measured = false;
    double work = 0;
    double correctness = 1;

    void include(const SceneResult& scene, const MethodResult& one) {
        measured = true;
        work = std::max(work, work_share(scene, one));
        correctness = std::min(correctness, one.correctness);
    }
    [[nodiscard]] bool holds(double lowest) const { return measured && correctness >= lowest; }
    [[nodiscard]] bool saves() const { return measured && work < 0.9; }
    [[nodiscard]] std::string cells() const {
        return measured ? fmt::format(
                   "<td class=\"number\">{:.0f} %</td><td class=\"number\">{:.3f}</td>", 100 * work,
                   correctness)
                        : "<td class=\"number\">-</td><td class=\"number\">-</td>";
    }
};

/// What the numbers say of a method today.
std::string verdict(const Worth& fine, const Worth& coarse) {
    const bool on_fine = fine.holds(0.98) && fine.saves();
    const bool on_coarse = coarse.holds(0.95) && coarse.saves();
    if (on_fine || on_coarse) {
        return on_fine && on_coarse ? "on coarse and fine meshes"
                                    : (on_fine ? "on fine meshes" : "on coarse meshes");
    }
    return fine.saves() || coarse.saves() ? "where a highlight need only be hinted at"
                                          : "nowhere: it costs what Phong shading costs";
}

/// Single triangles are left out beside other scenes: on them only quadratic coordinates hold.
std::string worth_table(std::span<const SceneResult> results) {
    std::string html =
        "<h3>Where is each still worth it?</h3>\n<p>Where a processor draws, work counts: here "
        "that "
        "of a frame, set-up included, in weighted operations as a share of Phong shading's, at "
        "most; "
        "beside it the lowest color correctness, on meshes of more and of less than a thousand "
        "facets. Worth it is what saves a tenth of the work and keeps 0.98 on fine or 0.95 on "
        "coarse "
        "meshes. What it costs on an OpenGL, <code>limn bench fakephong</code> measures.</p>\n"
        "<table><tr><th>method</th><th class=\"number\">work, fine</th><th "
        "class=\"number\">correct</th><th class=\"number\">work, coarse</th><th "
        "class=\"number\">correct</th><th>worth it</th></tr>\n";
    for (const ShadingMethod& method : shading_methods().subspan(1)) {
        if (method.id == "phong-map") {
            continue;  // diffuse light only
        }
        Worth fine;
        Worth coarse;
        for (const SceneResult& result : results) {
            const std::size_t facets = result.scene.mesh.triangles.size();
            if (facets > 1 || results.size() == 1) {
                (facets > 1000 ? fine : coarse).include(result, result_of(result, method.id));
            }
        }
        html += fmt::format(
            "<tr><td>{}</td>{}{}<td>{}</td></tr>\n", method.name, fine.cells(), coarse.cells(),
            verdict(fine, coarse));
    }
    return html + "</table>\n";
}

std::string correctness_table(std::span<const SceneResult> results) {
    std::string html =
        "<h3>Table 6.1: color correctness of highlights</h3>\n<table><tr><th>scene</th>";
    const auto columns = shading_methods().subspan(1, kTableColumns);
    for (const ShadingMethod& method : columns) {
        html += fmt::format("<th class=\"number\">{}</th>", method.name);
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
        html += "</tr>\n" + distance_row(result);
    }
    return html + "</table>\n";
}

std::string work_table(const SceneResult& result) {
    std::string html = fmt::format(
        "<h3>Counted work: {}</h3>\n<table><tr><th>method</th><th class=\"number\">lightings per "
        "facet</th>"
        "<th class=\"number\">additions per pixel</th><th class=\"number\">multiplications</th><th "
        "class=\"number\">divisions</th><th class=\"number\">roots</th>"
        "<th class=\"number\">powers</th><th class=\"number\">fetches</th></tr>\n",
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
        "<figure><figcaption>{}, {}: {:.4f}; the peak is {} and {:.2f} times as "
        "high</figcaption><div class=\"row\">\n",
        scene.scene.name, one.method->name, one.correctness, shift_text(one.scanline.peak_shift),
        one.scanline.peak_ratio);
    html += LIMN_TRY(image_tag(one.image.color, one.method->name));
    html += LIMN_TRY(image_tag(scene.phong.color, "Phong"));
    html += LIMN_TRY(image_tag(
        enhanced_difference(scene.phong.color, one.image.color), "difference, to the power 1/10"));
    html += scanline_svg(phong, scanline(one.image.color, scene.scene.row), scene.scene.row);
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
        "is {:.2f} times Phong's and {}. At its own samples the highlight is wrong by at "
        "most "
        "{:.1g}, elsewhere on that scene by up to {:.2f}. A pixel costs {:.0f} weighted "
        "operations, {:.0f} "
        "% of Phong shading's.",
        best->scene.name, high.correctness, worst->scene.name, low.correctness,
        low.scanline.peak_ratio, shift_text(low.scanline.peak_shift), low.error_at_samples,
        low.error_inside, cost(low.image), 100 * cost(low.image) / cost(worst->phong));
}

Result<std::string> fakephong_html(std::span<const SceneResult> results) {
    std::string html = correctness_table(results);
    html += fit_text(results) + ranking_table(results) + worth_table(results);
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
