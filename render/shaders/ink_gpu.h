// Bindings of passes that draw with ink. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kInkEdgesUnit = 1u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
