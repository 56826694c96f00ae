#include "bench/quality/fakephong_file.h"

#include "bench/fakephong/phong_models.h"
#include "bench/quality/fakephong_page.h"
#include "bench/quality/fakephong_tables.h"
#include "content/app/commands/progress.h"
#include "content/app/commands/stage.h"
#include "ecs/base/text.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace limn {
namespace fakephong {
namespace {

void append(PhongMesh& to, const MeshData& mesh, const Affine& world_from_mesh) {
    const auto first = static_cast<std::uint32_t>(to.positions.size());
    PhongMesh faceted = phong_mesh(mesh);
    const Mat3 turn(
        transform_vector(world_from_mesh, {1, 0, 0}), transform_vector(world_from_mesh, {0, 1, 0}),
        transform_vector(world_from_mesh, {0, 0, 1}));
    // The cofactor matrix: like the inverse transpose, but without a division by 0 for flat scales.
    const Mat3 normals(
        glm::cross(turn[1], turn[2]), glm::cross(turn[2], turn[0]), glm::cross(turn[0], turn[1]));
    const bool mirrored = glm::dot(turn[0], normals[0]) < 0;
    for (std::size_t i = 0; i < faceted.positions.size(); ++i) {
        to.positions.emplace_back(transform_point(world_from_mesh, mesh.positions[i]));
        to.normals.emplace_back((mirrored ? -1.0f : 1.0f) * (normals * Vec3(faceted.normals[i])));
    }
    for (auto [a, b, c] : faceted.triangles) {
        if (mirrored) {
            std::swap(b, c);
        }
        to.triangles.push_back({first + a, first + b, first + c});
    }
}

/// The drawable facets, and the number of their corners without a vertex normal.
struct MeshCounts {
    std::size_t drawn = 0;
    std::size_t without_normal = 0;
};
MeshCounts count_facets(const PhongMesh& mesh) {
    MeshCounts counts;
    Facet facet;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (make_facet(mesh, i, facet)) {
            ++counts.drawn;
            for (const std::uint32_t corner : mesh.triangles[i]) {
                const dvec3& n = mesh.normals[corner];
                counts.without_normal += glm::dot(n, n) > 1e-24 ? 0 : 1;
            }
        }
    }
    return counts;
}

}  // namespace

Result<PhongScene> scene_of_world(const World& world, const std::string& name) {
    PhongScene scene = {.name = name};
    const auto* assets = world.find_resource<Assets>();
    if (assets != nullptr) {
        world.query<const MeshInstance, const WorldTransform>().each(
            [&](Entity, const MeshInstance& instance, const WorldTransform& transform) {
                if (instance.mesh.index < assets->meshes.size()) {
                    append(scene.mesh, assets->meshes[instance.mesh.index], transform.world);
                }
            });
    }
    const std::size_t found = scene.mesh.triangles.size();
    if (count_facets(scene.mesh).drawn == 0) {
        return fail(
            "{}: found {} triangles, none with an area, expected at least one to shade", name,
            found);
    }
    dvec3 low(std::numeric_limits<double>::infinity());
    dvec3 high = -low;
    for (const dvec3& p : scene.mesh.positions) {
        if (std::isfinite(p.x + p.y + p.z)) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    }
    const dvec3 center = 0.5 * (low + high);
    const double radius = std::max(0.5 * glm::distance(low, high), 1e-9);
    scene.camera.target = center;
    scene.camera.eye = center + radius * dvec3(1.2, 0.9, 3.6);
    scene.lights = {{.at = center + radius * dvec3(-0.9, 1.2, 1.8)}};
    scene.material.color = {0.2, 0.4, 1};
    LIMN_TRY(check_scene(scene));
    return scene;
}

}  // namespace fakephong

Status measure_fakephong_file(const std::string& path, QualityReport& report) {
    using namespace fakephong;
    PhongScene scene;
    {
        const std::unique_ptr<Stage> stage = LIMN_TRY(open_stage(path));
        if (stage->scene.model) {
            for (const Entity added : stage->scene.model->added) {  // a ground, a camera
                destroy_tree(stage->world, added);
            }
        }
        scene = LIMN_TRY(scene_of_world(stage->world, path));
    }
    const MeshCounts counts = count_facets(scene.mesh);
    const std::size_t triangles = scene.mesh.triangles.size();
    report.inform("triangles", static_cast<double>(triangles));
    report.inform("  without an area, left out", static_cast<double>(triangles - counts.drawn));
    report.inform(
        "  corners without a normal, which use the facet normal",
        static_cast<double>(counts.without_normal));
    Progress progress("method", static_cast<int>(shading_methods().size()));
    std::vector<SceneResult> results = {
        evaluate_scene(scene, [&progress](int done) { progress.update(done); })};
    report.inform("pixels covered", static_cast<double>(results[0].phong.pixels));
    for (const MethodResult& one : results[0].methods) {
        report.inform(fmt::format("{}: color correctness", one.method->name), one.correctness);
        report.inform(
            fmt::format("{}: height of the scanline's peak over Phong's", one.method->name),
            one.scanline.peak_ratio);
        // The other methods differ for known reasons: appendix A has no highlight where N.L <= 0,
        // and no great circle joins opposite normals.
        const std::string at_samples =
            fmt::format("{}: error at its own samples", one.method->name);
        const bool in_table = &one < &results[0].methods[kTableColumns];
        if (in_table && one.method->exact_points > 0) {
            report.at_most(at_samples, one.error_at_samples, 1e-5);
        } else {
            report.inform(at_samples, one.error_at_samples);
        }
        report.inform(
            fmt::format("{}: work of a frame over Phong's", one.method->name),
            relative_work(results[0], one));
    }
    const EdgePaths paths = edge_paths(scene);
    report.inform("Blinn coordinates along edges, from linear, mean", paths.linear_mean);
    report.inform("Blinn coordinates along edges, from quadratic, mean", paths.quadratic_mean);
    results[0].scene.name = escape_html(path);
    report.html = LIMN_TRY(fakephong_html(results));
    return Done{};
}

}  // namespace limn
