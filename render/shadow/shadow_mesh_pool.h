#pragma once

#include "ecs/components/surface.h"
#include "render/gpu/buffer.h"
#include "render/gpu/vertex_array.h"
#include "render/shadow/shadow_mesh.h"

#include <optional>
#include <vector>

namespace limn {

// The meshes that cast shadow volumes, on the GPU: examined and uploaded when the first light asks
// for them, all in one pair of buffers. A mesh per edge takes 144 bytes a triangle, per triangle
// 288.

/// Where a volume lies: caps first, then sides.
struct VolumeRange {
    std::uint32_t first_index = 0;
    std::uint32_t index_count = 0;
    std::uint32_t cap_indices = 0;
    std::int32_t base_vertex = 0;
};

class ShadowMeshPool {
  public:
    ShadowMeshPool();

    /// What keeps the mesh from being closed.
    [[nodiscard]] const ManifoldReport& report(const Assets& assets, MeshId mesh);
    /// The mesh must be closed.
    [[nodiscard]] const VolumeRange& edge_volume(const Assets& assets, MeshId mesh);
    [[nodiscard]] const VolumeRange& triangle_volume(const Assets& assets, MeshId mesh);
    /// Forgets all meshes; the buffers stay.
    void clear();

    [[nodiscard]] gpu::VertexArray& vertices() { return vertices_; }

  private:
    struct Entry {
        bool examined = false;
        ManifoldReport report;
        std::optional<VolumeRange> by_edge;
        std::optional<VolumeRange> by_triangle;
    };
    Entry& examine(const Assets& assets, MeshId mesh);
    VolumeRange upload(const VolumeGeometry& geometry);
    void reserve(std::size_t vertices, std::size_t indices);

    std::vector<Entry> entries_;  ///< by mesh
    gpu::Buffer corners_;
    gpu::Buffer indices_;
    gpu::VertexArray vertices_;
    std::size_t vertex_count_ = 0;
    std::size_t vertex_capacity_ = 0;
    std::size_t index_count_ = 0;
    std::size_t index_capacity_ = 0;
};

/// Streams of shadow_volume.vert.
inline constexpr unsigned kVolumeCornerStream = 0;
inline constexpr unsigned kVolumeInstanceStream = 1;

}  // namespace limn
