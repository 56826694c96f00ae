#include "render/geometry/coarse_triangles.h"

#include "ecs/base/hash.h"
#include "ecs/base/jobs.h"
#include "render/geometry/triangle_grid.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

namespace limn {
namespace {

using Indices = std::vector<std::uint32_t>;

constexpr std::size_t kMinTriangles = 48;  // a smaller mesh costs less than its draw call
constexpr std::size_t kCoarsestTriangles = 8;
constexpr float kMaxError = 0.5f;  // quadric error, relative to the size of the mesh
constexpr float kRatio = 0.4f;     // target triangle count relative to the previous level
// The finest levels draw what is large on screen: steps between them are smaller.
constexpr float kFineRatios[] = {0.65f, 0.62f};
constexpr float kWorthwhile = 0.75f;
// Meshes with more triangles than this in smaller components, such as points and lines, are not
// simplified: there is little to collapse, and measuring distances takes seconds per million
// triangles.
constexpr std::size_t kMaxLooseTriangles = 200'000;
constexpr std::size_t kMinPiece = 12;

/// The triangles of the mesh after welding vertices at equal positions, without degenerate ones.
Indices welded_indices(const MeshData& mesh) {
    Indices indices(mesh.indices.size() / 3 * 3);
    meshopt_generateShadowIndexBuffer(
        indices.data(), mesh.indices.data(), indices.size(), mesh.positions.data(),
        mesh.positions.size(), sizeof(Vec3), sizeof(Vec3));
    Indices kept;
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        const std::uint32_t* t = &indices[i];
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) {
            kept.insert(kept.end(), t, t + 3);
        }
    }
    return kept;
}

/// The vertices that `indices` refer to, each once.
Indices vertices_of(Indices indices) {
    std::sort(indices.begin(), indices.end());
    indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
    return indices;
}

/// Largest distance from any of `vertices` to the triangles `coarser` [m].
float distance_from(const MeshData& mesh, const Indices& vertices, const Indices& coarser) {
    if (coarser.empty()) {
        return INFINITY;
    }
    const TriangleGrid grid(mesh.positions, coarser);
    constexpr std::size_t kJobVertices = 4096;
    std::vector<float> largest(vertices.size() / kJobVertices + 1);
    parallel_for(largest.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t job = begin; job < end; ++job) {
            const std::size_t last = std::min(vertices.size(), (job + 1) * kJobVertices);
            for (std::size_t i = job * kJobVertices; i < last; ++i) {
                const Vec3& p = mesh.positions[vertices[i]];
                largest[job] = std::max(largest[job], grid.distance(p, largest[job]));
            }
        }
    });
    return *std::max_element(largest.begin(), largest.end());
}

/// `finer` with edges collapsed, as far as that keeps the surface closed.
Indices collapse(const MeshData& mesh, const Indices& finer, std::size_t wanted) {
    Indices coarser(finer.size());
    coarser.resize(meshopt_simplify(
        coarser.data(), finer.data(), finer.size(), &mesh.positions[0].x, mesh.positions.size(),
        sizeof(Vec3), wanted, kMaxError));
    return coarser;
}

/// `finer` with the vertices in each cell of a grid merged, closed or not.
Indices cluster(const MeshData& mesh, const Indices& finer, std::size_t wanted) {
    Indices coarser(finer.size());
    coarser.resize(meshopt_simplifySloppy(
        coarser.data(), finer.data(), finer.size(), &mesh.positions[0].x, mesh.positions.size(),
        sizeof(Vec3), wanted, kMaxError));
    return coarser;
}

/// Connected components: sets of triangles that share no vertex with others.
std::size_t count_pieces(const Indices& indices, std::size_t vertices) {
    Indices parent(vertices);
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root_of = [&parent](std::uint32_t vertex) {
        while (parent[vertex] != vertex) {
            parent[vertex] = parent[parent[vertex]];
            vertex = parent[vertex];
        }
        return vertex;
    };
    std::size_t pieces = vertices_of(indices).size();
    for (std::size_t i = 0; i < indices.size(); ++i) {
        const std::uint32_t a = root_of(indices[i]);
        const std::uint32_t b = root_of(indices[i / 3 * 3]);
        pieces -= a != b ? 1 : 0;
        parent[a] = b;
    }
    return pieces;
}

bool is_loose(const Indices& indices, std::size_t vertices) {
    const std::size_t triangles = indices.size() / 3;
    return triangles > kMaxLooseTriangles
           && triangles < kMinPiece * count_pieces(indices, vertices);
}

bool is_rigid(const MeshData& mesh) {
    return mesh.skin.empty() && mesh.morphs.empty();
}

}  // namespace

std::vector<CoarseTriangles> simplify_triangles(const MeshData& mesh) {
    std::vector<CoarseTriangles> levels;
    const auto finite = [](const Vec3& p) { return is_finite(p); };
    if (mesh.indices.size() < 3 * kMinTriangles
        || !std::all_of(mesh.positions.begin(), mesh.positions.end(), finite)) {
        return levels;
    }
    const Indices all = is_rigid(mesh) ? welded_indices(mesh) : mesh.indices;
    if (is_loose(all, mesh.positions.size())) {
        return levels;
    }
    const Indices vertices = vertices_of(all);
    Indices finer = all;
    finer.resize(finer.size() / 3 * 3);
    float error = 0;
    while (levels.size() < kMaxCoarseLevels && finer.size() > 3 * kCoarsestTriangles) {
        const auto index_count = [&](float fraction) {
            return static_cast<std::size_t>(fraction * static_cast<float>(finer.size() / 3)) * 3;
        };
        const float ratio =
            levels.size() < std::size(kFineRatios) ? kFineRatios[levels.size()] : kRatio;
        Indices coarser = collapse(mesh, finer, index_count(ratio));
        float distance = distance_from(mesh, vertices, coarser);
        Indices merged = mesh.morphs.empty() ? cluster(mesh, all, index_count(ratio)) : Indices();
        const float merged_distance = distance_from(mesh, vertices, merged);
        if (coarser.size() > index_count(kWorthwhile) || merged_distance < distance) {
            coarser = std::move(merged);
            distance = merged_distance;
        }
        if (coarser.empty() || coarser.size() > index_count(kWorthwhile)) {
            break;
        }
        error = std::max(error, distance);
        levels.push_back({coarser, error});
        finer = std::move(coarser);
    }
    return levels;
}

}  // namespace limn
