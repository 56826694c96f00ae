// Bindings of the other methods of motion blur, beside fullscreen_gpu.h. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

// Of passes that draw meshes, displaced by their maps: other than the units of maps.
const uint kStretchRadianceUnit = 5u;
const uint kPreviousRadianceUnit = 6u;
const uint kStretchDepthUnit = 7u;

const uint kFlowUnit = 1u;
const uint kCameraMotionDepthUnit = 1u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
