#include "render/buffer_texture.h"

#include "render/gpu/device.h"

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
    // A list may be empty; a view of a buffer may not.
    const std::size_t size = slice.size > 0 ? slice.size : 16;
    glTextureBufferRange(
        object_.id(), format_, slice.buffer, static_cast<GLintptr>(slice.offset),
        static_cast<GLsizeiptr>(size));
}

void BufferTexture::set(const gpu::Buffer& buffer) {
    glTextureBuffer(object_.id(), format_, buffer.id());
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
