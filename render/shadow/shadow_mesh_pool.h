#pragma once

#include "ecs/components/surface.h"
#include "render/geometry/slot_allocator.h"
#include "render/gpu/buffer.h"
#include "render/gpu/vertex_array.h"
#include "render/shadow/shadow_mesh.h"

#include <optional>
#include <vector>

namespace limn {

// GPU meshes of shadow volumes: checked and uploaded on first use by a light, all in one pair of
// buffers. A per-edge mesh takes 144 bytes per triangle, a per-triangle one 288.

/// Range of a volume in the buffers: caps first, then sides.
struct VolumeRange {
    std::uint32_t first_index = 0;
    std::uint32_t index_count = 0;
    std::uint32_t cap_indices = 0;
    std::int32_t base_vertex = 0;
    std::uint32_t vertex_count = 0;
};

class ShadowMeshPool {
  public:
    ShadowMeshPool();

    /// Whether the mesh is closed, and if not, why.
    [[nodiscard]] const ManifoldReport& report(const Assets& assets, MeshId mesh);
    /// The mesh must be closed.
    [[nodiscard]] const VolumeRange& edge_volume(const Assets& assets, MeshId mesh);
    [[nodiscard]] const VolumeRange& triangle_volume(const Assets& assets, MeshId mesh);
    /// Removes all meshes; the buffers stay allocated.
    void clear();

    [[nodiscard]] gpu::VertexArray& vertices() { return vertices_; }

  private:
    struct Entry {
        bool examined = false;
        std::uint32_t version = 0;  ///< of the MeshData
        ManifoldReport report;
        std::optional<VolumeRange> by_edge;
        std::optional<VolumeRange> by_triangle;
    };
    Entry& examine(const Assets& assets, MeshId mesh);
    VolumeRange upload(const VolumeGeometry& geometry);
    void release(const std::optional<VolumeRange>& range);

    std::vector<Entry> entries_;  ///< by mesh
    gpu::Buffer corners_;
    gpu::Buffer indices_;
    gpu::VertexArray vertices_;
    SlotAllocator vertex_slots_;
    SlotAllocator index_slots_;
};

/// Vertex buffer bindings of shadow_volume.vert.
inline constexpr unsigned kVolumeCornerStream = 0;
inline constexpr unsigned kVolumeInstanceStream = 1;

}  // namespace limn
