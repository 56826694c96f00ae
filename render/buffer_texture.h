#pragma once

#include "render/gpu/gl_object.h"
#include "render/gpu/ring_buffer.h"

#include <cstddef>
#include <span>

namespace limn {

namespace gpu {
class Device;
}

/// A range of a buffer as a buffer texture (samplerBuffer): the fastest way to read records on a
/// software OpenGL, where a 16-byte fetch costs a fifth of four loads from a storage block.
class BufferTexture {
  public:
    /// `format`: texel format, e.g. GL_RGBA32F.
    BufferTexture(std::string_view label, GLenum format);

    /// Sets the range to read; a slice must be aligned to alignment().
    void set(const gpu::RingSlice& slice);
    void set(const gpu::Buffer& buffer);
    /// Copies `items` into the ring of this frame and sets that range.
    template <typename Items>
    void upload(gpu::RingBuffer& ring, const Items& items) {
        upload_bytes(ring, std::as_bytes(std::span(items)));
    }
    void bind(gpu::Device& device, unsigned unit) const;

    /// Required alignment of slices [bytes].
    [[nodiscard]] static std::size_t alignment();

  private:
    void upload_bytes(gpu::RingBuffer& ring, std::span<const std::byte> bytes);

    gpu::GlObject<gpu::ObjectKind::Texture> object_;
    GLenum format_;
};

}  // namespace limn
