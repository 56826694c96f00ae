#include "render/shadow/shadow_mesh_pool.h"

#include "ecs/base/check.h"
#include "render/gpu/grown_buffer.h"
#include "render/shaders/shadow_volume_gpu.h"

#include <algorithm>
#include <cstddef>

namespace limn {
namespace {

constexpr std::size_t kInitialVertices = 1 << 14;
constexpr std::size_t kInitialIndices = 1 << 16;

constexpr gpu::VertexAttribute kVolumeAttributes[] = {
    {.location = 0, .stream = kVolumeCornerStream, .components = 4},
    {.location = 1,
     .stream = kVolumeCornerStream,
     .components = 4,
     .offset = offsetof(VolumeVertex, plane)},
    {.location = 2, .stream = kVolumeInstanceStream, .components = 4, .offset = 0},
    {.location = 3, .stream = kVolumeInstanceStream, .components = 4, .offset = 16},
    {.location = 4, .stream = kVolumeInstanceStream, .components = 4, .offset = 32},
    {.location = 5,
     .stream = kVolumeInstanceStream,
     .components = 4,
     .offset = offsetof(layout::VolumeInstance, light)},
};

}  // namespace

ShadowMeshPool::ShadowMeshPool() : vertices_("shadow volumes", kVolumeAttributes) {}

ShadowMeshPool::Entry& ShadowMeshPool::examine(const Assets& assets, MeshId mesh) {
    LIMN_CHECK(mesh.index < assets.meshes.size());
    entries_.resize(std::max(entries_.size(), assets.meshes.size()));
    Entry& entry = entries_[mesh.index];
    if (!entry.examined) {
        entry.examined = true;
        entry.report = make_shadow_mesh(assets.meshes[mesh.index]).report;
    }
    return entry;
}

const ManifoldReport& ShadowMeshPool::report(const Assets& assets, MeshId mesh) {
    return examine(assets, mesh).report;
}

const VolumeRange& ShadowMeshPool::edge_volume(const Assets& assets, MeshId mesh) {
    Entry& entry = examine(assets, mesh);
    LIMN_CHECK(is_closed(entry.report));
    if (!entry.by_edge) {
        entry.by_edge = upload(make_edge_volume(make_shadow_mesh(assets.meshes[mesh.index])));
    }
    return *entry.by_edge;
}

const VolumeRange& ShadowMeshPool::triangle_volume(const Assets& assets, MeshId mesh) {
    Entry& entry = examine(assets, mesh);
    if (!entry.by_triangle) {
        entry.by_triangle =
            upload(make_triangle_volume(make_shadow_mesh(assets.meshes[mesh.index])));
    }
    return *entry.by_triangle;
}

void ShadowMeshPool::reserve(std::size_t vertices, std::size_t indices) {
    if (vertices > vertex_capacity_) {
        const std::size_t capacity = std::max({vertices, 2 * vertex_capacity_, kInitialVertices});
        corners_ = gpu::grown_buffer(
            "volume corners", corners_, vertex_count_ * sizeof(VolumeVertex),
            capacity * sizeof(VolumeVertex));
        vertex_capacity_ = capacity;
        vertices_.set_vertices(kVolumeCornerStream, corners_, 0, sizeof(VolumeVertex));
    }
    if (indices > index_capacity_) {
        const std::size_t capacity = std::max({indices, 2 * index_capacity_, kInitialIndices});
        indices_ = gpu::grown_buffer("volume indices", indices_, index_count_ * 4, capacity * 4);
        index_capacity_ = capacity;
        vertices_.set_indices(indices_);
    }
}

VolumeRange ShadowMeshPool::upload(const VolumeGeometry& geometry) {
    reserve(vertex_count_ + geometry.vertices.size(), index_count_ + geometry.indices.size());
    const VolumeRange range = {
        static_cast<std::uint32_t>(index_count_),
        static_cast<std::uint32_t>(geometry.indices.size()), geometry.cap_indices,
        static_cast<std::int32_t>(vertex_count_)};
    if (!geometry.indices.empty()) {
        corners_.write(
            vertex_count_ * sizeof(VolumeVertex), std::span<const VolumeVertex>(geometry.vertices));
        indices_.write(index_count_ * 4, std::span<const std::uint32_t>(geometry.indices));
    }
    vertex_count_ += geometry.vertices.size();
    index_count_ += geometry.indices.size();
    return range;
}

void ShadowMeshPool::clear() {
    entries_.clear();
    vertex_count_ = 0;
    index_count_ = 0;
}

}  // namespace limn
