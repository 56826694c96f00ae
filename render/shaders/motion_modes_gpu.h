// Bindings of the other methods of motion blur, beside fullscreen_gpu.h. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kPreviousRadianceUnit = 1u;
const uint kStretchDepthUnit = 2u;
const uint kFlowUnit = 1u;
const uint kCameraMotionDepthUnit = 1u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
