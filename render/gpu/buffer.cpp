#include "render/gpu/buffer.h"

#include "ecs/base/check.h"

namespace limn::gpu {
namespace {

GLuint create_buffer_name() {
    GLuint id = 0;
    glCreateBuffers(1, &id);
    return id;
}

}  // namespace

Buffer::Buffer(std::string_view label, std::size_t size, BufferUse use, const void* data)
    : object_(create_buffer_name(), label), size_(size), use_(use) {
    LIMN_CHECK(size > 0);
    const GLbitfield flags = use == BufferUse::Dynamic ? GL_DYNAMIC_STORAGE_BIT : 0;
    glNamedBufferStorage(id(), static_cast<GLsizeiptr>(size), data, flags);
    object_.set_bytes(size);
}

void Buffer::write(std::size_t offset, std::span<const std::byte> bytes) {
    LIMN_CHECK(use_ == BufferUse::Dynamic);
    LIMN_CHECK(offset <= size() && bytes.size() <= size() - offset);
    if (!bytes.empty()) {
        glNamedBufferSubData(
            id(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes.size()),
            bytes.data());
    }
}

void Buffer::read(std::size_t offset, std::span<std::byte> bytes) const {
    LIMN_CHECK(offset <= size() && bytes.size() <= size() - offset);
    if (!bytes.empty()) {
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        glGetNamedBufferSubData(
            id(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes.size()),
            bytes.data());
    }
}

}  // namespace limn::gpu
