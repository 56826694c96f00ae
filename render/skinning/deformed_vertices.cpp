#include "render/skinning/deformed_vertices.h"

#include "render/geometry/mesh_pool.h"
#include "render/graph/frame_graph.h"

#include <algorithm>

namespace limn {
namespace {

constexpr std::uint32_t kInitialDeformedVertices = 1 << 12;

}  // namespace

DeformedVertices::DeformedVertices() : streams_("deformed meshes") {
    slots_.grow(kInitialDeformedVertices);
    streams_.reserve(kInitialDeformedVertices);
}

std::uint32_t DeformedVertices::allocate(const MeshPool& meshes, const MeshRange& mesh) {
    const std::uint32_t first =
        slots_.allocate_or_grow(mesh.vertex_count, kInitialDeformedVertices);
    streams_.reserve(slots_.capacity());
    streams_.copy(
        meshes.streams(), static_cast<std::uint32_t>(mesh.base_vertex), first, mesh.vertex_count);
    return first;
}

void DeformedVertices::use_indices_of(const MeshPool& meshes) {
    streams_.vertices().set_indices(meshes.indices());
}

std::vector<BufferId> import_deformed(FrameGraph& graph, const DeformedVertices& vertices) {
    std::vector<BufferId> buffers = {
        graph.import("deformed positions", vertices.positions()),
        graph.import("deformed frames", vertices.frames())};
    if (vertices.previous_positions()) {
        buffers.push_back(
            graph.import("previous deformed positions", vertices.previous_positions()));
    }
    if (vertices.wrinkles()) {
        buffers.push_back(graph.import("wrinkle strengths", vertices.wrinkles()));
    }
    if (vertices.fold_heights()) {
        buffers.push_back(graph.import("fold heights", vertices.fold_heights()));
    }
    return buffers;
}

}  // namespace limn
