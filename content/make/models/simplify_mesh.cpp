#include "content/make/models/simplify_mesh.h"

#include "content/bake/tangents.h"
#include "content/make/models/keep_triangles.h"

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

}  // namespace

void simplify_mesh(MeshData& mesh, std::size_t triangles) {
    if (3 * triangles >= mesh.indices.size()) {
        return;
    }
    std::vector<std::uint32_t> indices(mesh.indices.size());
    indices.resize(meshopt_simplify(
        indices.data(), mesh.indices.data(), mesh.indices.size(), &mesh.positions[0].x,
        mesh.positions.size(), sizeof(Vec3), 3 * triangles, kLargestError));
    keep_triangles(mesh, std::move(indices));
}

void merge_mesh(MeshData& mesh, std::size_t triangles) {
    if (3 * triangles >= mesh.indices.size()) {
        return;
    }
    // A coarse grid may merge a thin part, as a leg, to nothing: narrow axes get smaller cells,
    // too, and the grid that keeps the size of the whole best is used.
    constexpr float kAnyError = 1.0f;
    constexpr float kStretches[] = {1.0f, 1.5f, 2.0f, 3.0f};
    const Vec3 size = extent_of(mesh, mesh.indices);
    const float longest = std::max({size.x, size.y, size.z});
    std::vector<std::uint32_t> best;
    float least_lost = std::numeric_limits<float>::max();
    for (const float stretch : kStretches) {
        const Vec3 scale =
            glm::mix(Vec3(stretch), Vec3(1), glm::greaterThan(size, Vec3(0.7f * longest)));
        std::vector<Vec3> positions = mesh.positions;
        for (Vec3& p : positions) {
            p *= scale;
        }
        std::vector<std::uint32_t> indices(mesh.indices.size());
        indices.resize(meshopt_simplifySloppy(
            indices.data(), mesh.indices.data(), mesh.indices.size(), &positions[0].x,
            positions.size(), sizeof(Vec3), 3 * triangles, kAnyError));
        const Vec3 lost = size - extent_of(mesh, indices);
        const float loss = std::max({lost.x, lost.y, lost.z});
        if (loss < 0.9f * least_lost) {  // only for much less: cubes have the best shapes
            least_lost = loss;
            best = std::move(indices);
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
    shape.merge ? merge_mesh(mesh, triangles) : simplify_mesh(mesh, triangles);
    update_bounds(mesh);
    return mesh;
}

}  // namespace limn
