#pragma once

#include "render/gpu/buffer.h"
#include "render/gpu/vertex_array.h"
#include "render/skinning/slot_allocator.h"

#include <cstdint>

namespace limn {

class MeshPool;
struct MeshRange;

// Vertex storage of deformed meshes: each instance has its own copy, so that every pass draws it
// like any other mesh. The buffers have the MeshPool's format and are drawn with its indices;
// deform_pass writes positions, normals and tangents, the rest is copied from the mesh. A further
// stream holds the positions of the previous frame, created when velocity is first requested.
// Buffers grow and never shrink.

class DeformedVertices {
  public:
    DeformedVertices();

    /// Copies the mesh's `count` vertices in rest pose; returns the first.
    [[nodiscard]] std::uint32_t
    allocate(const MeshPool& meshes, const MeshRange& mesh, std::uint32_t count);
    void release(std::uint32_t first, std::uint32_t count) { slots_.release(first, count); }
    void clear() { slots_.clear(); }
    /// Creates the stream of previous positions, with undefined contents.
    void require_previous_positions();
    /// Binds the mesh pool's index buffer, which is replaced when it grows.
    void use_indices_of(const MeshPool& meshes);

    [[nodiscard]] const gpu::Buffer& positions() const { return positions_; }
    [[nodiscard]] const gpu::Buffer& attributes() const { return attributes_; }
    [[nodiscard]] const gpu::Buffer& before() const { return before_; }  ///< null until needed
    [[nodiscard]] gpu::VertexArray& vertices() { return vertices_; }
    [[nodiscard]] const SlotAllocator& slots() const { return slots_; }

  private:
    void grow(std::uint32_t needed);

    SlotAllocator slots_;
    gpu::Buffer positions_;
    gpu::Buffer attributes_;
    gpu::Buffer before_;
    gpu::VertexArray vertices_;
};

}  // namespace limn
