#pragma once

#include "ecs/components/surface.h"
#include "render/geometry/mesh_memory.h"
#include "render/geometry/slot_allocator.h"
#include "render/geometry/vertex_streams.h"
#include "render/gpu/buffer.h"

#include <span>
#include <vector>

namespace limn {

// All meshes in one set of vertex streams and one index buffer, so that a multi-draw covers any of
// them with indices of the same size. Indices take 16 bits up to 65,535 vertices, 32 beyond
// (engine.compact-data), in one buffer: offsets count indices of the mesh's own size. Full buffers
// are replaced by ones twice as large, copied on the GPU. A mesh that was edited or freed
// (MeshData::version) is uploaded anew; its old range is reused. Only new meshes get coarser
// triangles, and an order of triangles for the cache of vertices (triangle_order.h): a mesh that is
// edited once may be edited every frame.

/// Coarser triangles of a mesh, for its shadows.
struct CoarseRange {
    std::uint32_t first_index = 0;  ///< counted as that of the mesh
    std::uint32_t index_count = 0;
    float error = 0;  ///< CoarseTriangles::error [m]
};

/// The range of a mesh in the buffers.
struct MeshRange {
    std::uint32_t first_index = 0;  ///< counted in indices of 2 or 4 bytes, as `wide` says, from
                                    ///< the beginning of the buffer
    std::uint32_t index_count = 0;  ///< 0: nothing to draw
    bool wide = false;              ///< indices of 32 bits; otherwise of 16
    std::int32_t base_vertex = 0;
    std::uint32_t vertex_count = 0;
    std::uint32_t version = 0;        ///< of the MeshData
    std::vector<CoarseRange> coarse;  ///< from fine to coarse; their indices follow the mesh's own
    Bounds bounds;
    float mean_edge = 0;    ///< mean length of the edges of triangles [m]
    bool colored = false;   ///< has vertex colors
    bool tangents = false;  ///< has vertex tangents, as normal maps need
};

/// Meshes of up to so many vertices have 16-bit indices; 0xffff, which some APIs take for a
/// primitive restart, is none of them.
inline constexpr std::size_t kMaxShortVertices = 65535;

/// GL_UNSIGNED_INT or GL_UNSIGNED_SHORT, and bytes of an index.
[[nodiscard]] constexpr GLenum index_type(bool wide) {
    return wide ? GL_UNSIGNED_INT : GL_UNSIGNED_SHORT;
}
[[nodiscard]] constexpr std::size_t index_size(bool wide) {
    return wide ? 4 : 2;
}

class MeshPool {
  public:
    MeshPool();

    /// Uploads new meshes, and those whose version has changed. A mesh with an out-of-range index
    /// or without triangles is logged and draws nothing. `curved`: some material needs the
    /// curvatures of meshes.
    void update(std::span<const MeshData> meshes, bool curved = false);
    /// Removes all meshes; the buffers stay allocated.
    void clear();

    [[nodiscard]] const std::vector<MeshRange>& meshes() const { return meshes_; }
    /// Counts the changes of meshes().
    [[nodiscard]] std::uint64_t revision() const { return revision_; }
    [[nodiscard]] VertexStreams& streams() { return streams_; }
    [[nodiscard]] const VertexStreams& streams() const { return streams_; }
    [[nodiscard]] const gpu::Buffer& indices() const { return indices_; }
    [[nodiscard]] std::uint32_t used_vertices() const { return vertex_slots_.used(); }
    /// Bytes of all indices.
    [[nodiscard]] std::size_t index_bytes() const { return std::size_t{4} * index_slots_.used(); }

  private:
    void release(const MeshRange& range);
    /// `prepared`: null of a mesh that was edited.
    void upload(const MeshData& mesh, const PreparedMesh* prepared, MeshRange& range);
    void
    write_curvatures(const MeshData& mesh, const PreparedMesh* prepared, const MeshRange& range);

    std::vector<MeshRange> meshes_;
    MeshMemory memory_;
    std::uint64_t revision_ = 0;
    bool curved_ = false;  ///< the curvatures of all meshes are there
    VertexStreams streams_;
    gpu::Buffer indices_;
    SlotAllocator vertex_slots_;
    SlotAllocator index_slots_;  ///< in words of 32 bits
};

}  // namespace limn
