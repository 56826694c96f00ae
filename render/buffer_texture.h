#pragma once

#include "render/gpu/gl_object.h"
#include "render/gpu/ring_buffer.h"

namespace limn {

namespace gpu {
class Device;
}

/// Part of a buffer as a texture of texels (samplerBuffer): the quickest way to read records on a
/// software OpenGL, where a fetch of 16 bytes costs a fifth of four loads from a storage block.
class BufferTexture {
  public:
    /// `format`: of a texel, e.g. GL_RGBA32F.
    BufferTexture(std::string_view label, GLenum format);

    /// What it shows from now on; the slice must be aligned to alignment().
    void set(const gpu::RingSlice& slice);
    void set(const gpu::Buffer& buffer);
    void bind(gpu::Device& device, unsigned unit) const;

    /// Of slices [bytes].
    [[nodiscard]] static std::size_t alignment();

  private:
    gpu::GlObject<gpu::ObjectKind::Texture> object_;
    GLenum format_;
};

}  // namespace limn
