// Bindings of ripple_resolve.frag, beside fullscreen_gpu.h and gbuffer_gpu.h. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kRippleFieldUnit = 1u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
