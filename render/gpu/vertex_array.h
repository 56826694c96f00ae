#pragma once

#include "render/gpu/gl_object.h"

#include <span>

namespace limn::gpu {

class Buffer;

/// One vertex attribute, as glVertexArrayAttribFormat has it.
struct VertexAttribute {
    GLuint location = 0;  ///< layout(location = ..) in the shader
    GLuint stream = 0;    ///< which vertex buffer it comes from
    GLint components = 3;
    GLenum type = GL_FLOAT;
    GLuint offset = 0;        ///< within the vertex [bytes]
    bool normalized = false;  ///< integers become 0 .. 1 or -1 .. 1
    bool integer = false;     ///< stays an integer in the shader
};

/// A vertex format and the buffers that vertices come from.
class VertexArray {
  public:
    VertexArray() = default;
    /// Without attributes: for shaders that derive vertices from gl_VertexID or fetch from buffers.
    explicit VertexArray(std::string_view label, std::span<const VertexAttribute> attributes = {});

    /// Vertices of a stream, `stride` bytes apart; a `divisor` of 1 advances once per instance.
    void set_vertices(
        GLuint stream, const Buffer& buffer, std::size_t offset, int stride, GLuint divisor = 0);
    void set_indices(const Buffer& buffer);

    [[nodiscard]] GLuint id() const { return object_.id(); }
    explicit operator bool() const { return static_cast<bool>(object_); }

  private:
    GlObject<ObjectKind::VertexArray> object_;
};

}  // namespace limn::gpu
