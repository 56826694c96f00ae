#include "render/geometry/mesh_pool.h"

#include "ecs/base/log.h"
#include "render/geometry/mesh_curvature.h"
#include "render/gpu/grown_buffer.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace limn {
namespace {

constexpr std::uint32_t kInitialVertices = 1 << 16;
constexpr std::uint32_t kInitialIndices = 1 << 18;

std::int16_t to_snorm(float x) {
    return static_cast<std::int16_t>(std::lround(std::clamp(x, -1.0f, 1.0f) * 32767.0f));
}
std::uint16_t to_half(float x) {
    constexpr float kMaxHalf = 65504;
    return glm::packHalf1x16(std::isnan(x) ? 0.0f : std::clamp(x, -kMaxHalf, kMaxHalf));
}

PackedFrame pack_frame(const MeshData& mesh, std::size_t i) {
    const Vec3 n =
        normalize_or(i < mesh.normals.size() ? mesh.normals[i] : Vec3(0, 0, 1), {0, 0, 1});
    const Vec4 t = i < mesh.tangents.size() ? mesh.tangents[i] : Vec4(any_perpendicular(n), 1);
    const Vec3 t3 = normalize_or(Vec3(t), any_perpendicular(n));
    return {
        {to_snorm(n.x), to_snorm(n.y), to_snorm(n.z), 0},
        {to_snorm(t3.x), to_snorm(t3.y), to_snorm(t3.z), to_snorm(t.w < 0 ? -1.0f : 1.0f)}};
}

using PackedColor = std::array<std::uint16_t, 4>;
PackedColor pack_color(const MeshData& mesh, std::size_t i) {
    const Vec4 c = i < mesh.colors.size() ? mesh.colors[i] : Vec4(1);
    return {to_half(c.x), to_half(c.y), to_half(c.z), to_half(c.w)};
}

Vec2 first_uv(const MeshData& mesh, std::size_t i) {
    return i < mesh.uvs.size() ? mesh.uvs[i] : Vec2(0);
}
Vec2 second_uv(const MeshData& mesh, std::size_t i) {
    return i < mesh.uvs1.size() ? mesh.uvs1[i] : first_uv(mesh, i);
}

/// Writes `pack(mesh, i)` for every vertex i.
template <typename Pack>
void write_stream(
    VertexStreams& streams, VertexStream stream, std::uint32_t first, const MeshData& mesh,
    Pack pack) {
    std::vector<decltype(pack(mesh, 0))> values(mesh.positions.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = pack(mesh, i);
    }
    streams.write(stream, first, std::span<const decltype(pack(mesh, 0))>(values));
}

bool is_drawable(const MeshData& mesh) {
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

/// Of the triangles of the first `count` indices, which are in range.
float mean_edge(const MeshData& mesh, std::uint32_t count) {
    double sum = 0;
    for (std::uint32_t i = 0; i < count; i += 3) {
        for (std::uint32_t corner = 0; corner < 3; ++corner) {
            sum += static_cast<double>(glm::distance(
                mesh.positions[mesh.indices[i + corner]],
                mesh.positions[mesh.indices[i + (corner + 1) % 3]]));
        }
    }
    return static_cast<float>(sum / std::max(count, 1u));
}

/// Two 16-bit indices in each word, the first in its low bytes: this machine's order.
std::vector<std::uint32_t> in_pairs(std::span<const std::uint32_t> indices) {
    static_assert(std::endian::native == std::endian::little);
    std::vector<std::uint32_t> words((indices.size() + 1) / 2);
    for (std::size_t i = 0; i < indices.size(); ++i) {
        words[i / 2] |= indices[i] << (16 * (i % 2));
    }
    return words;
}

}  // namespace

// Techniques: engine.compact-data

MeshPool::MeshPool() : streams_("meshes") {
    vertex_slots_.grow(kInitialVertices);
    streams_.reserve(kInitialVertices);
    index_slots_.grow(kInitialIndices);
    indices_ = gpu::grown_buffer("mesh indices", {}, 0, std::size_t{4} * kInitialIndices);
    streams_.vertices().set_indices(indices_);
}

void MeshPool::update(std::span<const MeshData> meshes, bool curved) {
    const std::size_t known = std::min(meshes_.size(), meshes.size());
    meshes_.resize(std::max(meshes_.size(), meshes.size()));
    std::vector<char> drawable(meshes.size());
    std::vector<const MeshData*> to_prepare(meshes.size());
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        if (i >= known || meshes_[i].version != meshes[i].version) {
            drawable[i] = is_drawable(meshes[i]) ? 1 : 0;
            to_prepare[i] = i >= known && drawable[i] != 0 ? &meshes[i] : nullptr;
        } else if (curved && !curved_ && meshes_[i].index_count > 0) {
            to_prepare[i] = &meshes[i];  // for its curvatures
        }
    }
    const std::vector<const PreparedMesh*> prepared =
        memory_.prepare(to_prepare, curved || curved_);
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        if (i >= known || meshes_[i].version != meshes[i].version) {
            release(meshes_[i]);
            meshes_[i] = {};
            meshes_[i].version = meshes[i].version;
            meshes_[i].bounds = meshes[i].bounds;
            if (drawable[i] != 0) {
                upload(meshes[i], prepared[i], meshes_[i]);
            }
            ++revision_;
        }
    }
    if (curved && !curved_) {
        curved_ = true;
        streams_.require(VertexStream::Curvature);
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            if (meshes_[i].index_count > 0) {
                write_curvatures(meshes[i], prepared[i], meshes_[i]);
            }
        }
    }
}

void MeshPool::write_curvatures(
    const MeshData& mesh, const PreparedMesh* prepared, const MeshRange& range) {
    const std::vector<Vec2> fitted =
        prepared != nullptr ? std::vector<Vec2>() : fit_curvatures(mesh);
    streams_.write(
        VertexStream::Curvature, static_cast<std::uint32_t>(range.base_vertex),
        std::span<const Vec2>(prepared != nullptr ? prepared->curvatures : fitted));
}

void MeshPool::upload(const MeshData& mesh, const PreparedMesh* prepared, MeshRange& range) {
    if (is_empty(range.bounds)) {
        for (const Vec3& p : mesh.positions) {
            grow(range.bounds, p);
        }
    }
    range.vertex_count = static_cast<std::uint32_t>(mesh.positions.size());
    range.index_count = static_cast<std::uint32_t>(mesh.indices.size() / 3 * 3);
    range.colored = !mesh.colors.empty();
    range.tangents = !mesh.tangents.empty();
    range.mean_edge = mean_edge(mesh, range.index_count);
    const std::uint32_t first = vertex_slots_.allocate_or_grow(range.vertex_count);
    range.base_vertex = static_cast<std::int32_t>(first);
    streams_.reserve(vertex_slots_.capacity());
    const std::size_t old_indices = index_slots_.capacity();
    const auto triangles = std::span(mesh.indices).first(range.index_count);
    std::vector<std::uint32_t> indices(triangles.begin(), triangles.end());
    if (prepared != nullptr) {
        indices = prepared->ordered;
        for (const CoarseTriangles& level : prepared->coarse) {
            range.coarse.push_back(
                {static_cast<std::uint32_t>(indices.size()),
                 static_cast<std::uint32_t>(level.indices.size()), level.error});
            indices.insert(indices.end(), level.indices.begin(), level.indices.end());
        }
    }
    range.wide = mesh.positions.size() > kMaxShortVertices;
    const std::vector<std::uint32_t> pairs =
        range.wide ? std::vector<std::uint32_t>() : in_pairs(indices);
    const std::span<const std::uint32_t> words = range.wide ? indices : pairs;
    const std::uint32_t first_word =
        index_slots_.allocate_or_grow(static_cast<std::uint32_t>(words.size()), kInitialIndices);
    range.first_index = range.wide ? first_word : 2 * first_word;
    for (CoarseRange& level : range.coarse) {
        level.first_index += range.first_index;
    }
    if (index_slots_.capacity() > old_indices) {
        indices_ = gpu::grown_buffer(
            "mesh indices", indices_, 4 * old_indices, std::size_t{4} * index_slots_.capacity());
        streams_.vertices().set_indices(indices_);
    }
    if (range.colored) {
        streams_.require(VertexStream::Color);
    }
    if (!mesh.uvs1.empty()) {
        streams_.require(VertexStream::Uv1);
    }
    streams_.write(VertexStream::Position, first, std::span<const Vec3>(mesh.positions));
    write_stream(streams_, VertexStream::Frame, first, mesh, pack_frame);
    write_stream(streams_, VertexStream::Uv, first, mesh, first_uv);
    if (streams_.has(VertexStream::Uv1)) {
        write_stream(streams_, VertexStream::Uv1, first, mesh, second_uv);
    }
    if (streams_.has(VertexStream::Color)) {
        write_stream(streams_, VertexStream::Color, first, mesh, pack_color);
    }
    if (curved_) {
        write_curvatures(mesh, prepared, range);
    }
    indices_.write(std::size_t{4} * first_word, words);
}

void MeshPool::release(const MeshRange& range) {
    if (range.index_count > 0) {
        vertex_slots_.release(static_cast<std::uint32_t>(range.base_vertex), range.vertex_count);
        std::uint32_t count = range.index_count;
        for (const CoarseRange& level : range.coarse) {
            count += level.index_count;
        }
        if (range.wide) {
            index_slots_.release(range.first_index, count);
        } else {
            index_slots_.release(range.first_index / 2, (count + 1) / 2);
        }
    }
}

void MeshPool::clear() {
    ++revision_;
    curved_ = false;
    meshes_.clear();
    vertex_slots_.clear();
    index_slots_.clear();
}

}  // namespace limn
