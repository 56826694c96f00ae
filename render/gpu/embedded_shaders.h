#pragma once

#include <string>

namespace limn::gpu {

/// A shader or include file, embedded when the program was built.
struct EmbeddedShader {
    const char* path;  ///< from render/shaders, e.g. "lib/view.glsl"
    const char* text;
};

extern const EmbeddedShader kEmbeddedShaders[];
extern const unsigned kEmbeddedShaderCount;

/// An include file whose text comes from a table of the program.
struct GeneratedShader {
    const char* path;  ///< as above; there is no such file
    std::string (*text)();
};

/// Defined in render/generated_shaders.cpp.
extern const GeneratedShader kGeneratedShaders[];
extern const unsigned kGeneratedShaderCount;

}  // namespace limn::gpu
