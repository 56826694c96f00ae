#pragma once

#include "ecs/components/surface.h"
#include "render/geometry/coarse_triangles.h"
#include "render/geometry/slot_allocator.h"
#include "render/geometry/vertex_streams.h"
#include "render/gpu/buffer.h"

#include <span>
#include <vector>

namespace limn {

// All meshes in one set of vertex streams and one index buffer, so that a multi-draw covers any of
// them without a state change. Full buffers are replaced by ones twice as large, copied on the GPU.
// A mesh that was edited or freed (MeshData::version) is uploaded anew; its old range is reused.
// Only new meshes get coarser triangles: a mesh that is edited once may be edited every frame.

/// Coarser triangles of a mesh, for its shadows.
struct CoarseRange {
    std::uint32_t first_index = 0;
    std::uint32_t index_count = 0;
    float error = 0;  ///< CoarseTriangles::error [m]
};

/// The range of a mesh in the buffers.
struct MeshRange {
    std::uint32_t first_index = 0;
    std::uint32_t index_count = 0;  ///< 0: nothing to draw
    std::int32_t base_vertex = 0;
    std::uint32_t vertex_count = 0;
    std::uint32_t version = 0;        ///< of the MeshData
    std::vector<CoarseRange> coarse;  ///< from fine to coarse; their indices follow the mesh's own
    Bounds bounds;
    float mean_edge = 0;    ///< mean length of the edges of triangles [m]
    bool colored = false;   ///< has vertex colors
    bool tangents = false;  ///< has vertex tangents, as normal maps need
};

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
    [[nodiscard]] std::uint32_t used_indices() const { return index_slots_.used(); }

  private:
    void release(const MeshRange& range);
    void upload(const MeshData& mesh, std::span<const CoarseTriangles> coarse, MeshRange& range);

    std::vector<MeshRange> meshes_;
    CoarseMemory coarse_memory_;
    std::uint64_t revision_ = 0;
    VertexStreams streams_;
    gpu::Buffer indices_;
    SlotAllocator vertex_slots_;
    SlotAllocator index_slots_;
};

}  // namespace limn
