#include "bench/quality/fakephong_tables.h"

#include "bench/fakephong/phong_models.h"
#include "content/make/models/shapes.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace limn::fakephong {
namespace {

constexpr double kRadians = 3.141592653589793 / 180;

/// A table whose first `texts` columns are text and whose others are numbers.
class HtmlTable {
  public:
    HtmlTable(const std::vector<std::string>& headings, std::size_t texts = 1) : texts_(texts) {
        html_ = "<table>" + row("th", headings, {});
    }
    /// `tag` surrounds the content of each cell.
    void add(const std::vector<std::string>& cells, const std::string& tag = {}) {
        html_ += row("td", cells, tag);
    }
    [[nodiscard]] std::string html() const { return html_ + "</table>\n"; }

  private:
    [[nodiscard]] std::string
    row(const char* cell, const std::vector<std::string>& cells, const std::string& tag) const {
        std::string text = "<tr>";
        for (std::size_t i = 0; i < cells.size(); ++i) {
            text += fmt::format(
                "<{0}{1}>{3}{2}{4}</{0}>", cell, i < texts_ ? "" : " class=\"number\"", cells[i],
                tag.empty() ? "" : "<" + tag + ">", tag.empty() ? "" : "</" + tag + ">");
        }
        return text + "</tr>\n";
    }

    std::size_t texts_;
    std::string html_;
};

std::string fixed(double value, int digits) {
    return fmt::format("{:.{}f}", value, digits);
}

std::string facet_count(const SceneResult& result) {
    const std::size_t count = result.scene.mesh.triangles.size();
    return fmt::format("{} facet{}", count, count == 1 ? "" : "s");
}

/// Names of methods, best first.
std::string join_names(const std::vector<std::string>& ids) {
    std::vector<std::string> names;
    for (const std::string& id : ids) {
        names.emplace_back(find_method(id)->name);
    }
    return join_text(names, " &gt; ");
}

/// "teapot, sphere" for those of `results` of which `holds` is true; "none of the scenes".
template <typename Predicate>
std::string scenes_where(std::span<const SceneResult> results, Predicate holds) {
    std::vector<std::string> names;
    for (const SceneResult& result : results) {
        if (holds(result)) {
            names.push_back(result.scene.name);
        }
    }
    return names.empty() ? "none of the scenes" : join_text(names, "; ");
}

const SceneResult& scene_named(std::span<const SceneResult> results, std::string_view name) {
    return *std::find_if(results.begin(), results.end(), [name](const SceneResult& result) {
        return result.scene.name == name;
    });
}

// ---- Table 6.1

/// A scene that is fitted to a printed row, and that row; null for others.
const PrintedRow* fitted_row(const SceneResult& result) {
    for (const PrintedRow& row : printed_table()) {
        if (result.scene.name == fmt::format("{}, fitted", row.model)) {
            return &row;
        }
    }
    return nullptr;
}

/// The distance of a fit from the print, and the order of its columns.
std::string fit_text(const SceneResult& result, const PrintedRow& row) {
    std::size_t farthest = 0;
    const auto distance = [&](std::size_t i) {
        return std::abs(result.methods[i].correctness - row.correctness[i]);
    };
    for (std::size_t i = 1; i < kTableColumns; ++i) {
        farthest = distance(i) > distance(farthest) ? i : farthest;
    }
    const int swapped = swapped_pairs(correctness_row(result), row.correctness);
    return fmt::format(
        "The {} comes within {:.4f} of its row, farthest in the column {}; {}.\n", row.model,
        distance(farthest), result.methods[farthest].method->name,
        swapped == 0 ? std::string("all six columns are in the printed order")
                     : fmt::format("{} pairs of columns are not in the printed order", swapped));
}

}  // namespace

std::string correctness_section(std::span<const SceneResult> results) {
    std::vector<std::string> headings = {"scene"};
    for (const ShadingMethod& method : shading_methods().subspan(1, kTableColumns)) {
        headings.emplace_back(method.name);
    }
    HtmlTable table(headings);
    for (const PrintedRow& row : printed_table()) {
        std::vector<std::string> cells = {fmt::format("{}, as printed", row.model)};
        for (const double value : row.correctness) {
            cells.push_back(fixed(value, 4));
        }
        table.add(cells, "em");
    }
    std::string text;
    for (const SceneResult& result : results) {
        std::vector<std::string> cells = {
            fmt::format("{} ({})", result.scene.name, facet_count(result))};
        for (std::size_t i = 0; i < kTableColumns; ++i) {
            cells.push_back(fixed(result.methods[i].correctness, 4));
        }
        table.add(cells);
        if (const PrintedRow* row = fitted_row(result)) {
            cells = {"its distance from the print"};
            for (std::size_t i = 0; i < kTableColumns; ++i) {
                cells.push_back(
                    fmt::format("{:+.4f}", result.methods[i].correctness - row->correctness[i]));
            }
            table.add(cells, "small");
            text += fit_text(result, *row);
        }
    }
    if (!text.empty()) {
        text =
            "<p>The thesis gives neither the positions of light and eye nor exponents, so that two "
            "scenes are fitted to its rows. "
            + text + "</p>\n";
    }
    return "<h3>Table 6.1: color correctness of highlights</h3>\n" + table.html() + text;
}

std::string texture_section() {
    constexpr int kPairs = kTableColumns * (kTableColumns - 1) / 2;
    const PrintedRow& printed = printed_table()[0];
    HtmlTable table(
        {"texels", "environment map", "Blinn map", "quadratic Blinn map",
         "pairs of columns in the printed order"});
    PhongScene scene = printed_teapot_scene();
    std::string in_order;
    double quadratic = 0;
    for (const int size : {8, 11, 13, 16, 32, 64, 256}) {
        scene.texture_size = size;
        const auto row = correctness_row(scene);
        const int kept = kPairs - swapped_pairs(row, printed.correctness);
        if (kept == kPairs) {
            in_order += fmt::format("{}{}", in_order.empty() ? "" : ", ", size);
        }
        quadratic = row[2];
        table.add(
            {fmt::format("{0} x {0}", size), fixed(row[3], 4), fixed(row[4], 4), fixed(row[5], 4),
             fmt::format("{} of {}", kept, kPairs)});
    }
    return fmt::format(
               "<h3>Why the teapot's row needs coarse textures</h3>\n<p>The printed row has the "
               "Blinn map "
               "{:.4f} and the quadratic one {:.4f} below subdivided Gouraud, and the two {:.4f} "
               "apart. "
               "Of these sizes of the lookup textures, {} give the printed order. Quadratic "
               "shading reads no texture: it stays at {:.4f}, {:.4f} from the print.</p>\n",
               printed.correctness[1] - printed.correctness[4],
               printed.correctness[1] - printed.correctness[5],
               printed.correctness[5] - printed.correctness[4],
               in_order.empty() ? "none" : "those of " + in_order + " texels", quadratic,
               std::abs(quadratic - printed.correctness[2]))
           + table.html();
}

// ---- rankings

std::string ranking_section(std::span<const SceneResult> results) {
    HtmlTable correct({"by color correctness", "best first"}, 2);
    correct.add(
        {"the thesis", "quadratic Blinn map &gt; Blinn map &gt; quadratic &gt; environment map"},
        "em");
    HtmlTable work({"by work", "least first"}, 2);
    work.add(
        {"the thesis", "environment map &gt; Blinn map &gt; quadratic &gt; quadratic Blinn map"},
        "em");
    for (const SceneResult& result : results) {
        correct.add({result.scene.name, join_names(rank_by_correctness(result))});
        work.add({result.scene.name, join_names(rank_by_work(result))});
    }
    return "<h3>Rankings</h3>\n" + correct.html() + work.html();
}

std::string contradiction_section(std::span<const SceneResult> results) {
    const auto blinn_leads = [](const SceneResult& result) {
        return result_of(result, "blinn-map").correctness
               > result_of(result, "quadratic").correctness;
    };
    const auto quadratic_cheaper = [](const SceneResult& result) {
        return weighted_operations(result_of(result, "quadratic").image)
               < weighted_operations(result_of(result, "quadratic-blinn").image);
    };
    const auto behind = [](const PrintedRow& row) {
        return fmt::format(
            "{:.4f} {} it on the {}", std::abs(row.correctness[4] - row.correctness[2]),
            row.correctness[4] < row.correctness[2] ? "behind" : "ahead of", row.model);
    };
    std::string html = "<h3>Where the thesis contradicts itself</h3>\n<ul>\n";
    html += fmt::format(
        "<li>Its text ranks the Blinn map above quadratic shading; its table has the Blinn map {} "
        "and {}. Here it leads on: {}.</li>\n",
        behind(printed_table()[0]), behind(printed_table()[1]), scenes_where(results, blinn_leads));
    html += fmt::format(
        "<li>It calls quadratic shading faster than the quadratic Blinn map. By counted work it is "
        "on: {}.</li>\n",
        scenes_where(results, quadratic_cheaper));

    PhongScene fans = sphere_scene();
    fans.mesh = phong_mesh(make_dodecahedron({.radius = 1}));
    const auto of_fans = correctness_row(fans);
    const SceneResult& thirty = scene_named(results, "dodecahedron");
    html += fmt::format(
        "<li>Its dodecahedron has 30 triangles. A regular one in fans has {}, on which the Blinn "
        "maps reach {:.4f} and {:.4f}; without two faces at the back it has {}, and they reach "
        "{:.4f} and {:.4f}.</li>\n",
        fans.mesh.triangles.size(), of_fans[4], of_fans[5], facet_count(thirty),
        result_of(thirty, "blinn-map").correctness,
        result_of(thirty, "quadratic-blinn").correctness);

    const PathDeviation arc = path_deviation(60 * kRadians);
    html += fmt::format(
        "<li>It calls quadratic Blinn coordinates exact where normals lie on an arc. Over 60° they "
        "miss it by {:.4f}, linear ones by {:.4f}: {:.0f} times as far.</li>\n",
        std::max(arc.quadratic_sine, arc.quadratic_cosine),
        std::max(arc.linear_sine, arc.linear_cosine),
        std::max(arc.linear_sine, arc.linear_cosine)
            / std::max(arc.quadratic_sine, arc.quadratic_cosine));

    const std::vector<SteppedMethod> stepped = step_scene(triangle_scene());
    const SteppedMethod& quadratic =
        *std::find_if(stepped.begin(), stepped.end(), [](const SteppedMethod& one) {
            return one.method->id == "quadratic";
        });
    html += fmt::format(
        "<li>It says that quadratic shading cannot use forward differences. Without perspective it "
        "can: on the triangle its image is stepped with {:.0f} % of the work, and differs by "
        "{:.2g} at "
        "most.</li>\n",
        100 * weighted_operations(quadratic.stepped) / weighted_operations(quadratic.direct),
        quadratic.difference);

    const SceneResult& worst =
        *std::max_element(results.begin(), results.end(), [](const auto& a, const auto& b) {
            return result_of(a, "hw-blinn").error_at_samples
                   < result_of(b, "hw-blinn").error_at_samples;
        });
    return html
           + fmt::format(
               "<li>The program of its appendix B leaves an axis unnormalized and takes the "
               "world's "
               "up: at vertices of the {} its highlight is wrong by up to {:.2f}, that of the "
               "Blinn "
               "map by {:.1g}.</li>\n</ul>\n",
               worst.scene.name, result_of(worst, "hw-blinn").error_at_samples,
               result_of(worst, "blinn-map").error_at_samples);
}

// ---- what it is worth

namespace {

/// A method on meshes of one kind: its largest work, relative to Phong shading, and lowest
/// correctness.
struct Worth {
    bool measured = false;
    double work = 0;
    double correctness = 1;

    void include(const SceneResult& scene, const MethodResult& one) {
        measured = true;
        work = std::max(work, relative_work(scene, one));
        correctness = std::min(correctness, one.correctness);
    }
    [[nodiscard]] bool holds(double lowest) const { return measured && correctness >= lowest; }
    [[nodiscard]] bool saves() const { return measured && work < 0.9; }
    void append_to(std::vector<std::string>& cells) const {
        cells.push_back(measured ? fmt::format("{:.0f} %", 100 * work) : "-");
        cells.push_back(measured ? fixed(correctness, 3) : "-");
    }
};

struct Worths {
    Worth fine, coarse;
};

/// Single triangles are ignored if there are other scenes: they are not meshes.
Worths worths_of(const ShadingMethod& method, std::span<const SceneResult> results) {
    Worths worths;
    for (const SceneResult& result : results) {
        if (result.scene.mesh.triangles.size() > 1 || results.size() == 1) {
            (is_fine(result) ? worths.fine : worths.coarse)
                .include(result, result_of(result, method.id));
        }
    }
    return worths;
}

}  // namespace

std::string verdict_of(const ShadingMethod& method, std::span<const SceneResult> results) {
    const auto [fine, coarse] = worths_of(method, results);
    const bool on_fine = fine.holds(0.98) && fine.saves();
    const bool on_coarse = coarse.holds(0.95) && coarse.saves();
    if (on_fine || on_coarse) {
        return on_fine && on_coarse ? "on coarse and fine meshes"
                                    : (on_fine ? "on fine meshes" : "on coarse meshes");
    }
    return fine.saves() || coarse.saves() ? "where a highlight need only be hinted at"
                                          : "nowhere: it costs what Phong shading costs";
}

std::string worth_section(std::span<const SceneResult> results) {
    HtmlTable table({"method", "worth it", "work, fine", "correct", "work, coarse", "correct"}, 2);
    for (const ShadingMethod& method : shading_methods().subspan(1)) {
        const Worths worths = worths_of(method, results);
        std::vector<std::string> cells = {std::string(method.name), verdict_of(method, results)};
        worths.fine.append_to(cells);
        worths.coarse.append_to(cells);
        table.add(cells);
    }
    return "<h3>Where is each still worth it?</h3>\n<p>Where a processor draws, work counts: here "
           "that of a frame, set-up included, in weighted operations relative to Phong "
           "shading, at most; beside it the lowest color correctness, on meshes of more and of "
           "less than a thousand facets. Worth it is what saves a tenth of the work and keeps 0.98 "
           "on fine or 0.95 on coarse meshes. What it costs on an OpenGL, <code>limn bench "
           "fakephong</code> measures.</p>\n"
           + table.html();
}

// ---- counted work

std::string work_section(const SceneResult& result) {
    HtmlTable table(
        {"method", "lightings", "additions", "multiplications", "divisions", "roots", "powers",
         "fetches", "of Phong's work"});
    const auto add = [&table](std::string_view name, const Efficiency& e) {
        std::vector<std::string> cells = {std::string(name), fixed(e.lightings, 0)};
        for (const double count :
             {e.additions, e.multiplications, e.divisions, e.roots, e.powers, e.fetches}) {
            cells.push_back(fixed(count, 1));
        }
        cells.push_back(fmt::format("{:.0f} %", 100 * e.work));
        table.add(cells);
    };
    add("Phong", efficiency_of(result.phong, result.phong));
    for (const MethodResult& one : result.methods) {
        add(one.method->name, efficiency_of(one.image, reference_of(result, one)));
    }
    HtmlTable steps(
        {"colors of", "additions, each pixel asked", "multiplications", "additions, stepped",
         "multiplications", "work, stepped / asked", "largest difference"});
    for (const SteppedMethod& one : step_scene(result.scene)) {
        const Efficiency direct = efficiency_of(one.direct, one.direct);
        const Efficiency by_steps = efficiency_of(one.stepped, one.direct);
        steps.add(
            {std::string(one.method->name), fixed(direct.additions, 1),
             fixed(direct.multiplications, 1), fixed(by_steps.additions, 1),
             fixed(by_steps.multiplications, 1), fmt::format("{:.0f} %", 100 * by_steps.work),
             fmt::format("{:.2g}", one.difference)});
    }
    return fmt::format(
        "<h3>Counted work: {0}</h3>\n<p>Lightings per facet, of {1}; all else per pixel, of {2}. "
        "Work "
        "is that of the frame with set-up, where additions and multiplications weigh 1, fetches 4, "
        "divisions and roots 8, powers 16.</p>\n{3}"
        "<h3>Forward differences: {0}</h3>\n<p>Without perspective, colors that are polynomials "
        "step from pixel to pixel by additions; samples of each facet and the walk along its left "
        "edge, {4:.0f} pixels per facet, are among them.</p>\n{5}",
        result.scene.name, facet_count(result), result.phong.pixels, table.html(),
        static_cast<double>(result.phong.pixels)
            / static_cast<double>(std::max<std::int64_t>(result.phong.triangles, 1)),
        steps.html());
}

// ---- edges

std::string path_section(std::span<const SceneResult> results) {
    const auto number = [](double value) { return fmt::format("{:.2g}", value); };
    HtmlTable arcs(
        {"arc", "linear, sine", "linear, cosine", "quadratic, sine", "quadratic, cosine"});
    for (const double degrees : {15.0, 30.0, 60.0, 90.0}) {
        const PathDeviation d = path_deviation(degrees * kRadians);
        arcs.add(
            {fmt::format("{:.0f}°", degrees), number(d.linear_sine), number(d.linear_cosine),
             number(d.quadratic_sine), number(d.quadratic_cosine)});
    }
    HtmlTable edges(
        {"scene", "edges", "normals turn by", "N from H by", "linear, largest", "mean",
         "quadratic, largest", "mean"});
    for (const SceneResult& result : results) {
        const EdgePaths paths = edge_paths(result.scene);
        edges.add(
            {result.scene.name, std::to_string(paths.edges),
             fmt::format("{:.0f}°", paths.turn / kRadians),
             fmt::format("{:.0f}°", paths.from_h / kRadians), number(paths.linear),
             number(paths.linear_mean), number(paths.quadratic), number(paths.quadratic_mean)});
    }
    return "<h3>Along an edge: paths against polynomials</h3>\n<p>How far the sine and the cosine "
           "of an arc are from the line through its ends, and from the quadratic through its ends "
           "and center:</p>\n"
           + arcs.html()
           + "<p>How far the Blinn coordinates of the normals along an edge are, in the unit disc. "
             "Edges on which a normal points away from H are left out:</p>\n"
           + edges.html();
}

// ---- parts

const MethodResult& result_of(const SceneResult& scene, std::string_view id) {
    return *std::find_if(scene.methods.begin(), scene.methods.end(), [id](const MethodResult& one) {
        return one.method->id == id;
    });
}

double relative_work(const SceneResult& scene, const MethodResult& one) {
    return weighted_operations(one.image)
           / std::max(weighted_operations(reference_of(scene, one)), 1.0);
}

bool is_fine(const SceneResult& scene) {
    return scene.scene.mesh.triangles.size() > 1000;
}

}  // namespace limn::fakephong
