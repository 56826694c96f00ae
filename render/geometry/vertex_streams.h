#pragma once

#include "render/gpu/buffer.h"
#include "render/gpu/buffer_texture.h"
#include "render/gpu/vertex_array.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace limn {

// The vertex attributes of meshes as named streams, one buffer each: a pass fetches what its shader
// declares, and an attribute that no mesh has takes no memory. A further stream is one row of the
// table in vertex_streams.cpp, its packing in mesh_pool.cpp and its input in lib/mesh_vertex.glsl.
// Techniques: shade.pipeline-model

enum class VertexStream : std::uint8_t {
    Position,          ///< Vec3 [m]
    Frame,             ///< PackedFrame
    Uv,                ///< Vec2
    Uv1,               ///< Vec2, the second set; absent: the first
    Color,             ///< four half floats; absent: white
    PreviousPosition,  ///< Vec3, of deformed meshes; absent: the current one
    Wrinkle,     ///< four half floats, of deformed meshes: strength of wrinkles (wrinkle_pass.h)
    FoldHeight,  ///< float, of deformed meshes: how far folds move them along their normals [m]
    Curvature,   ///< Vec2 (mesh_curvature.h); not an attribute: curvatures() by gl_VertexID
};
inline constexpr int kVertexStreams = 9;

/// Normal and tangent as 16-bit snorm, -32767 .. 32767 for -1 .. 1.
struct PackedFrame {
    std::int16_t normal[4];
    std::int16_t tangent[4];  ///< w: sign of the bitangent
};
static_assert(sizeof(PackedFrame) == 16);

/// Additional vertex buffer bindings of mesh.vert: per instance, bound by the pass that draws.
inline constexpr unsigned kInstanceStream = kVertexStreams;
inline constexpr unsigned kPreviousTransformStream = kVertexStreams + 1;

[[nodiscard]] const char* stream_name(VertexStream stream);
/// Bytes per vertex.
[[nodiscard]] std::size_t stream_stride(VertexStream stream);
/// Vertex layout of mesh.vert.
[[nodiscard]] std::span<const gpu::VertexAttribute> mesh_attributes();

/// Buffers of equal capacity for the streams, and the vertex array that reads them. They grow and
/// never shrink.
class VertexStreams {
  public:
    explicit VertexStreams(std::string name);

    /// Grows to `capacity` vertices; keeps their contents.
    void reserve(std::uint32_t capacity);
    /// Creates an absent stream, filled with the values that were read instead of it.
    void require(VertexStream stream);
    [[nodiscard]] bool has(VertexStream stream) const {
        return static_cast<bool>(buffers_[static_cast<std::size_t>(stream)]);
    }
    /// Null if it is absent.
    [[nodiscard]] const gpu::Buffer& buffer(VertexStream stream) const {
        return buffers_[static_cast<std::size_t>(stream)];
    }
    template <typename T>
    void write(VertexStream stream, std::uint32_t first, std::span<const T> values) {
        buffers_[static_cast<std::size_t>(stream)].write(first * sizeof(T), values);
    }
    /// Copies vertices of all streams that `from` has, on the GPU.
    void copy(
        const VertexStreams& from, std::uint32_t from_first, std::uint32_t to_first,
        std::uint32_t count);

    /// VertexStream::Curvature as a texture.
    [[nodiscard]] const BufferTexture& curvatures() const { return curvatures_; }

    [[nodiscard]] std::uint32_t capacity() const { return capacity_; }
    [[nodiscard]] gpu::VertexArray& vertices() { return vertices_; }

  private:
    /// Absent streams read a stream that stands in for them, or a constant.
    void bind(VertexStream stream);

    std::string name_;
    std::array<gpu::Buffer, kVertexStreams> buffers_;
    gpu::Buffer white_;
    std::uint32_t capacity_ = 0;
    gpu::VertexArray vertices_;
    BufferTexture curvatures_;
};

}  // namespace limn
