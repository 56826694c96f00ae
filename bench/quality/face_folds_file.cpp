#include "bench/quality/face_folds_file.h"

#include "bench/oracles/face_folding.h"
#include "content/load/gltf/gltf_load.h"
#include "ecs/base/text.h"
#include "ecs/components/all.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace limn {
namespace {

constexpr double kContrast = 5;  ///< minimum ratio of folding skin to skin that does not fold
constexpr double kMirror = 2;    ///< maximum difference between both sides [%]

std::string cell_of(double shortening) {
    const double red = std::min(shortening / 0.2, 1.0);
    return fmt::format(
        R"~(<td style="background:rgba(200,40,20,{:.2f})">{:.1f}</td>)~", 0.85 * red,
        100 * shortening);
}

/// A row for each expression, a column for each region.
std::string
table_of(std::string_view name, const MeshData& face, const oracle::FaceFolding& folding) {
    std::string html = fmt::format(
        "<h3>{}: shortening across the folds of each region [%]</h3><table><tr><th></th><th></th>",
        escape_html(name));
    for (const VertexRegion& region : face.regions) {
        html += fmt::format("<th>{}</th>", escape_html(region.name));
    }
    html += "</tr>";
    for (const oracle::FaceExpression& expression : oracle::find_face_expressions(face)) {
        html += fmt::format(
            "<tr><td>{}</td><td>{}</td>", escape_html(expression.name),
            escape_html(expression.unit));
        for (const oracle::RegionFolding& region : folding.measure(expression.morphs)) {
            html += cell_of(region.shortening);
        }
        html += "</tr>";
    }
    return html + "</table>";
}

std::size_t count_units(const MeshData& mesh) {
    std::size_t count = 0;
    for (const oracle::FaceExpression& expression : oracle::find_face_expressions(mesh)) {
        count += expression.unit.empty() ? 0 : 1;
    }
    return count;
}

}  // namespace

Status
measure_face(std::string_view name, const MeshData& face, QualityReport& report, bool has_dimples) {
    const bool directed = std::ranges::any_of(
        face.regions, [](const VertexRegion& region) { return !region.across.empty(); });
    if (!directed || face.morphs.empty()) {
        return fail(
            "{}: found {} morph targets and {} regions, expected both: expressions, and where skin "
            "folds",
            name, face.morphs.size(), face.regions.size());
    }
    const oracle::FaceFolding folding(face);
    double rest = 0;
    for (const oracle::RegionFolding& region : folding.measure({})) {
        rest = std::max(rest, region.shortening);
    }
    report.at_most(fmt::format("{}: shortening at rest", name), 100 * rest, 1e-3, "%");
    for (const oracle::FoldingRule& rule : oracle::folding_rules()) {
        oracle::FoldingResult result;
        if (!oracle::apply_rule(rule, face, folding, result)) {
            continue;
        }
        std::string regions;
        for (const std::string_view region : rule.folds) {
            regions += (regions.empty() ? "" : " or ") + std::string(region);
        }
        report.inform(
            fmt::format("{}: {}, shortening of {}", name, rule.name, regions), 100 * result.folding,
            "%");
        const std::string contrast =
            fmt::format("{}: {}, relative to smooth skin", name, rule.name);
        const double ratio = result.folding / std::max(result.smooth, 1e-4);
        if (rule.dimples && !has_dimples) {
            report.inform(contrast, ratio);
            continue;
        }
        report.at_least(contrast, ratio, kContrast);
        report.at_most(
            fmt::format("{}: {}, left against right", name, rule.name), 100 * result.difference,
            kMirror, "%");
    }
    report.html += table_of(name, face, folding);
    return Done{};
}

Status measure_face_file(const std::string& path, QualityReport& report) {
    register_all_components();
    const GltfScene scene = LIMN_TRY(load_gltf(path));
    const MeshData* face = nullptr;
    std::size_t most = 0;
    for (const MeshData& mesh : scene.meshes) {
        const std::size_t count = count_units(mesh);
        const bool larger = face == nullptr || mesh.positions.size() > face->positions.size();
        if (count > most || (count == most && count > 0 && larger)) {
            most = count;
            face = &mesh;
        }
    }
    if (face == nullptr) {
        return fail(
            "{}: found no morph target named as an action unit, expected a face with some, as "
            "AU12_L, mouthSmileLeft or mouthSmile_L",
            path);
    }
    return measure_face(path.substr(path.find_last_of('/') + 1), *face, report);
}

}  // namespace limn
