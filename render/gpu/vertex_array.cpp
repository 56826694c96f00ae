#include "render/gpu/vertex_array.h"

#include "render/gpu/buffer.h"

namespace limn::gpu {
namespace {

GLuint create_vertex_array_name() {
    GLuint id = 0;
    glCreateVertexArrays(1, &id);
    return id;
}

}  // namespace

VertexArray::VertexArray(std::string_view label, std::span<const VertexAttribute> attributes)
    : object_(create_vertex_array_name(), label) {
    for (const VertexAttribute& a : attributes) {
        glEnableVertexArrayAttrib(id(), a.location);
        glVertexArrayAttribBinding(id(), a.location, a.stream);
        if (a.integer) {
            glVertexArrayAttribIFormat(id(), a.location, a.components, a.type, a.offset);
        } else {
            glVertexArrayAttribFormat(
                id(), a.location, a.components, a.type, static_cast<GLboolean>(a.normalized),
                a.offset);
        }
    }
}

void VertexArray::set_vertices(
    GLuint stream, const Buffer& buffer, std::size_t offset, int stride, GLuint divisor) {
    glVertexArrayVertexBuffer(id(), stream, buffer.id(), static_cast<GLintptr>(offset), stride);
    glVertexArrayBindingDivisor(id(), stream, divisor);
}

void VertexArray::set_indices(const Buffer& buffer) {
    glVertexArrayElementBuffer(id(), buffer.id());
}

}  // namespace limn::gpu
