#include "content/make/models/simplify_mesh.h"

#include "content/bake/tangents.h"
#include "content/make/models/keep_triangles.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

// Techniques: engine.lod-mesh

namespace limn {

namespace {

constexpr float kLargestError = 0.05f;  ///< relative to the size of the mesh

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
    constexpr float kAnyError = 1.0f;
    std::vector<std::uint32_t> indices(mesh.indices.size());
    indices.resize(meshopt_simplifySloppy(
        indices.data(), mesh.indices.data(), mesh.indices.size(), &mesh.positions[0].x,
        mesh.positions.size(), sizeof(Vec3), 3 * triangles, kAnyError));
    keep_triangles(mesh, std::move(indices));
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
