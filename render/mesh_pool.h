#pragma once

#include "ecs/components/surface.h"
#include "render/gpu/buffer.h"
#include "render/gpu/vertex_array.h"

#include <span>
#include <vector>

namespace limn {

// All meshes in one pair of vertex buffers and one index buffer, so that a multi-draw covers any of
// them without a state change. Meshes are appended; full buffers are replaced by ones twice as
// large, copied on the GPU.
//
// Positions have a buffer of their own: depth-only passes read a quarter as much.

/// The range of a mesh in the buffers.
struct MeshRange {
    std::uint32_t first_index = 0;
    std::uint32_t index_count = 0;  ///< 0: nothing to draw
    std::int32_t base_vertex = 0;
    Bounds bounds;
    bool colored = false;   ///< has vertex colors
    bool tangents = false;  ///< has vertex tangents, as normal maps need
};

/// Vertex attributes other than position; normals and tangents as 16-bit snorm, -32767 .. 32767 for
/// -1 .. 1, colors as half floats.
struct PackedVertex {
    std::int16_t normal[4];
    std::int16_t tangent[4];  ///< w: sign of the bitangent
    Vec2 uv;
    Vec2 uv1;
    std::uint16_t color[4];
};
static_assert(sizeof(PackedVertex) == 40);

class MeshPool {
  public:
    MeshPool();

    /// Uploads the meshes beyond those it has; a mesh with an out-of-range index or without
    /// triangles is logged and draws nothing.
    void append(std::span<const MeshData> meshes);
    /// Removes all meshes; the buffers stay allocated.
    void clear();

    [[nodiscard]] const std::vector<MeshRange>& meshes() const { return meshes_; }
    /// Counts the changes of meshes().
    [[nodiscard]] std::uint64_t revision() const { return revision_; }
    /// Attributes 0 .. 4 of mesh.vert; the caller binds the instance streams.
    [[nodiscard]] gpu::VertexArray& vertices() { return vertices_; }
    [[nodiscard]] const gpu::Buffer& positions() const { return positions_; }
    [[nodiscard]] const gpu::Buffer& attributes() const { return attributes_; }  ///< PackedVertex
    [[nodiscard]] const gpu::Buffer& indices() const { return indices_; }

  private:
    void reserve(std::size_t vertices, std::size_t indices);

    std::vector<MeshRange> meshes_;
    std::uint64_t revision_ = 0;
    gpu::Buffer positions_;
    gpu::Buffer attributes_;
    gpu::Buffer indices_;
    gpu::VertexArray vertices_;
    std::size_t vertex_count_ = 0;
    std::size_t vertex_capacity_ = 0;
    std::size_t index_count_ = 0;
    std::size_t index_capacity_ = 0;
};

/// Vertex layout of mesh.vert.
[[nodiscard]] std::span<const gpu::VertexAttribute> mesh_attributes();

/// Vertex buffer bindings of mesh.vert.
inline constexpr unsigned kPositionStream = 0;
inline constexpr unsigned kAttributeStream = 1;
inline constexpr unsigned kInstanceStream = 2;
inline constexpr unsigned kPreviousTransformStream = 3;
inline constexpr unsigned kPreviousPositionStream = 4;  ///< deformed meshes only

}  // namespace limn
