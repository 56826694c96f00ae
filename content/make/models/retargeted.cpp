#include "content/make/models/retargeted.h"

#include "content/bake/point_warp.h"
#include "content/bake/surface_fit.h"
#include "content/bake/tangents.h"
#include "ecs/base/log.h"
#include "ecs/base/text.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstddef>

// Techniques: face.retarget-fit, face.retarget-warp

namespace limn {
namespace {

constexpr int kIterations = 20;
/// Half width of the midline band relative to the width of the mesh. Its vertices belong to neither
/// side, since rounding would assign them arbitrarily.
constexpr float kMidline = 0.005f;

/// Mean of the positions on the left (side 1) or right (side -1) of the center, by weights. False
/// without any.
bool find_center(const MeshData& mesh, const VertexRegion& region, float side, Vec3& center) {
    Vec3 sum(0);
    float weights = 0.0f;
    const float center_x = 0.5f * (mesh.bounds.min.x + mesh.bounds.max.x);
    const float clear = kMidline * (mesh.bounds.max.x - mesh.bounds.min.x);
    for (std::size_t v = 0; v < region.weights.size() && v < mesh.positions.size(); ++v) {
        if (side * (mesh.positions[v].x - center_x) > clear) {
            sum += region.weights[v] * mesh.positions[v];
            weights += region.weights[v];
        }
    }
    center = weights > 0.0f ? sum / weights : Vec3(0);
    return weights > 0.0f;
}

Vec3 find_extreme(const MeshData& mesh, const Vec3& direction) {
    return *std::max_element(
        mesh.positions.begin(), mesh.positions.end(), [&](const Vec3& a, const Vec3& b) {
            return glm::dot(a, direction) < glm::dot(b, direction);
        });
}

}  // namespace

std::pair<std::vector<Vec3>, std::vector<Vec3>>
corresponding_points(const MeshData& from, const MeshData& onto) {
    std::pair<std::vector<Vec3>, std::vector<Vec3>> pairs;
    for (const VertexRegion& region : from.regions) {
        const auto same =
            std::find_if(onto.regions.begin(), onto.regions.end(), [&](const VertexRegion& other) {
                return other.name == region.name;
            });
        for (const float side : {1.0f, -1.0f}) {
            Vec3 a;
            Vec3 b;
            if (same != onto.regions.end() && find_center(from, region, side, a)
                && find_center(onto, *same, side, b)) {
                pairs.first.push_back(a);
                pairs.second.push_back(b);
            }
        }
    }
    for (const Vec3& axis :
         {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 1),
          Vec3(0, 0, -1)}) {
        pairs.first.push_back(find_extreme(from, axis));
        pairs.second.push_back(find_extreme(onto, axis));
    }
    return pairs;
}

Result<MeshData> retarget_surface(
    const MeshData& surface, const MeshData& from, const MeshData& onto, float gain,
    float stiffness) {
    if (from.positions.empty() || onto.indices.size() < 3) {
        return fail("{} or {} has no triangles", from.name, onto.name);
    }
    const auto [here, there] = corresponding_points(from, onto);
    const Result<PointWarp> warp = make_point_warp(here, there);
    if (!warp) {
        return fail("from {} onto {}: {}", from.name, onto.name, warp.error().message);
    }
    std::vector<Vec3> warped;
    for (const Vec3& p : surface.positions) {
        warped.push_back(warp_point(*warp, p));
    }
    MeshData fitted = surface;
    fitted.positions = fit_surface(
                           warped, surface.indices, onto.positions, onto.indices,
                           {.strain = stiffness, .bending = stiffness, .distance = 1}, kIterations)
                           .positions;
    for (MorphTarget& morph : fitted.morphs) {
        for (std::size_t i = 0; i < morph.vertices.size(); ++i) {
            morph.positions[i] =
                warp_offset(*warp, surface.positions[morph.vertices[i]], morph.positions[i], gain);
        }
        morph.normals.clear();
        morph.tangents.clear();
    }
    update_bounds(fitted);
    return fitted;
}

MeshData make_retargeted(const RetargetedShape& shape, const Assets& assets) {
    const std::size_t last = std::max({shape.mesh.index, shape.from.index, shape.onto.index});
    if (last >= assets.meshes.size()) {
        return {};
    }
    const MeshData& surface = assets.meshes[shape.mesh.index];
    Result<MeshData> fitted = retarget_surface(
        surface, assets.meshes[shape.from.index], assets.meshes[shape.onto.index], shape.gain,
        shape.stiffness);
    if (!fitted) {
        log_warn("retargeted {}: {}; it is left unchanged", surface.name, fitted.error().message);
        return surface;
    }
    return *std::move(fitted);
}

}  // namespace limn
