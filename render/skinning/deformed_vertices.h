#pragma once

#include "render/gpu/buffer.h"
#include "render/gpu/vertex_array.h"
#include "render/skinning/slot_allocator.h"

#include <cstdint>

namespace limn {

class MeshPool;
struct MeshRange;

// The vertices of meshes that change their shape: each instance has its own, so that every pass
// draws it as any other mesh. They lie beside the MeshPool in buffers of the same format and are
// drawn with its indices; deform_pass writes positions, normals and tangents, the rest is the
// mesh's. A further stream says where each vertex was the moment before; it is there once somebody
// asked for velocity. Buffers grow and never shrink.

class DeformedVertices {
  public:
    DeformedVertices();

    /// Place of a copy of the mesh's `count` vertices, as at rest.
    [[nodiscard]] std::uint32_t
    allocate(const MeshPool& meshes, const MeshRange& mesh, std::uint32_t count);
    void release(std::uint32_t first, std::uint32_t count) { slots_.release(first, count); }
    void clear() { slots_.clear(); }
    /// From now on there is a stream of positions before; its contents are undefined.
    void need_before();
    /// The mesh pool's indices, which move when it grows.
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
