#include "content/make/models/simplify_mesh.h"

#include "content/bake/tangents.h"
#include "content/make/models/keep_triangles.h"
#include "content/make/models/merge_joints.h"
#include "ecs/base/log.h"

#include <glm/geometric.hpp>
#include <meshoptimizer.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

// Techniques: engine.lod-mesh

namespace limn {

namespace {

constexpr float kLargestError = 0.05f;  ///< relative to the size of the mesh

/// Size of the box of the triangles; 0 without any.
Vec3 extent_of(const MeshData& mesh, const std::vector<std::uint32_t>& indices) {
    if (indices.empty()) {
        return Vec3(0);
    }
    Vec3 low = mesh.positions[indices[0]];
    Vec3 high = low;
    for (const std::uint32_t index : indices) {
        low = glm::min(low, mesh.positions[index]);
        high = glm::max(high, mesh.positions[index]);
    }
    return high - low;
}

/// The joint with the largest weight at a vertex.
std::uint32_t main_joint(const SkinWeights& skin, std::size_t vertex) {
    const auto first = skin.weights.begin() + skin.first[vertex];
    const auto last = skin.weights.begin() + skin.first[vertex + 1];
    return first == last ? 0
                         : skin.joints[static_cast<std::size_t>(
                             std::max_element(first, last) - skin.weights.begin())];
}

/// Positions with what moves with each joint `spread` times as far again from the middle: legs and
/// arms that hang side by side then lie in different cells, and are not joined by webs.
std::vector<Vec3> spread_limbs(const MeshData& mesh, float spread) {
    std::vector<Vec3> positions = mesh.positions;
    if (mesh.skin.empty() || spread == 0) {
        return positions;
    }
    struct Part {
        Vec3 sum = {0, 0, 0};
        float count = 0;
    };
    std::vector<Part> parts;
    Part whole;
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const std::uint32_t joint = main_joint(mesh.skin, v);
        parts.resize(std::max<std::size_t>(parts.size(), joint + 1));
        parts[joint].sum += positions[v];
        parts[joint].count += 1;
        whole.sum += positions[v];
        whole.count += 1;
    }
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const Part& part = parts[main_joint(mesh.skin, v)];
        positions[v] += spread * (part.sum / part.count - whole.sum / whole.count);
    }
    return positions;
}

/// Positions of which those of dark vertices are closer to the center.
std::vector<Vec3> sunk_by_color(const MeshData& mesh, float depth) {
    std::vector<Vec3> positions = mesh.positions;
    if (depth <= 0 || mesh.colors.size() != positions.size()) {
        return positions;
    }
    const Vec3 size = extent_of(mesh, mesh.indices);
    const float deepest = depth * std::max({size.x, size.y, size.z});
    Vec3 center(0);
    for (const Vec3& p : positions) {
        center += p / static_cast<float>(positions.size());
    }
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const Vec3 color = mesh.colors[v];
        const float dark = 1 - (color.x + color.y + color.z) / 3;
        const Vec3 inwards = center - positions[v];
        const float distance = glm::length(inwards);
        if (distance > 0) {
            positions[v] += inwards / distance * (deepest * dark);
        }
    }
    return positions;
}

}  // namespace

void simplify_mesh(MeshData& mesh, std::size_t triangles, float colors) {
    if (3 * triangles >= mesh.indices.size()) {
        return;
    }
    const std::vector<Vec3> positions = sunk_by_color(mesh, colors);
    std::vector<std::uint32_t> indices(mesh.indices.size());
    indices.resize(meshopt_simplify(
        indices.data(), mesh.indices.data(), mesh.indices.size(), &positions[0].x, positions.size(),
        sizeof(Vec3), 3 * triangles, kLargestError));
    keep_triangles(mesh, std::move(indices));
}

void merge_mesh(MeshData& mesh, std::size_t triangles) {
    if (3 * triangles >= mesh.indices.size()) {
        return;
    }
    constexpr float kAnyError = 1.0f;
    constexpr float kSmallLoss = 0.1f;  // of the size
    constexpr float kSpreads[] = {4.0f, 3.0f, 2.0f, 1.0f, 0.0f};
    const Vec3 size = extent_of(mesh, mesh.indices);
    std::vector<std::uint32_t> best;
    float least_lost = std::numeric_limits<float>::max();
    for (const float spread : kSpreads) {
        const std::vector<Vec3> positions = spread_limbs(mesh, spread);
        std::vector<std::uint32_t> indices(mesh.indices.size());
        indices.resize(meshopt_simplifySloppy(
            indices.data(), mesh.indices.data(), mesh.indices.size(), &positions[0].x,
            positions.size(), sizeof(Vec3), 3 * triangles, kAnyError));
        const Vec3 lost = size - extent_of(mesh, indices);
        const float loss = std::max({lost.x, lost.y, lost.z});
        if (loss < least_lost) {
            least_lost = loss;
            best = std::move(indices);
        }
        if (loss < kSmallLoss * std::max({size.x, size.y, size.z})) {
            break;  // limbs far apart have the best shapes
        }
    }
    keep_triangles(mesh, std::move(best));
}

MeshData make_simplified(const SimplifiedShape& shape, const Assets& assets) {
    if (shape.mesh.index >= assets.meshes.size()) {
        return {};
    }
    MeshData mesh = assets.meshes[shape.mesh.index];
    mesh.pieces.clear();
    const auto triangles = static_cast<std::size_t>(std::max(shape.triangles, 4));
    shape.merge ? merge_mesh(mesh, triangles) : simplify_mesh(mesh, triangles, shape.colors);
    const auto skeleton = std::ranges::find(assets.skeletons, mesh.name, &SkeletonData::name);
    const auto skin = std::ranges::find(assets.skins, mesh.name, &SkinData::name);
    if (shape.joints > 0 && !mesh.skin.empty()) {
        if (skeleton != assets.skeletons.end() && skin != assets.skins.end()) {
            merge_joints(mesh.skin, *skin, *skeleton, static_cast<std::size_t>(shape.joints));
        } else {
            log_warn(
                "simplified: joints has no effect on {}, which has no skeleton of its name",
                mesh.name);
        }
    }
    update_bounds(mesh);
    return mesh;
}

}  // namespace limn
