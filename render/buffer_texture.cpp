#include "render/buffer_texture.h"

#include "render/gpu/device.h"

#include <algorithm>
#include <cstring>

namespace limn {
namespace {

GLuint create_name() {
    GLuint id = 0;
    glCreateTextures(GL_TEXTURE_BUFFER, 1, &id);
    return id;
}

}  // namespace

BufferTexture::BufferTexture(std::string_view label, GLenum format)
    : object_(create_name(), label), format_(format) {}

void BufferTexture::set(const gpu::RingSlice& slice) {
    // A list may be empty; a buffer texture must not be.
    const std::size_t size = slice.size > 0 ? slice.size : 16;
    glTextureBufferRange(
        object_.id(), format_, slice.buffer, static_cast<GLintptr>(slice.offset),
        static_cast<GLsizeiptr>(size));
}

void BufferTexture::set(const gpu::Buffer& buffer) {
    glTextureBuffer(object_.id(), format_, buffer.id());
}

void BufferTexture::upload_bytes(gpu::RingBuffer& ring, std::span<const std::byte> bytes) {
    constexpr std::size_t kTexel = 16;  // a list may be empty; the range of a buffer may not
    const gpu::RingSlice slice = ring.allocate(std::max(bytes.size(), kTexel), alignment());
    std::memset(slice.data, 0, kTexel);
    if (!bytes.empty()) {
        std::memcpy(slice.data, bytes.data(), bytes.size());
    }
    set(slice);
}

void BufferTexture::bind(gpu::Device& device, unsigned unit) const {
    device.bind_texture_name(unit, object_.id());
}

std::size_t BufferTexture::alignment() {
    GLint value = 0;
    glGetIntegerv(GL_TEXTURE_BUFFER_OFFSET_ALIGNMENT, &value);
    return static_cast<std::size_t>(value);
}

}  // namespace limn
