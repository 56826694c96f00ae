#pragma once

#include "render/gpu/gl_object.h"
#include "render/gpu/ring_buffer.h"

#include <cstddef>
#include <span>
#include <string>

namespace limn {

namespace gpu {
class Device;
}

/// A range of a buffer as a buffer texture (samplerBuffer): the fastest way to read records on a
/// software OpenGL, where a 16-byte fetch costs a fifth of four loads from a storage block.
class BufferTexture {
  public:
    /// `format`: texel format, e.g. GL_RGBA32F. Texels beyond `max_texels` are cut off.
    BufferTexture(
        std::string_view label, GLenum format, std::size_t max_texels = max_texel_count());

    /// Sets the range to read; a slice must be aligned to alignment(). An empty range reads as
    /// kEmptyBytes of zeros, so that a shader may fetch the first record before it tests the count;
    /// fetches past the end are undefined. Logs once if the range exceeds the device's limit.
    void set(const gpu::RingSlice& slice);
    void set(const gpu::Buffer& buffer);
    /// Copies `items` into the ring of this frame and sets that range.
    template <typename Items>
    void upload(gpu::RingBuffer& ring, const Items& items) {
        upload_bytes(ring, std::as_bytes(std::span(items)));
    }
    void bind(gpu::Device& device, unsigned unit) const;

    static constexpr std::size_t kEmptyBytes = 256;

    /// Required alignment of slices [bytes].
    [[nodiscard]] static std::size_t alignment();
    /// The device's limit for buffer textures: at least 65536.
    [[nodiscard]] static std::size_t max_texel_count();

  private:
    void upload_bytes(gpu::RingBuffer& ring, std::span<const std::byte> bytes);
    void set_range(GLuint buffer, std::size_t offset, std::size_t bytes);

    gpu::GlObject<gpu::ObjectKind::Texture> object_;
    gpu::Buffer zeros_;  // created for the first empty range
    std::string label_;
    GLenum format_;
    std::size_t max_bytes_;
    bool reported_ = false;
};

}  // namespace limn
