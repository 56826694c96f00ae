#include "render/geometry/mesh_memory.h"

#include "ecs/base/hash.h"
#include "ecs/base/jobs.h"
#include "render/geometry/mesh_curvature.h"
#include "render/geometry/triangle_order.h"

namespace limn {
namespace {

/// Covers all that simplify_triangles(), order_for_cache() and fit_curvatures() read.
std::uint64_t hash_of(const MeshData& mesh) {
    std::uint64_t hash = (mesh.skin.empty() ? 1u : 0u) + (mesh.morphs.empty() ? 2u : 0u);
    const auto append = [&hash](const auto& values) {
        hash = hash_bytes(values.data(), values.size() * sizeof(values[0]), hash);
        hash = hash_combine(hash, values.size());
    };
    append(mesh.positions);
    append(mesh.normals);
    append(mesh.tangents);
    append(mesh.indices);
    return hash;
}

}  // namespace

std::vector<const PreparedMesh*>
MeshMemory::prepare(std::span<const MeshData* const> meshes, bool curved) {
    if (bytes_ > kMaxBytes) {
        prepared_.clear();
        bytes_ = 0;
    }
    std::vector<std::uint64_t> keys(meshes.size());
    parallel_for(meshes.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            keys[i] = meshes[i] != nullptr ? hash_of(*meshes[i]) : 0;
        }
    });
    // Deduplicated, so that no two threads write the same entry.
    struct Missing {
        const MeshData* mesh;
        PreparedMesh* prepared;
        bool fresh;
    };
    std::vector<Missing> missing;
    std::vector<const PreparedMesh*> found(meshes.size());
    std::map<const PreparedMesh*, bool> listed;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        if (meshes[i] == nullptr) {
            continue;
        }
        const auto [at, fresh] = prepared_.try_emplace(keys[i]);
        found[i] = &at->second;
        const bool curves = curved && at->second.curvatures.empty();
        if ((fresh || curves) && listed.try_emplace(found[i]).second) {
            missing.push_back({meshes[i], &at->second, fresh});
        }
    }
    parallel_for(missing.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto& [mesh, prepared, fresh] = missing[i];
            if (fresh) {
                const std::size_t whole = mesh->indices.size() / 3 * 3;
                prepared->ordered =
                    order_for_cache(std::span(mesh->indices).first(whole), mesh->positions.size());
                prepared->coarse = simplify_triangles(*mesh);
            }
            if (curved) {
                prepared->curvatures = fit_curvatures(*mesh);
            }
        }
    });
    for (const Missing& one : missing) {
        bytes_ += curved ? one.prepared->curvatures.size() * sizeof(Vec2) : 0;
        bytes_ += one.fresh ? 4 * one.prepared->ordered.size() : 0;
        for (const CoarseTriangles& level : one.prepared->coarse) {
            bytes_ += one.fresh ? 4 * level.indices.size() : 0;
        }
    }
    return found;
}

}  // namespace limn
