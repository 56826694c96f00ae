// Bindings of the passes of glow, beside fullscreen_gpu.h. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kGlowUnit = 1u;  // light that is mixed into the image or added to it
const uint kGlowSurfaceUnit = 0u;
const uint kGlowDepthUnit = 1u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
