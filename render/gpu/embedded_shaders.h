#pragma once

namespace limn::gpu {

/// A shader or include file, embedded when the program was built.
struct EmbeddedShader {
    const char* path;  ///< from render/shaders, e.g. "lib/view.glsl"
    const char* text;
};

extern const EmbeddedShader kEmbeddedShaders[];
extern const unsigned kEmbeddedShaderCount;

}  // namespace limn::gpu
