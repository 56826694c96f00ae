#include "bench/fakephong/phong_models.h"
#include "bench/quality/fakephong_file.h"
#include "bench/quality/fakephong_page.h"
#include "bench/quality/quality.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace limn::fakephong_quality {
namespace {

using namespace fakephong;

/// Each number of the table, and whether the columns keep their printed order.
void compare_with_printed(
    const SceneResult& result, const PrintedRow& row, double limit, QualityReport& report) {
    for (std::size_t i = 0; i < kTableColumns; ++i) {
        const MethodResult& one = result.methods[i];
        report.inform(fmt::format("{}: {}", result.scene.name, one.method->name), one.correctness);
        report.at_most(
            fmt::format(
                "{}: {}, from the printed {:.4f}", result.scene.name, one.method->name,
                row.correctness[i]),
            std::abs(one.correctness - row.correctness[i]), limit);
    }
    report.at_most(
        fmt::format("{}: pairs not in the printed order", result.scene.name),
        swapped_pairs(correctness_row(result), row.correctness), 0);
}

/// On coarse closed meshes: quadratic Blinn map, Blinn map, then all others of the table.
void check_coarse(const SceneResult& result, QualityReport& report) {
    double others = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        others = std::max(others, result.methods[i].correctness);
    }
    const double blinn = result.methods[4].correctness;
    report.at_least(
        fmt::format("{}: Blinn map above all but the quadratic", result.scene.name), blinn - others,
        0);
    report.at_least(
        fmt::format("{}: quadratic Blinn map above the Blinn map", result.scene.name),
        result.methods[5].correctness - blinn, 0);
}

/// Edge paths and forward differences, which have no tables in the thesis.
void measure_paths(const SceneResult& result, QualityReport& report) {
    const std::string& name = result.scene.name;
    const EdgePaths paths = edge_paths(result.scene);
    report.inform(
        fmt::format("{}: Blinn coordinates along edges, from linear, mean", name),
        paths.linear_mean);
    report.at_most(
        fmt::format("{}: from quadratic over from linear", name),
        paths.quadratic_mean / std::max(paths.linear_mean, 1e-12), 1);
}
void measure_steps(const SceneResult& result, QualityReport& report) {
    for (const SteppedMethod& one : step_scene(result.scene)) {
        const std::string name =
            fmt::format("{}: {} by forward differences", result.scene.name, one.method->name);
        report.at_most(name + ", from each pixel asked", one.difference, 1e-6);
        report.inform(
            name + ", work of a frame over that",
            weighted_operations(one.stepped) / std::max(weighted_operations(one.direct), 1.0));
    }
}

Status measure_fakephong(HeadlessRenderer& /*headless*/, QualityReport& report) {
    std::vector<SceneResult> results;
    for (const PhongScene& scene :
         {printed_teapot_scene(), printed_triangle_scene(), triangle_scene(), teapot_scene(),
          dodecahedron_scene(), sphere_scene(), fine_sphere_scene()}) {
        LIMN_TRY(check_scene(scene));
        results.push_back(evaluate_scene(scene));
    }
    compare_with_printed(results[0], printed_table()[0], 0.0035, report);
    compare_with_printed(results[1], printed_table()[1], 0.01, report);
    compare_with_printed(results[2], printed_table()[1], 0.028, report);  // the canonical scene
    check_coarse(results[4], report);
    check_coarse(results[5], report);
    double lowest = 1;
    double at_samples = 0;
    for (std::size_t i = 0; i < kTableColumns; ++i) {
        lowest = std::min(lowest, results[6].methods[i].correctness);
        for (const SceneResult& result : results) {
            if (result.methods[i].method->exact_points > 0) {
                at_samples = std::max(at_samples, result.methods[i].error_at_samples);
            }
        }
    }
    for (const SceneResult& result : results) {
        measure_paths(result, report);
    }
    measure_steps(results[1], report);
    measure_steps(results[3], report);
    report.at_least("fine sphere: lowest of the six", lowest, 0.98);
    report.at_most(
        "all scenes: error at sample points, except for the environment map", at_samples, 1e-5);
    report.html = LIMN_TRY(fakephong_html(results));
    return Done{};
}

const RegisterQuality kRegistered(
    "fakephong", "Phong shading per pixel, and Table 6.1 of the thesis", measure_fakephong,
    measure_fakephong_file);

}  // namespace
}  // namespace limn::fakephong_quality
