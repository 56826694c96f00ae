#pragma once

#include "render/geometry/slot_allocator.h"
#include "render/geometry/vertex_streams.h"

#include <cstdint>
#include <vector>

namespace limn {

class FrameGraph;
class MeshPool;
struct BufferId;
struct MeshRange;

// Vertex storage of deformed meshes: each instance has its own copy, so that every pass draws it
// like any other mesh. The streams are those of the MeshPool and are drawn with its indices;
// deform_pass writes positions and frames, the rest is copied from the mesh. The stream of previous
// positions exists once velocity has been requested.

class DeformedVertices {
  public:
    DeformedVertices();

    /// Copies the mesh's vertices in rest pose; returns the first.
    [[nodiscard]] std::uint32_t allocate(const MeshPool& meshes, const MeshRange& mesh);
    void release(std::uint32_t first, std::uint32_t count) { slots_.release(first, count); }
    void clear() { slots_.clear(); }
    void require_previous_positions() { streams_.require(VertexStream::PreviousPosition); }
    void require_wrinkles() { streams_.require(VertexStream::Wrinkle); }
    void require_fold_heights() { streams_.require(VertexStream::FoldHeight); }
    /// Binds the mesh pool's index buffer, which is replaced when it grows.
    void use_indices_of(const MeshPool& meshes);

    [[nodiscard]] const gpu::Buffer& positions() const {
        return streams_.buffer(VertexStream::Position);
    }
    [[nodiscard]] const gpu::Buffer& frames() const { return streams_.buffer(VertexStream::Frame); }
    /// Null until needed.
    [[nodiscard]] const gpu::Buffer& previous_positions() const {
        return streams_.buffer(VertexStream::PreviousPosition);
    }
    /// Null until needed.
    [[nodiscard]] const gpu::Buffer& wrinkles() const {
        return streams_.buffer(VertexStream::Wrinkle);
    }
    /// Null until needed.
    [[nodiscard]] const gpu::Buffer& fold_heights() const {
        return streams_.buffer(VertexStream::FoldHeight);
    }
    [[nodiscard]] VertexStreams& streams() { return streams_; }
    [[nodiscard]] const SlotAllocator& slots() const { return slots_; }

  private:
    SlotAllocator slots_;
    VertexStreams streams_;
};

/// Imports the buffers that deform_pass and wrinkle_pass write into the graph.
[[nodiscard]] std::vector<BufferId>
import_deformed(FrameGraph& graph, const DeformedVertices& vertices);

}  // namespace limn
