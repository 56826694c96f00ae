#include "render/mesh_pool.h"

#include "ecs/base/log.h"
#include "render/gpu/grown_buffer.h"
#include "render/shaders/instance_gpu.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace limn {
namespace {

constexpr std::size_t kInitialVertices = 1 << 16;
constexpr std::size_t kInitialIndices = 1 << 18;

constexpr gpu::VertexAttribute kMeshAttributes[] = {
    {.location = 0, .stream = kPositionStream, .components = 3},
    {.location = 1,
     .stream = kAttributeStream,
     .components = 3,
     .type = GL_SHORT,
     .offset = offsetof(PackedVertex, normal),
     .normalized = true},
    {.location = 2,
     .stream = kAttributeStream,
     .components = 4,
     .type = GL_SHORT,
     .offset = offsetof(PackedVertex, tangent),
     .normalized = true},
    {.location = 3,
     .stream = kAttributeStream,
     .components = 4,
     .offset = offsetof(PackedVertex, uv)},
    {.location = 4,
     .stream = kAttributeStream,
     .components = 4,
     .type = GL_HALF_FLOAT,
     .offset = offsetof(PackedVertex, color)},
    {.location = 5, .stream = kInstanceStream, .components = 4, .offset = 0},
    {.location = 6, .stream = kInstanceStream, .components = 4, .offset = 16},
    {.location = 7, .stream = kInstanceStream, .components = 4, .offset = 32},
    {.location = 8,
     .stream = kInstanceStream,
     .components = 4,
     .type = GL_UNSIGNED_INT,
     .offset = offsetof(layout::InstanceRecord, material),
     .integer = true},
    {.location = 9, .stream = kPreviousTransformStream, .components = 4, .offset = 0},
    {.location = 10, .stream = kPreviousTransformStream, .components = 4, .offset = 16},
    {.location = 11, .stream = kPreviousTransformStream, .components = 4, .offset = 32},
    {.location = 12, .stream = kPreviousPositionStream, .components = 3},
};

std::int16_t to_snorm(float x) {
    return static_cast<std::int16_t>(std::lround(std::clamp(x, -1.0f, 1.0f) * 32767.0f));
}
std::uint16_t to_half(float x) {
    constexpr float kMaxHalf = 65504;
    return glm::packHalf1x16(std::isnan(x) ? 0.0f : std::clamp(x, -kMaxHalf, kMaxHalf));
}

PackedVertex pack_vertex(const MeshData& mesh, std::size_t i) {
    const auto at = [i](const auto& values, const auto& fallback) {
        return i < values.size() ? values[i] : fallback;
    };
    const Vec3 n = normalize_or(at(mesh.normals, Vec3(0, 0, 1)), {0, 0, 1});
    const Vec4 t = at(mesh.tangents, Vec4(any_perpendicular(n), 1));
    const Vec3 t3 = normalize_or(Vec3(t), any_perpendicular(n));
    const Vec4 c = at(mesh.colors, Vec4(1));
    const Vec2 uv = at(mesh.uvs, Vec2(0));
    return {
        {to_snorm(n.x), to_snorm(n.y), to_snorm(n.z), 0},
        {to_snorm(t3.x), to_snorm(t3.y), to_snorm(t3.z), to_snorm(t.w < 0 ? -1.0f : 1.0f)},
        uv,
        at(mesh.uvs1, uv),
        {to_half(c.x), to_half(c.y), to_half(c.z), to_half(c.w)}};
}

bool drawable(const MeshData& mesh) {
    const auto past = [&](std::uint32_t index) { return index >= mesh.positions.size(); };
    if (mesh.positions.empty() || mesh.indices.size() < 3) {
        return false;
    }
    if (std::any_of(mesh.indices.begin(), mesh.indices.end(), past)) {
        log_error(
            "mesh {}: an index exceeds the {} vertices; it is not drawn", mesh.name,
            mesh.positions.size());
        return false;
    }
    return true;
}

}  // namespace

std::span<const gpu::VertexAttribute> mesh_attributes() {
    return kMeshAttributes;
}

MeshPool::MeshPool() : vertices_("meshes", kMeshAttributes) {
    reserve(kInitialVertices, kInitialIndices);
}

void MeshPool::reserve(std::size_t vertices, std::size_t indices) {
    if (vertices > vertex_capacity_) {
        const std::size_t capacity = std::max(vertices, 2 * vertex_capacity_);
        positions_ = gpu::grown_buffer(
            "mesh positions", positions_, vertex_count_ * sizeof(Vec3), capacity * sizeof(Vec3));
        attributes_ = gpu::grown_buffer(
            "mesh attributes", attributes_, vertex_count_ * sizeof(PackedVertex),
            capacity * sizeof(PackedVertex));
        vertex_capacity_ = capacity;
        vertices_.set_vertices(kPositionStream, positions_, 0, sizeof(Vec3));
        vertices_.set_vertices(kAttributeStream, attributes_, 0, sizeof(PackedVertex));
        // Not read for undeformed meshes, but something must be bound.
        vertices_.set_vertices(kPreviousPositionStream, positions_, 0, sizeof(Vec3));
    }
    if (indices > index_capacity_) {
        const std::size_t capacity = std::max(indices, 2 * index_capacity_);
        indices_ = gpu::grown_buffer("mesh indices", indices_, index_count_ * 4, capacity * 4);
        index_capacity_ = capacity;
        vertices_.set_indices(indices_);
    }
}

void MeshPool::append(std::span<const MeshData> meshes) {
    revision_ += meshes.empty() ? 0 : 1;
    std::vector<PackedVertex> packed;
    for (const MeshData& mesh : meshes) {
        MeshRange range;
        range.bounds = mesh.bounds;
        if (drawable(mesh)) {
            if (is_empty(range.bounds)) {
                for (const Vec3& p : mesh.positions) {
                    grow(range.bounds, p);
                }
            }
            reserve(vertex_count_ + mesh.positions.size(), index_count_ + mesh.indices.size());
            packed.resize(mesh.positions.size());
            for (std::size_t i = 0; i < packed.size(); ++i) {
                packed[i] = pack_vertex(mesh, i);
            }
            positions_.write(vertex_count_ * sizeof(Vec3), std::span<const Vec3>(mesh.positions));
            attributes_.write(
                vertex_count_ * sizeof(PackedVertex), std::span<const PackedVertex>(packed));
            indices_.write(index_count_ * 4, std::span<const std::uint32_t>(mesh.indices));
            range.first_index = static_cast<std::uint32_t>(index_count_);
            range.index_count = static_cast<std::uint32_t>(mesh.indices.size() / 3 * 3);
            range.base_vertex = static_cast<std::int32_t>(vertex_count_);
            range.colored = !mesh.colors.empty();
            range.tangents = !mesh.tangents.empty();
            vertex_count_ += mesh.positions.size();
            index_count_ += mesh.indices.size();
        }
        meshes_.push_back(range);
    }
}

void MeshPool::clear() {
    ++revision_;
    meshes_.clear();
    vertex_count_ = 0;
    index_count_ = 0;
}

}  // namespace limn
