#include "render/gpu/buffer.h"

#include "ecs/base/check.h"
#include "render/gpu/undefined_memory.h"

#include <utility>

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
    if (data == nullptr && fills_undefined_memory()) {
        constexpr std::uint32_t kNan = 0x7fc00001;  // as an integer far beyond any range
        clear(kNan, size / sizeof(kNan) * sizeof(kNan));
    }
}

void Buffer::write(std::size_t offset, std::span<const std::byte> bytes) {
    LIMN_CHECK(use_ == BufferUse::Dynamic);
    LIMN_CHECK(offset <= size() && bytes.size() <= size() - offset);
    if (!bytes.empty()) {
        // NVIDIA's driver (580) lets clears and copies on the GPU overtake a later
        // glNamedBufferSubData into the same range, and what was written is lost.
        if (std::exchange(filled_by_gpu_, false)) {
            glFinish();
        }
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);  // after what shaders wrote
        glNamedBufferSubData(
            id(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes.size()),
            bytes.data());
    }
}

void Buffer::clear(std::uint32_t word, std::size_t bytes) const {
    LIMN_CHECK(bytes <= size() && bytes % sizeof(word) == 0);
    glClearNamedBufferSubData(
        id(), GL_R32UI, 0, static_cast<GLsizeiptr>(bytes), GL_RED_INTEGER, GL_UNSIGNED_INT, &word);
    filled_by_gpu_ = true;
}

void Buffer::copy_from(
    const Buffer& source, std::size_t source_offset, std::size_t offset, std::size_t bytes) {
    LIMN_CHECK(source_offset <= source.size() && bytes <= source.size() - source_offset);
    LIMN_CHECK(offset <= size() && bytes <= size() - offset);
    if (bytes > 0) {
        glCopyNamedBufferSubData(
            source.id(), id(), static_cast<GLintptr>(source_offset), static_cast<GLintptr>(offset),
            static_cast<GLsizeiptr>(bytes));
        filled_by_gpu_ = true;
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
