// Bindings of the passes of motion blur, beside fullscreen_gpu.h. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kMotionUnit = 1u;
const uint kMotionNeighborsUnit = 2u;
const uint kPackVelocityUnit = 0u;
const uint kPackDepthUnit = 1u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
