#pragma once

#include "render/gpu/shader_library.h"
#include "render/material/surface_features.h"

#include <array>
#include <cstdint>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace limn {

namespace gpu {
class Device;
}

/// The set of preprocessor definitions that a shader is compiled with, e.g. {SHADOWS, OCEAN}. Two
/// variants are equal if their sets are, regardless of the order of additions. Copying allocates
/// nothing.
class Variant {
  public:
    static constexpr int kMaxDefinitions = 64;

    Variant() = default;
    explicit Variant(const char* name) { add(name); }

    /// `name` must be a literal: it is kept by pointer. Adding it again changes nothing; adding it
    /// with another value is a programming error and aborts.
    void add(const char* name, int value = 1);
    void add_if(bool condition, const char* name) {
        if (condition) {
            add(name);
        }
    }
    void add(const Variant& other);

    /// A hash of the set.
    [[nodiscard]] std::uint64_t key() const { return key_; }
    /// For the shader compiler, sorted by name.
    [[nodiscard]] std::vector<gpu::ShaderDefine> definitions() const;
    [[nodiscard]] bool operator==(const Variant& other) const;

  private:
    struct Definition {
        const char* name;
        int value;
    };
    [[nodiscard]] const Definition* find(std::string_view name) const;

    std::array<Definition, kMaxDefinitions> definitions_;
    int count_ = 0;
    std::uint64_t key_ = 0;
};

/// The programs of one set of shader files, by variant. Each is compiled when it is first
/// requested: by a warm-up, when a level is loaded (warm_up, render_frame.h), or in mid-frame. A
/// variant that does not compile is logged once and is null.
class ProgramVariants {
  public:
    /// `vertex_inputs`: programs read vertices of the mesh pool, which is checked.
    ProgramVariants(gpu::Device& device, gpu::ProgramDesc files, bool vertex_inputs = false);
    /// Of meshes: "mesh.vert" with this fragment shader.
    [[nodiscard]] static ProgramVariants
    of_meshes(gpu::Device& device, const char* fragment, const char* vertex = "mesh.vert");
    [[nodiscard]] static ProgramVariants fullscreen(gpu::Device& device, const char* fragment);

    /// The definitions of `features` are added.
    [[nodiscard]] const gpu::Program*
    get(const Variant& variant, const SurfaceFeatures& features = {});
    /// Compiles one now, to check that it can be compiled.
    [[nodiscard]] Status load(const Variant& variant = {}, const SurfaceFeatures& features = {});

  private:
    struct Entry {
        Variant variant;
        SurfaceFeatures features;
        const gpu::Program* program = nullptr;
    };
    gpu::Device* device_;
    gpu::ProgramDesc files_;
    bool vertex_inputs_;
    std::unordered_map<std::uint64_t, Entry> entries_;
};

}  // namespace limn
