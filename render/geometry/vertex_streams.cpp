#include "render/geometry/vertex_streams.h"

#include "ecs/base/math.h"
#include "render/gpu/grown_buffer.h"
#include "render/shaders/instance_gpu.h"

#include <cstddef>
#include <utility>

// Techniques: shade.parameters, shade.passthrough-cube

namespace limn {
namespace {

constexpr std::size_t index_of(VertexStream stream) {
    return static_cast<std::size_t>(stream);
}

struct StreamInfo {
    const char* name;
    std::size_t stride;
    bool always;              ///< every mesh has it
    VertexStream stand_in{};  ///< read instead while it is absent; itself: a constant
};
/// In the order of VertexStream.
constexpr StreamInfo kStreams[kVertexStreams] = {
    {"positions", sizeof(Vec3), true},
    {"frames", sizeof(PackedFrame), true},
    {"uvs", sizeof(Vec2), true},
    {"second uvs", sizeof(Vec2), false, VertexStream::Uv},
    {"colors", 8, false, VertexStream::Color},
    {"previous positions", sizeof(Vec3), false, VertexStream::Position},
    {"wrinkles", 8, false, VertexStream::Wrinkle},
    {"fold heights", sizeof(float), false, VertexStream::FoldHeight},
    {"curvatures", sizeof(Vec2), false, VertexStream::Curvature},
};

constexpr std::uint32_t kWhitePair = 0x3c003c00;  // two half floats, 1 each
constexpr std::uint32_t kWhite[2] = {kWhitePair, kWhitePair};

constexpr GLuint kPosition = static_cast<GLuint>(VertexStream::Position);
constexpr GLuint kFrame = static_cast<GLuint>(VertexStream::Frame);
constexpr GLuint kUv = static_cast<GLuint>(VertexStream::Uv);
constexpr GLuint kUv1 = static_cast<GLuint>(VertexStream::Uv1);
constexpr GLuint kColor = static_cast<GLuint>(VertexStream::Color);
constexpr GLuint kPreviousPosition = static_cast<GLuint>(VertexStream::PreviousPosition);
constexpr GLuint kWrinkle = static_cast<GLuint>(VertexStream::Wrinkle);
constexpr GLuint kFoldHeight = static_cast<GLuint>(VertexStream::FoldHeight);

constexpr gpu::VertexAttribute kMeshAttributes[] = {
    {.location = 0, .stream = kPosition, .components = 3},
    {.location = 1,
     .stream = kFrame,
     .components = 3,
     .type = GL_SHORT,
     .offset = offsetof(PackedFrame, normal),
     .normalized = true},
    {.location = 2,
     .stream = kFrame,
     .components = 4,
     .type = GL_SHORT,
     .offset = offsetof(PackedFrame, tangent),
     .normalized = true},
    {.location = 3, .stream = kUv, .components = 2},
    {.location = 4, .stream = kColor, .components = 4, .type = GL_HALF_FLOAT},
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
    {.location = 12, .stream = kPreviousPosition, .components = 3},
    {.location = 13, .stream = kUv1, .components = 2},
    {.location = 14, .stream = kWrinkle, .components = 4, .type = GL_HALF_FLOAT},
    {.location = 15, .stream = kFoldHeight, .components = 1},
};

}  // namespace

const char* stream_name(VertexStream stream) {
    return kStreams[index_of(stream)].name;
}

std::size_t stream_stride(VertexStream stream) {
    return kStreams[index_of(stream)].stride;
}

std::span<const gpu::VertexAttribute> mesh_attributes() {
    return kMeshAttributes;
}

VertexStreams::VertexStreams(std::string name)
    : name_(std::move(name)), vertices_(name_, kMeshAttributes),
      curvatures_("curvatures", GL_RG32F) {
    white_ = gpu::Buffer::of("white", std::span<const std::uint32_t>(kWhite));
}

void VertexStreams::reserve(std::uint32_t capacity) {
    if (capacity <= capacity_) {
        return;
    }
    for (int i = 0; i < kVertexStreams; ++i) {
        const std::size_t stride = kStreams[i].stride;
        if (kStreams[i].always || buffers_[i]) {
            buffers_[i] = gpu::grown_buffer(
                name_ + ", " + kStreams[i].name, buffers_[i], capacity_ * stride,
                capacity * stride);
        }
    }
    capacity_ = capacity;
    for (int i = 0; i < kVertexStreams; ++i) {
        bind(static_cast<VertexStream>(i));
    }
}

void VertexStreams::require(VertexStream stream) {
    if (has(stream)) {
        return;
    }
    const StreamInfo& info = kStreams[index_of(stream)];
    const bool constant = info.stand_in == stream;
    const std::size_t bytes = capacity_ * info.stride;
    gpu::Buffer made = gpu::grown_buffer(
        name_ + ", " + info.name, buffer(info.stand_in), constant ? 0 : bytes, bytes);
    if (constant) {
        const bool zero = stream == VertexStream::FoldHeight || stream == VertexStream::Curvature;
        made.clear(zero ? 0 : kWhitePair);
    }
    buffers_[index_of(stream)] = std::move(made);
    bind(stream);
}

void VertexStreams::bind(VertexStream stream) {
    const auto binding = static_cast<GLuint>(stream);
    const StreamInfo& info = kStreams[binding];
    if (stream == VertexStream::Curvature) {
        curvatures_.set(buffer(stream));
    } else if (has(stream)) {
        vertices_.set_vertices(binding, buffer(stream), 0, static_cast<int>(info.stride));
    } else if (info.stand_in != stream) {
        vertices_.set_vertices(binding, buffer(info.stand_in), 0, static_cast<int>(info.stride));
    } else {
        vertices_.set_vertices(binding, white_, 0, 0);  // the same for every vertex
    }
}

void VertexStreams::copy(
    const VertexStreams& from, std::uint32_t from_first, std::uint32_t to_first,
    std::uint32_t count) {
    for (int i = 0; i < kVertexStreams; ++i) {
        const auto stream = static_cast<VertexStream>(i);
        if (from.has(stream)) {
            require(stream);
            const std::size_t stride = kStreams[i].stride;
            buffers_[i].copy_from(
                from.buffer(stream), from_first * stride, to_first * stride, count * stride);
        }
    }
}

}  // namespace limn
