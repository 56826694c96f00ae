// Bindings of most full-screen passes. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kSourceUnit = 0u;
const uint kTargetImage = 0u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
