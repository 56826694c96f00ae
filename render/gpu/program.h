#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "render/gpu/gl_object.h"
#include "render/gpu/pipeline_state.h"
#include "render/gpu/vertex_array.h"

#include <span>
#include <string>
#include <vector>

namespace limn::gpu {

// A linked program and its interface by reflection. Programs come from ShaderLibrary; bindings are
// written in the shaders (layout(binding = n)), so C++ rarely needs a name.

enum class BindingKind : std::uint8_t { UniformBlock, StorageBlock, Texture, Image };

/// A resource that a program expects to be bound before it draws.
struct ProgramBinding {
    BindingKind kind;
    std::string name;       ///< of the block or the sampler; arrays as "name[0]"
    int binding = 0;        ///< buffer binding, texture or image unit
    int size = 0;           ///< blocks: bytes the shader may read; others: elements
    GLenum type = GL_NONE;  ///< samplers and images, e.g. GL_SAMPLER_2D
};

/// A vertex attribute that a program reads.
struct ProgramInput {
    std::string name;
    int location = 0;
    GLenum type = GL_NONE;  ///< e.g. GL_FLOAT_VEC3
};

class Program {
  public:
    Program() = default;
    /// Takes ownership of a linked OpenGL program and reads its interface.
    Program(GLuint id, std::string_view label);

    [[nodiscard]] GLuint id() const { return object_.id(); }
    [[nodiscard]] const std::vector<ProgramBinding>& bindings() const { return bindings_; }
    /// Sorted by location.
    [[nodiscard]] const std::vector<ProgramInput>& inputs() const { return inputs_; }
    /// Fails if it reads an attribute that `format` lacks, or an integer as a float or vice versa.
    [[nodiscard]] Status expect_inputs(std::span<const VertexAttribute> format) const;
    /// Fails unless the program has this binding (and a block at least fits in `size` bytes): call
    /// it once after loading for layouts that C++ shares with the shader.
    [[nodiscard]] Status
    expect(BindingKind kind, std::string_view name, int binding, int size = 0) const;

    /// Whether it draws patches of three vertices.
    [[nodiscard]] bool is_tessellated() const { return tessellated_; }
    /// Location of a plain uniform, -1 if there is none of that name.
    [[nodiscard]] int find_uniform(std::string_view name) const;
    /// Set a plain uniform, which keeps its value until set again, across draws and reloads.
    /// Unknown names are ignored: the compiler may have dropped them.
    void set(std::string_view name, float value) const;
    void set(std::string_view name, int value) const;
    void set(std::string_view name, unsigned value) const;
    void set(std::string_view name, const Vec2& value) const;
    void set(std::string_view name, const Vec3& value) const;
    void set(std::string_view name, const Vec4& value) const;
    void set(std::string_view name, const IVec2& value) const;
    void set(std::string_view name, const Mat3& value) const;
    void set(std::string_view name, const Mat4& value) const;

    explicit operator bool() const { return static_cast<bool>(object_); }

  private:
    friend class ShaderLibrary;
    void copy_uniforms_from(const Program& old) const;

    struct Uniform {
        std::string name;
        int location;
        GLenum type;
        int count;
    };

    GlObject<ObjectKind::Program> object_;
    std::string label_;
    std::vector<ProgramInput> inputs_;
    std::vector<ProgramBinding> bindings_;
    std::vector<Uniform> uniforms_;  // sorted by name
    bool tessellated_ = false;
};

/// A program with the state it draws with. The ShaderLibrary owns the program; its address is
/// stable across reloads.
struct Pipeline {
    const Program* program = nullptr;
    PipelineState state = {};
};

}  // namespace limn::gpu
