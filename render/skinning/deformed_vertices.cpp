#include "render/skinning/deformed_vertices.h"

#include "render/gpu/grown_buffer.h"
#include "render/mesh_pool.h"

#include <algorithm>

namespace limn {
namespace {

constexpr std::uint32_t kInitialVertices = 1 << 12;

void copy_vertices(
    const gpu::Buffer& from, const gpu::Buffer& to, std::uint32_t from_first,
    std::uint32_t to_first, std::uint32_t count, std::size_t stride) {
    glCopyNamedBufferSubData(
        from.id(), to.id(), static_cast<GLintptr>(from_first * stride),
        static_cast<GLintptr>(to_first * stride), static_cast<GLsizeiptr>(count * stride));
}

}  // namespace

DeformedVertices::DeformedVertices() : vertices_("deformed meshes", mesh_attributes()) {
    grow(kInitialVertices);
}

std::uint32_t
DeformedVertices::allocate(const MeshPool& meshes, const MeshRange& mesh, std::uint32_t count) {
    std::optional<std::uint32_t> first = slots_.allocate(count);
    if (!first) {
        grow(slots_.capacity() + count);
        first = slots_.allocate(count);
    }
    const auto base = static_cast<std::uint32_t>(mesh.base_vertex);
    copy_vertices(meshes.positions(), positions_, base, *first, count, sizeof(Vec3));
    copy_vertices(meshes.attributes(), attributes_, base, *first, count, sizeof(PackedVertex));
    return *first;
}

void DeformedVertices::grow(std::uint32_t needed) {
    const std::uint32_t kept = slots_.capacity();
    const std::uint32_t capacity = std::max(needed, 2 * kept);
    const auto grow_stream = [&](gpu::Buffer& buffer, const char* label, std::size_t stride) {
        buffer = gpu::grown_buffer(label, buffer, kept * stride, capacity * stride);
    };
    grow_stream(positions_, "deformed positions", sizeof(Vec3));
    grow_stream(attributes_, "deformed attributes", sizeof(PackedVertex));
    if (before_) {
        grow_stream(before_, "previous deformed positions", sizeof(Vec3));
    }
    slots_.grow(capacity);
    vertices_.set_vertices(kPositionStream, positions_, 0, sizeof(Vec3));
    vertices_.set_vertices(kAttributeStream, attributes_, 0, sizeof(PackedVertex));
    vertices_.set_vertices(
        kPreviousPositionStream, before_ ? before_ : positions_, 0, sizeof(Vec3));
}

void DeformedVertices::require_previous_positions() {
    if (!before_) {
        before_ = gpu::Buffer(
            "previous deformed positions", slots_.capacity() * sizeof(Vec3),
            gpu::BufferUse::GpuOnly);
        vertices_.set_vertices(kPreviousPositionStream, before_, 0, sizeof(Vec3));
    }
}

void DeformedVertices::use_indices_of(const MeshPool& meshes) {
    vertices_.set_indices(meshes.indices());
}

}  // namespace limn
