// Bindings of texture_shade.frag. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kShadedNormalsUnit = 0u;
const uint kShadedColorUnit = 1u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
