// Bindings of the passes of glare, beside fullscreen_gpu.h. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kGlareSumUnit = 1u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
