#include "render/gpu/program.h"

#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

// Techniques: shade.parameters, shade.program-lifecycle

namespace limn::gpu {
namespace {

std::string resource_name(GLuint program, GLenum interface, GLuint index) {
    std::array<char, 256> name = {};
    GLsizei length = 0;
    glGetProgramResourceName(
        program, interface, index, static_cast<GLsizei>(name.size()), &length, name.data());
    return {name.data(), static_cast<std::size_t>(length)};
}

int resource_count(GLuint program, GLenum interface) {
    GLint count = 0;
    glGetProgramInterfaceiv(program, interface, GL_ACTIVE_RESOURCES, &count);
    return count;
}

/// The BindingKind of an opaque uniform type; false for plain values.
bool opaque_kind(GLenum type, BindingKind& kind) {
    switch (type) {
    case GL_SAMPLER_1D:
    case GL_SAMPLER_2D:
    case GL_SAMPLER_3D:
    case GL_SAMPLER_CUBE:
    case GL_SAMPLER_2D_SHADOW:
    case GL_SAMPLER_2D_ARRAY:
    case GL_SAMPLER_2D_ARRAY_SHADOW:
    case GL_SAMPLER_CUBE_SHADOW:
    case GL_SAMPLER_CUBE_MAP_ARRAY:
    case GL_SAMPLER_CUBE_MAP_ARRAY_SHADOW:
    case GL_SAMPLER_2D_MULTISAMPLE:
    case GL_SAMPLER_2D_MULTISAMPLE_ARRAY:
    case GL_SAMPLER_BUFFER:
    case GL_INT_SAMPLER_2D:
    case GL_INT_SAMPLER_3D:
    case GL_INT_SAMPLER_2D_ARRAY:
    case GL_INT_SAMPLER_BUFFER:
    case GL_UNSIGNED_INT_SAMPLER_2D:
    case GL_UNSIGNED_INT_SAMPLER_3D:
    case GL_UNSIGNED_INT_SAMPLER_2D_ARRAY:
    case GL_UNSIGNED_INT_SAMPLER_BUFFER:
        kind = BindingKind::Texture;
        return true;
    case GL_IMAGE_2D:
    case GL_IMAGE_3D:
    case GL_IMAGE_CUBE:
    case GL_IMAGE_2D_ARRAY:
    case GL_INT_IMAGE_2D:
    case GL_INT_IMAGE_3D:
    case GL_INT_IMAGE_2D_ARRAY:
    case GL_UNSIGNED_INT_IMAGE_2D:
    case GL_UNSIGNED_INT_IMAGE_3D:
    case GL_UNSIGNED_INT_IMAGE_2D_ARRAY:
        kind = BindingKind::Image;
        return true;
    default:
        return false;
    }
}

const char* kind_name(BindingKind kind) {
    switch (kind) {
    case BindingKind::UniformBlock:
        return "uniform block";
    case BindingKind::StorageBlock:
        return "storage block";
    case BindingKind::Texture:
        return "texture";
    case BindingKind::Image:
        return "image";
    }
    return "";
}

void read_blocks(
    GLuint program, GLenum interface, BindingKind kind, std::vector<ProgramBinding>& bindings) {
    constexpr std::array<GLenum, 2> kProperties = {GL_BUFFER_BINDING, GL_BUFFER_DATA_SIZE};
    const int count = resource_count(program, interface);
    for (int i = 0; i < count; ++i) {
        const auto index = static_cast<GLuint>(i);
        std::array<GLint, 2> values = {};
        glGetProgramResourceiv(
            program, interface, index, 2, kProperties.data(), 2, nullptr, values.data());
        bindings.push_back({kind, resource_name(program, interface, index), values[0], values[1]});
    }
}

/// Vertex attributes; built-ins such as gl_VertexID have no location.
std::vector<ProgramInput> read_inputs(GLuint program) {
    constexpr std::array<GLenum, 3> kProperties = {
        GL_LOCATION, GL_TYPE, GL_REFERENCED_BY_VERTEX_SHADER};
    std::vector<ProgramInput> inputs;
    const int count = resource_count(program, GL_PROGRAM_INPUT);
    for (int i = 0; i < count; ++i) {
        const auto index = static_cast<GLuint>(i);
        std::array<GLint, 3> values = {};
        glGetProgramResourceiv(
            program, GL_PROGRAM_INPUT, index, 3, kProperties.data(), 3, nullptr, values.data());
        if (values[0] >= 0 && values[2] != 0) {
            inputs.push_back(
                {resource_name(program, GL_PROGRAM_INPUT, index), values[0],
                 static_cast<GLenum>(values[1])});
        }
    }
    std::sort(inputs.begin(), inputs.end(), [](const ProgramInput& a, const ProgramInput& b) {
        return a.location < b.location;
    });
    return inputs;
}

bool is_integer(GLenum type) {
    return (type >= GL_INT_VEC2 && type <= GL_INT_VEC4) || type == GL_INT || type == GL_UNSIGNED_INT
           || (type >= GL_UNSIGNED_INT_VEC2 && type <= GL_UNSIGNED_INT_VEC4);
}

}  // namespace

Program::Program(GLuint id, std::string_view label)
    : object_(id, label), label_(label), inputs_(read_inputs(id)) {
    read_blocks(id, GL_UNIFORM_BLOCK, BindingKind::UniformBlock, bindings_);
    read_blocks(id, GL_SHADER_STORAGE_BLOCK, BindingKind::StorageBlock, bindings_);

    constexpr std::array<GLenum, 4> kProperties = {
        GL_BLOCK_INDEX, GL_TYPE, GL_LOCATION, GL_ARRAY_SIZE};
    const int count = resource_count(id, GL_UNIFORM);
    for (int i = 0; i < count; ++i) {
        const auto index = static_cast<GLuint>(i);
        std::array<GLint, 4> values = {};
        glGetProgramResourceiv(
            id, GL_UNIFORM, index, 4, kProperties.data(), 4, nullptr, values.data());
        if (values[0] >= 0 || values[2] < 0) {
            continue;  // member of a block
        }
        std::string name = resource_name(id, GL_UNIFORM, index);
        const auto type = static_cast<GLenum>(values[1]);
        BindingKind kind = BindingKind::Texture;
        if (opaque_kind(type, kind)) {
            GLint unit = 0;
            glGetUniformiv(id, values[2], &unit);
            bindings_.push_back({kind, name, unit, values[3], type});
        }
        uniforms_.push_back({std::move(name), values[2], type, values[3]});
    }
    std::sort(uniforms_.begin(), uniforms_.end(), [](const Uniform& a, const Uniform& b) {
        return a.name < b.name;
    });
}

Status Program::expect_inputs(std::span<const VertexAttribute> format) const {
    for (const ProgramInput& input : inputs_) {
        const auto found =
            std::find_if(format.begin(), format.end(), [&](const VertexAttribute& attribute) {
                return static_cast<int>(attribute.location) == input.location;
            });
        if (found == format.end()) {
            return fail(
                "{}: context: attribute {} at location {} found, expected one that the vertex "
                "format has",
                label_, input.name, input.location);
        }
        if (found->integer != is_integer(input.type)) {
            return fail(
                "{}: context: attribute {} found as {}, expected {}", label_, input.name,
                found->integer ? "a float" : "an integer",
                found->integer ? "an integer" : "a float");
        }
    }
    return Done{};
}

Status Program::expect(BindingKind kind, std::string_view name, int binding, int size) const {
    const auto found =
        std::find_if(bindings_.begin(), bindings_.end(), [&](const ProgramBinding& b) {
            return b.kind == kind && (b.name == name || b.name == fmt::format("{}[0]", name));
        });
    if (found == bindings_.end()) {
        return fail(
            "{}: no {} named {} found, expected one at binding {}", label_, kind_name(kind), name,
            binding);
    }
    if (found->binding != binding) {
        return fail(
            "{}: {} {} found at binding {}, expected {}", label_, kind_name(kind), name,
            found->binding, binding);
    }
    if (size > 0 && found->size > size) {
        return fail(
            "{}: {} {} of {} bytes found, expected at most {}", label_, kind_name(kind), name,
            found->size, size);
    }
    return Done{};
}

int Program::find_uniform(std::string_view name) const {
    const auto found = std::lower_bound(
        uniforms_.begin(), uniforms_.end(), name,
        [](const Uniform& u, std::string_view wanted) { return u.name < wanted; });
    return found != uniforms_.end() && found->name == name ? found->location : -1;
}

// A location of -1 is ignored by OpenGL.
void Program::set(std::string_view name, float value) const {
    glProgramUniform1f(id(), find_uniform(name), value);
}
void Program::set(std::string_view name, int value) const {
    glProgramUniform1i(id(), find_uniform(name), value);
}
void Program::set(std::string_view name, unsigned value) const {
    glProgramUniform1ui(id(), find_uniform(name), value);
}
void Program::set(std::string_view name, const Vec2& value) const {
    glProgramUniform2fv(id(), find_uniform(name), 1, &value.x);
}
void Program::set(std::string_view name, const Vec3& value) const {
    glProgramUniform3fv(id(), find_uniform(name), 1, &value.x);
}
void Program::set(std::string_view name, const Vec4& value) const {
    glProgramUniform4fv(id(), find_uniform(name), 1, &value.x);
}
void Program::set(std::string_view name, const IVec2& value) const {
    glProgramUniform2iv(id(), find_uniform(name), 1, &value.x);
}
void Program::set(std::string_view name, const Mat3& value) const {
    glProgramUniformMatrix3fv(id(), find_uniform(name), 1, GL_FALSE, &value[0].x);
}
void Program::set(std::string_view name, const Mat4& value) const {
    glProgramUniformMatrix4fv(id(), find_uniform(name), 1, GL_FALSE, &value[0].x);
}

void Program::copy_uniforms_from(const Program& old) const {
    for (const Uniform& uniform : uniforms_) {
        const int from = old.find_uniform(uniform.name);
        const auto same = [&](const Uniform& u) {
            return u.name == uniform.name && u.type == uniform.type;
        };
        if (from < 0 || uniform.count != 1
            || std::none_of(old.uniforms_.begin(), old.uniforms_.end(), same)) {
            continue;
        }
        std::array<GLfloat, 16> floats = {};
        std::array<GLint, 4> ints = {};
        std::array<GLuint, 4> unsigneds = {};
        switch (uniform.type) {
        case GL_FLOAT:
            glGetUniformfv(old.id(), from, floats.data());
            glProgramUniform1fv(id(), uniform.location, 1, floats.data());
            break;
        case GL_FLOAT_VEC2:
            glGetUniformfv(old.id(), from, floats.data());
            glProgramUniform2fv(id(), uniform.location, 1, floats.data());
            break;
        case GL_FLOAT_VEC3:
            glGetUniformfv(old.id(), from, floats.data());
            glProgramUniform3fv(id(), uniform.location, 1, floats.data());
            break;
        case GL_FLOAT_VEC4:
            glGetUniformfv(old.id(), from, floats.data());
            glProgramUniform4fv(id(), uniform.location, 1, floats.data());
            break;
        case GL_FLOAT_MAT3:
            glGetUniformfv(old.id(), from, floats.data());
            glProgramUniformMatrix3fv(id(), uniform.location, 1, GL_FALSE, floats.data());
            break;
        case GL_FLOAT_MAT4:
            glGetUniformfv(old.id(), from, floats.data());
            glProgramUniformMatrix4fv(id(), uniform.location, 1, GL_FALSE, floats.data());
            break;
        case GL_INT:
            glGetUniformiv(old.id(), from, ints.data());
            glProgramUniform1iv(id(), uniform.location, 1, ints.data());
            break;
        case GL_INT_VEC2:
            glGetUniformiv(old.id(), from, ints.data());
            glProgramUniform2iv(id(), uniform.location, 1, ints.data());
            break;
        case GL_UNSIGNED_INT:
            glGetUniformuiv(old.id(), from, unsigneds.data());
            glProgramUniform1uiv(id(), uniform.location, 1, unsigneds.data());
            break;
        default:
            break;  // textures and images: their units are set in the shader
        }
    }
}

}  // namespace limn::gpu
