#include "render/gpu/buffer_texture.h"

#include "ecs/base/log.h"
#include "render/gpu/device.h"
#include "render/gpu/texture.h"

#include <array>
#include <cstring>

namespace limn {
namespace {

GLuint create_name() {
    GLuint id = 0;
    glCreateTextures(GL_TEXTURE_BUFFER, 1, &id);
    return id;
}

}  // namespace

BufferTexture::BufferTexture(std::string_view label, GLenum format, std::size_t max_texels)
    : object_(create_name(), label), label_(label), format_(format),
      max_bytes_(max_texels * static_cast<std::size_t>(gpu::format_info(format).bytes)) {}

void BufferTexture::set(const gpu::RingSlice& slice) {
    if (slice.size > 0) {
        set_range(slice.buffer, slice.offset, slice.size);
        return;
    }
    // A list may be empty; a buffer texture must not be.
    if (!zeros_) {
        constexpr std::array<std::byte, kEmptyBytes> kZeros = {};
        zeros_ = gpu::Buffer::of(label_, std::span<const std::byte>(kZeros));
    }
    set_range(zeros_.id(), 0, kEmptyBytes);
}

void BufferTexture::set(const gpu::Buffer& buffer) {
    set_range(buffer.id(), 0, buffer.size());
}

void BufferTexture::set_range(GLuint buffer, std::size_t offset, std::size_t bytes) {
    if (bytes > max_bytes_) {
        if (!reported_) {
            log_error(
                "{}: {} bytes found, expected at most {}, the limit of this OpenGL's buffer "
                "textures; the rest is left out",
                label_, bytes, max_bytes_);
            reported_ = true;
        }
        bytes = max_bytes_;
    }
    glTextureBufferRange(
        object_.id(), format_, buffer, static_cast<GLintptr>(offset),
        static_cast<GLsizeiptr>(bytes));
}

void BufferTexture::upload_bytes(gpu::RingBuffer& ring, std::span<const std::byte> bytes) {
    if (bytes.empty()) {
        set(gpu::RingSlice{});
        return;
    }
    const gpu::RingSlice slice = ring.allocate(bytes.size(), alignment());
    std::memcpy(slice.data, bytes.data(), bytes.size());
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

std::size_t BufferTexture::max_texel_count() {
    GLint value = 0;
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &value);
    return static_cast<std::size_t>(value);
}

}  // namespace limn
