#include "render/gpu/gl_object.h"

#include "ecs/base/check.h"

#include <algorithm>
#include <array>
#include <atomic>

namespace limn::gpu {
namespace {

std::array<std::atomic<std::int64_t>, static_cast<std::size_t>(ObjectKind::Count)> live_counts;
std::atomic<std::int64_t> memory_bytes;
std::atomic<std::uint64_t> deaths;
std::atomic<std::uint64_t> serials;

GLenum label_namespace(ObjectKind kind) {
    switch (kind) {
    case ObjectKind::Buffer:
        return GL_BUFFER;
    case ObjectKind::Texture:
        return GL_TEXTURE;
    case ObjectKind::Framebuffer:
        return GL_FRAMEBUFFER;
    case ObjectKind::Sampler:
        return GL_SAMPLER;
    case ObjectKind::VertexArray:
        return GL_VERTEX_ARRAY;
    case ObjectKind::Query:
        return GL_QUERY;
    case ObjectKind::Program:
        return GL_PROGRAM;
    case ObjectKind::Count:
        break;
    }
    return GL_NONE;
}

}  // namespace

std::int64_t live_objects(ObjectKind kind) {
    return live_counts[static_cast<std::size_t>(kind)].load();
}

std::int64_t gpu_memory_bytes() {
    return memory_bytes.load();
}

std::uint64_t deletion_count() {
    return deaths.load(std::memory_order_relaxed);
}

namespace detail {

void created_object(ObjectKind kind, GLuint id, std::string_view label) {
    LIMN_CHECK(id != 0);
    live_counts[static_cast<std::size_t>(kind)].fetch_add(1);
    if (!label.empty()) {
        constexpr std::size_t kMinimumMaxLabel = 255;  // GL_MAX_LABEL_LENGTH is at least 256
        const std::size_t length = std::min(label.size(), kMinimumMaxLabel);
        glObjectLabel(label_namespace(kind), id, static_cast<GLsizei>(length), label.data());
    }
}

void delete_object(ObjectKind kind, GLuint id) {
    live_counts[static_cast<std::size_t>(kind)].fetch_sub(1);
    deaths.fetch_add(1, std::memory_order_relaxed);
    switch (kind) {
    case ObjectKind::Buffer:
        glDeleteBuffers(1, &id);
        break;
    case ObjectKind::Texture:
        glDeleteTextures(1, &id);
        break;
    case ObjectKind::Framebuffer:
        glDeleteFramebuffers(1, &id);
        break;
    case ObjectKind::Sampler:
        glDeleteSamplers(1, &id);
        break;
    case ObjectKind::VertexArray:
        glDeleteVertexArrays(1, &id);
        break;
    case ObjectKind::Query:
        glDeleteQueries(1, &id);
        break;
    case ObjectKind::Program:
        glDeleteProgram(id);
        break;
    case ObjectKind::Count:
        break;
    }
}

void add_memory(std::int64_t bytes) {
    memory_bytes.fetch_add(bytes, std::memory_order_relaxed);
}

std::uint64_t next_serial() {
    return 1 + serials.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace detail
}  // namespace limn::gpu
