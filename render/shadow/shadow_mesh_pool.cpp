#include "render/shadow/shadow_mesh_pool.h"

#include "ecs/base/check.h"
#include "render/gpu/grown_buffer.h"
#include "render/shaders/shadow_volume_gpu.h"

#include <algorithm>
#include <cstddef>

namespace limn {
namespace {

constexpr std::uint32_t kInitialShadowVertices = 1 << 14;
constexpr std::uint32_t kInitialShadowIndices = 1 << 16;

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
    {.location = 6,
     .stream = kVolumeInstanceStream,
     .components = 4,
     .offset = offsetof(layout::VolumeInstance, relief)},
};

}  // namespace

ShadowMeshPool::ShadowMeshPool() : vertices_("shadow volumes", kVolumeAttributes) {}

ShadowMeshPool::Entry& ShadowMeshPool::examine(const Assets& assets, MeshId mesh) {
    LIMN_CHECK(mesh.index < assets.meshes.size());
    entries_.resize(std::max(entries_.size(), assets.meshes.size()));
    Entry& entry = entries_[mesh.index];
    const std::uint32_t version = assets.meshes[mesh.index].version;
    if (!entry.examined || entry.version != version) {
        release(entry.by_edge);
        release(entry.by_triangle);
        entry = {};
        entry.examined = true;
        entry.version = version;
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

VolumeRange ShadowMeshPool::upload(const VolumeGeometry& geometry) {
    VolumeRange range;
    if (geometry.indices.empty()) {
        return range;
    }
    range.index_count = static_cast<std::uint32_t>(geometry.indices.size());
    range.cap_indices = geometry.cap_indices;
    range.vertex_count = static_cast<std::uint32_t>(geometry.vertices.size());
    const std::size_t old_vertices = vertex_slots_.capacity();
    const std::uint32_t first =
        vertex_slots_.allocate_or_grow(range.vertex_count, kInitialShadowVertices);
    if (vertex_slots_.capacity() > old_vertices) {
        corners_ = gpu::grown_buffer(
            "volume corners", corners_, old_vertices * sizeof(VolumeVertex),
            vertex_slots_.capacity() * sizeof(VolumeVertex));
        vertices_.set_vertices(kVolumeCornerStream, corners_, 0, sizeof(VolumeVertex));
    }
    const std::size_t old_indices = index_slots_.capacity();
    range.first_index = index_slots_.allocate_or_grow(range.index_count, kInitialShadowIndices);
    if (index_slots_.capacity() > old_indices) {
        indices_ = gpu::grown_buffer(
            "volume indices", indices_, 4 * old_indices, std::size_t{4} * index_slots_.capacity());
        vertices_.set_indices(indices_);
    }
    range.base_vertex = static_cast<std::int32_t>(first);
    corners_.write(first * sizeof(VolumeVertex), std::span<const VolumeVertex>(geometry.vertices));
    indices_.write(
        std::size_t{4} * range.first_index, std::span<const std::uint32_t>(geometry.indices));
    return range;
}

void ShadowMeshPool::release(const std::optional<VolumeRange>& range) {
    if (range && range->index_count > 0) {
        vertex_slots_.release(static_cast<std::uint32_t>(range->base_vertex), range->vertex_count);
        index_slots_.release(range->first_index, range->index_count);
    }
}

void ShadowMeshPool::clear() {
    entries_.clear();
    vertex_slots_.clear();
    index_slots_.clear();
}

}  // namespace limn
